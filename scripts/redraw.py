"""Draw the figures of an archive again from its tables, without a simulation, and compare them with the originals.

    python scripts/redraw.py        in the folder of the archive; writes the figures below redrawn/

With the packages of environment.txt, the figures are equal up to the last digits of coordinates, in which the layout of
a figure with many panels may differ from run to run.
"""

import hashlib
import json
import os
import re
import sys
import time
import zlib
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

from conveyor.solver.progress import bar
from draw import draw
from figures import style

ARCHIVE = Path(__file__).resolve().parents[1]
REDRAWN = "redrawn"
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?")
CLOSE = 1e-4  # points, of coordinates


def read_hashes(archive: Path) -> dict[str, str]:
    """The SHA-256 of the files of an archive, by name."""
    lines = (archive / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    return {name: digest for digest, name in (line.split("  ", maxsplit=1) for line in lines)}


def words_and_numbers(page: bytes) -> tuple[bytes, np.ndarray]:
    """The contents of a PDF page without their numbers, and these numbers."""
    found = re.findall(rb"stream\n(.*?)\nendstream", page, re.DOTALL)
    plain = b"\n".join(zlib.decompress(one) if one.startswith(b"\x78") else one for one in found)
    return NUMBER.sub(b"#", plain), np.array(NUMBER.findall(plain), dtype=float)


def are_equal(one: Path, other: Path) -> bool:
    """Whether two PDF pages are equal up to the last digits of their coordinates."""
    (words, numbers), (other_words, other_numbers) = (words_and_numbers(file.read_bytes()) for file in (one, other))
    return words == other_words and np.allclose(numbers, other_numbers, rtol=0.0, atol=CLOSE)


def redraw(archive: Path, file: str, entry: dict) -> str:
    """Draw a figure into the folder REDRAWN of an archive, and return its SHA-256.

    Parameters
    ----------
    file : path of the figure in the archive
    entry : name and settings of the figure, paths and kinds of its tables
    """
    target = archive / REDRAWN / file
    target.parent.mkdir(parents=True, exist_ok=True)
    paths = {role: str(archive / path) for role, path in entry["tables"].items()}
    expected = {path: [entry["kinds"][role]] for role, path in paths.items()}
    style.save(draw(entry["name"], paths, expected, entry["settings"]), [str(target)])
    return hashlib.sha256(target.read_bytes()).hexdigest()


def main(archive: Path) -> str | None:
    """Draw all figures of an archive. Returns a message if some differ from the originals, else None."""
    begin, originals = time.perf_counter(), read_hashes(archive)
    figures = json.loads((archive / "figures.json").read_text(encoding="utf-8"))
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        hashes = pool.map(partial(redraw, archive), figures, figures.values())
        redrawn = dict(zip(figures, bar(hashes, total=len(figures), label="drawn", unit="figures"), strict=True))
    changed = [file for file, digest in redrawn.items() if digest != originals[file]]
    if different := [file for file in changed if not are_equal(archive / file, archive / REDRAWN / file)]:
        return f"{len(different)} of {len(figures)} figures differ from the archive: {', '.join(different)}"
    print(f"{len(figures)} figures drawn in {time.perf_counter() - begin:.0f} s, equal to the archive")
    return None


if __name__ == "__main__":
    sys.exit(main(ARCHIVE))
