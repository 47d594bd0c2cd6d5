"""Parquet tables: atomic writing of equal bytes for equal content, checked reading.

Units stand in the metadata of the fields and, for readers that see no fields, in that of the table. What kind of table
it is and what was computed (model, duration, method, …) stand there, too; pandas.read_parquet shows the latter as
`attrs`. A column of settings, such as an axis, comes first.
"""

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from pipeline.sizes import ROW_GROUP

REMEDY = "delete it, and the next run makes it again"
LEVEL = 3  # of zstd: higher ones take longer and save little
KIND = b"kind"
UNIT, UNITS = b"unit", b"units"
# What a key has that is not there.
NOTHING = "nothing"
# Values of columns by their names, for a first row and the one behind the last.
Wanted = Callable[[tuple[int, int]], Mapping[str, np.ndarray]]
# The key under which pandas keeps DataFrame.attrs.
SETTINGS = b"PANDAS_ATTRS"


class TableError(Exception):
    """A file that is not the table that was expected; the message names it and what to do."""


def make(kind: str, schema: Sequence[pa.Field], columns: Mapping[str, Sequence], settings: dict) -> pa.Table:
    """A table of a kind with the columns of its schema, given by name in any order, all of shape (n,).

    NaN becomes null, and negative zero zero. `settings`, as JSON can write them, are what was computed.

    Raises
    ------
    ValueError
        names the columns that lack, are too many or do not fit their type
    """
    wanted = pa.schema(schema)
    if difference := set(wanted.names) ^ set(columns):
        raise ValueError(f"columns of a table of {kind}: {', '.join(sorted(difference))} lacking or unknown")
    arrays = []
    for column in wanted:
        try:
            values = columns[column.name]
            if pa.types.is_floating(column.type):
                values = np.asarray(values, dtype=np.float64) + 0.0  # no negative zero
            arrays.append(pa.array(values, type=column.type, from_pandas=True))
        except (ValueError, TypeError) as error:
            raise ValueError(f"column {column.name} of a table of {kind} is not {column.type}: {error}") from error
    units = {column.name: (column.metadata or {}).get(UNIT, b"").decode() for column in wanted}
    metadata = {KIND: kind, UNITS: json.dumps(units, ensure_ascii=False), SETTINGS: json.dumps(settings)}
    return pa.Table.from_arrays(arrays, schema=wanted.with_metadata(metadata))


@contextmanager
def replaced(path: str | Path) -> Iterator[Path]:
    """A file to write in place of `path`, which it replaces at once when all is written, or not at all."""
    part = Path(f"{path}.part")
    try:
        yield part
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def encoding(schema: pa.Schema) -> dict[str, Any]:
    """How columns are written: of floats the bytes of equal weight together, which takes two thirds of the room."""
    floats = [column.name for column in schema if pa.types.is_floating(column.type)]
    others = [column.name for column in schema if column.name not in floats]
    return {
        "compression": "zstd",
        "compression_level": LEVEL,
        "use_byte_stream_split": floats,
        "use_dictionary": others,
    }


def write(path: str | Path, table: pa.Table) -> None:
    """Write a table to `path`; its bytes depend on its content and on pyarrow's version only."""
    write_blocks(path, [table])


def write_blocks(path: str | Path, blocks: Iterable[pa.Table]) -> None:
    """Write a table from blocks of its rows, at least one block, with about one row group in memory at a time.

    The bytes do not depend on how the rows are cut into blocks.
    """
    waiting: list[pa.Table] = []
    with replaced(path) as part, ExitStack() as files:
        writer = None
        for block in blocks:
            waiting.append(block)
            if writer is None:
                writer = files.enter_context(pq.ParquetWriter(part, block.schema, **encoding(block.schema)))
            while sum(map(len, waiting)) >= ROW_GROUP:
                together = pa.concat_tables(waiting)
                writer.write_table(together.slice(0, ROW_GROUP), row_group_size=ROW_GROUP)
                waiting = [together.slice(ROW_GROUP)]
        if sum(map(len, waiting)):
            writer.write_table(pa.concat_tables(waiting), row_group_size=ROW_GROUP)


def gather(
    path: str | Path, shards: Sequence[str | Path], kind: str, settings: dict, rows: int, wanted: Wanted
) -> None:
    """Write shards of a table, given in the order of their rows, as one; `wanted` says what some columns hold.

    Raises
    ------
    TableError
        if a shard is no table of this kind, or was made from other settings or of other rows, or all together have
        not so many `rows`
    """
    for shard in shards:
        check(shard, kind, settings)
    if (found := sum(pq.read_metadata(shard).num_rows for shard in shards)) != rows:
        raise TableError(
            f"the shards of {path} have {found} rows, not {rows}; delete them: the next run makes new ones"
        )
    write_blocks(path, blocks_of(shards, wanted))


def blocks_of(shards: Sequence[str | Path], wanted: Wanted) -> Iterator[pa.Table]:
    """The row groups of shards, one by one; TableError where columns do not hold what is wanted of their rows."""
    found = 0
    for path in shards:
        with pq.ParquetFile(path) as file:
            for number in range(file.num_row_groups):
                block = file.read_row_group(number)
                begin, found = found, found + len(block)
                if not holds(block, wanted((begin, found))):
                    raise TableError(f"{path} does not hold rows {begin} to {found - 1} of its table; {REMEDY}")
                yield block


def holds(block: pa.Table, wanted: Mapping[str, np.ndarray]) -> bool:
    """Whether columns of a block have these values."""
    return all(
        pa.array(values, from_pandas=True).equals(block[name].combine_chunks()) for name, values in wanted.items()
    )


def check(path: str | Path, kind: str, settings: dict | None = None) -> None:
    """TableError unless there is a table of this kind at `path`, made from these settings if they are given."""
    try:
        metadata = pq.read_schema(path).metadata or {}
    except (pa.ArrowException, OSError) as error:
        raise TableError(f"{path} cannot be read as a table of {kind} ({error}); {REMEDY}") from error
    if metadata.get(KIND) != kind.encode():
        found = metadata.get(KIND, b"").decode() or "something else"
        raise TableError(f"{path} is not a table of {kind} but of {found}; {REMEDY}")
    if settings is not None and (other := differing(json.loads(metadata[SETTINGS]), json.loads(json.dumps(settings)))):
        raise TableError(f"{path} was made from other settings than those that are asked for ({other}); {REMEDY}")


def read(path: str | Path, kind: str, settings: dict | None = None) -> pd.DataFrame:
    """The table at `path`, its settings in `attrs`; TableError as from `check`, or if it is damaged."""
    check(path, kind, settings)
    try:
        return pd.read_parquet(path)
    except (pa.ArrowException, OSError) as error:
        raise TableError(f"{path} is damaged ({error}); {REMEDY}") from error


def differing(found: Any, asked: Any, key: str = "") -> str:
    """The first place where two settings differ, as "KEY = FOUND, not ASKED"; nothing if they are equal."""
    if isinstance(found, dict) and isinstance(asked, dict):
        for name in found | asked:
            place = f"{key}.{name}".lstrip(".")
            if other := differing(found.get(name, NOTHING), asked.get(name, NOTHING), place):
                return other
        return ""
    return "" if found == asked else f"{key} = {found}, not {asked}"
