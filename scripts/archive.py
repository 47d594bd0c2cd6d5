"""The script of the rule that makes the archive, from which readers can draw the figures again.

The archive contains the figures, the tables behind figures, captions and claims, the provenance, the sources with their
environment, and the SHA-256 of every file. The tables lack the final states of runs, which take half of their bytes and
are not drawn.
"""

import hashlib
import json
import os
import shutil
from collections.abc import Iterable
from pathlib import Path

import pyarrow.parquet as pq

from pipeline import fields, tables
from pipeline.rule_log import JobError, logged
from pipeline.templates import render

SUMS = "SHA256SUMS"
# Input of scripts/redraw.py: tables of each figure by role, their kinds, and the settings of the figure.
DRAWN = "figures.json"
ENDS = {field.name for field in fields.ENDS}


def copy_table(source: Path, target: Path) -> None:
    """Copy a table without the final states of runs."""
    table = pq.read_table(source)
    tables.write(target, table.drop_columns([name for name in table.column_names if name in ENDS]))


def copy(names: Iterable[str], base: str | Path, folder: Path) -> None:
    """Copy files below a base folder to the same places below another folder."""
    for name in names:
        source, target = Path(name), folder / os.path.relpath(name, base)
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.suffix == ".parquet":
            copy_table(source, target)
        else:
            shutil.copyfile(source, target)


def hash_files(folder: Path) -> str:
    """The SHA-256 of all files below a folder, in the format of sha256sum."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return "".join(
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(folder).as_posix()}\n" for path in files
    )


def check_size(folder: Path, limit: float) -> None:
    """Raise JobError if a folder has more than `limit` MB; the message names the largest files and the config key."""
    sizes = sorted(((path.stat().st_size, path) for path in folder.rglob("*") if path.is_file()), reverse=True)
    megabytes = sum(size for size, _ in sizes) / 1e6
    if megabytes > limit:
        largest = ", ".join(f"{path.relative_to(folder).as_posix()} ({size / 1e6:.3g})" for size, path in sizes[:3])
        raise JobError(
            f"the archive has {megabytes:.3g} MB, more than archive.megabytes = {limit:g}; largest files: {largest}; "
            "raise that key, or give the sweeps fewer points"
        )


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        archive = Path(snakemake.output[0])
        archive.mkdir(parents=True)
        copy(snakemake.input.results, os.curdir, archive)
        copy(snakemake.input.sources, Path(snakemake.scriptdir).parent, archive)
        copy(snakemake.input.overlays, os.curdir, archive)
        readme = render(Path(snakemake.input.readme).read_text(encoding="utf-8"), {"version": snakemake.params.version})
        (archive / "ARCHIVE.md").write_text(readme, encoding="utf-8")
        (archive / DRAWN).write_text(json.dumps(snakemake.params.figures, indent=1) + "\n", encoding="utf-8")
        (archive / SUMS).write_text(hash_files(archive), encoding="utf-8")
        check_size(archive, snakemake.params.megabytes)
