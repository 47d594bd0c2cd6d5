"""Draw the figures of an archive again from its tables, without a simulation, and compare them with those in it.

    python scripts/redraw.py        in the folder of the archive; the figures come below redrawn/

Figures are equal to the byte where the packages of environment.txt are installed.
"""

import hashlib
import json
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from conveyor.solver.progress import bar
from draw import draw
from figures import style

ARCHIVE = Path(__file__).resolve().parents[1]
REDRAWN = "redrawn"


def sums(archive: Path) -> dict[str, str]:
    """The SHA-256 of the files of an archive, by their names."""
    lines = (archive / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    return {name: digest for digest, name in (line.split("  ", maxsplit=1) for line in lines)}


def redraw(archive: Path, file: str, entry: dict) -> str:
    """Draw a figure below the folder `redrawn` of an archive, and give its SHA-256.

    Parameters
    ----------
    file : of the figure in the archive
    entry : its name, the paths of its tables, their kinds and its settings
    """
    target = archive / REDRAWN / file
    target.parent.mkdir(parents=True, exist_ok=True)
    paths = {role: str(archive / path) for role, path in entry["tables"].items()}
    expected = {path: [entry["kinds"][role]] for role, path in paths.items()}
    style.save(draw(entry["name"], paths, expected, entry["settings"]), [str(target)])
    return hashlib.sha256(target.read_bytes()).hexdigest()


def main(archive: Path) -> str | None:
    """Draw all figures of an archive; a message if some differ."""
    begin, known = time.perf_counter(), sums(archive)
    drawn = json.loads((archive / "figures.json").read_text(encoding="utf-8"))
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        digests = pool.map(partial(redraw, archive), drawn, drawn.values())
        found = dict(zip(drawn, bar(digests, total=len(drawn), label="drawn", unit="figures"), strict=True))
    if different := [file for file, digest in found.items() if digest != known[file]]:
        return f"{len(different)} of {len(drawn)} figures differ from those of the archive: {', '.join(different)}"
    print(f"{len(drawn)} figures drawn in {time.perf_counter() - begin:.0f} s, equal to those of the archive")
    return None


if __name__ == "__main__":
    sys.exit(main(ARCHIVE))
