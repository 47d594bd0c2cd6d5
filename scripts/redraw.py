"""Draw the figures of an archive again from its tables, without a simulation, and compare them with the originals.

    python scripts/redraw.py        in the folder of the archive; writes the figures below redrawn/

With the packages of environment.txt, they are equal byte for byte.
"""

import hashlib
import json
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from conveyor import progress_bar
from draw import draw
from figures import style

ARCHIVE = Path(__file__).resolve().parents[1]
REDRAWN = "redrawn"


def read_hashes(archive: Path) -> dict[str, str]:
    """The SHA-256 of the files of an archive, by name."""
    lines = (archive / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    return {name: digest for digest, name in (line.split("  ", maxsplit=1) for line in lines)}


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
        redrawn = dict(
            zip(figures, progress_bar(hashes, total=len(figures), label="drawn", unit="figures"), strict=True)
        )
    if different := [file for file, digest in redrawn.items() if digest != originals[file]]:
        return f"{len(different)} of {len(figures)} figures differ from the archive: {', '.join(different)}"
    print(f"{len(figures)} figures drawn in {time.perf_counter() - begin:.0f} s, equal to the archive")
    return None


if __name__ == "__main__":
    sys.exit(main(ARCHIVE))
