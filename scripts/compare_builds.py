"""Compare the tables of two builds, for example from different processors.

    python scripts/compare_builds.py results ../other/results --tolerance 1e-9

The settings of the tables are compared exactly, their columns also within the relative tolerance. The exit status is 0
if all settings are equal, and all columns equal or within the tolerance, and 1 otherwise. Tables with measured times,
which manifest.sha256 lists, are ignored, and so are shards and the results of other prefixes in the same folder.
"""

import argparse
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

EQUAL, WITHIN, DIFFERENT, TIMES = "equal", "within tolerance", "DIFFERENT", "measured times"


def timed_files(folder: Path) -> list[str]:
    """The files with measured times, according to the manifest in a folder of results."""
    manifest = folder / "manifest.sha256"
    lines = manifest.read_text(encoding="utf-8").splitlines() if manifest.is_file() else []
    return [line.partition(": ")[2] for line in lines if line.startswith("# may differ")]


def tables_below(folder: Path) -> set[str]:
    """The tables NAME and SECTION/NAME; only shards and the results of other prefixes have folders of their own."""
    paths = [path.relative_to(folder) for path in folder.rglob("*.parquet")]
    others = {path.parts[0] for path in paths if len(path.parts) > 2}
    return {path.as_posix() for path in paths if path.parts[0] not in others}


def compare_settings(one: pa.Table, other: pa.Table) -> list[str]:
    """A line for each setting that differs; pandas keeps the settings of a table as its attrs."""
    here, there = (json.loads((table.schema.metadata or {}).get(b"PANDAS_ATTRS", b"{}")) for table in (one, other))
    names = [name for name in sorted(here | there) if here.get(name) != there.get(name)]
    return [f"setting {name}: {here.get(name)} and {there.get(name)}" for name in names]


def compare_column(name: str, one: pa.ChunkedArray, other: pa.ChunkedArray, tolerance: float) -> tuple[str, str]:
    """Verdict on a column that is not equal, and its differences in words."""
    if not pa.types.is_floating(one.type):
        first = next(row for row, (a, b) in enumerate(zip(one, other, strict=True)) if not a.equals(b))
        return DIFFERENT, f"{name}: first in row {first}, {one[first]} and {other[first]}"
    values, others = (column.to_pandas().to_numpy(dtype=float) for column in (one, other))
    same = (values == others) | (np.isnan(values) & np.isnan(others))
    with np.errstate(invalid="ignore"):
        absolute = np.where(same, 0.0, np.abs(values - others))
        scale = np.maximum(np.abs(values), np.abs(others))
        relative = np.where(same, 0.0, absolute / np.where(scale > 0.0, scale, 1.0))
    # If only one of two values is missing, the difference is infinite.
    absolute, relative = (np.where(np.isnan(difference), np.inf, difference) for difference in (absolute, relative))
    first = int(np.argmin(same))
    text = (
        f"{name}: {np.count_nonzero(~same)} of {len(same)} rows, by at most {absolute.max():.3g} (relative "
        f"{relative.max():.3g}), first in row {first}, {values[first]:.17g} and {others[first]:.17g}"
    )
    return (WITHIN if relative.max() <= tolerance else DIFFERENT), text


def compare_tables(one: pa.Table, other: pa.Table, tolerance: float) -> tuple[str, list[str]]:
    """Verdict on two tables, and one line for each difference."""
    if one.schema.names != other.schema.names or one.schema.types != other.schema.types:
        return DIFFERENT, [
            f"columns: {', '.join(f'{field.name}: {field.type}' for field in set(one.schema) ^ set(other.schema))}"
        ]
    settings = compare_settings(one, other)
    if len(one) != len(other):
        return DIFFERENT, [*settings, f"rows: {len(one)} and {len(other)}"]
    unequal = [name for name in one.column_names if not one[name].equals(other[name])]
    differences = [compare_column(name, one[name], other[name], tolerance) for name in unequal]
    verdicts = {verdict for verdict, _ in differences} | ({DIFFERENT} if settings else set())
    verdict = next((verdict for verdict in (DIFFERENT, WITHIN) if verdict in verdicts), EQUAL)
    return verdict, [*settings, *(text for _, text in differences)]


def compare(one: Path, other: Path, tolerance: float) -> Iterator[tuple[str, str, list[str]]]:
    """Path, verdict and differences of every table below either folder."""
    timed = timed_files(one) + timed_files(other)
    tables = tables_below(one), tables_below(other)
    for name in sorted(tables[0] | tables[1]):
        folders = [folder for folder, names in zip((one, other), tables, strict=True) if name in names]
        if len(folders) == 1:
            yield name, DIFFERENT, [f"only in {folders[0]}"]
        elif any(file.endswith(f"/{name}") for file in timed):
            yield name, TIMES, []
        else:
            yield name, *compare_tables(*(pq.read_table(folder / name) for folder in folders), tolerance)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description="Compare the tables of two builds.")
    parser.add_argument("folders", nargs=2, type=Path, help="folders of results")
    parser.add_argument("--tolerance", type=float, default=1e-9, help="largest relative difference (default: 1e-9)")
    given = parser.parse_args(arguments)
    for folder in given.folders:
        if not tables_below(folder):
            parser.error(f"{folder} has no tables; give a folder of results")
    comparisons = list(compare(*given.folders, given.tolerance))
    for name, verdict, lines in comparisons:
        if verdict != EQUAL:
            print("\n    ".join([f"{name}: {verdict}", *lines]))
    counts = pd.Series([verdict for _, verdict, _ in comparisons]).value_counts()
    print(f"{len(comparisons)} tables: {', '.join(f'{count} {verdict}' for verdict, count in counts.items())}")
    return int(DIFFERENT in counts)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
