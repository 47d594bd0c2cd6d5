"""Write Parquet tables in one step, with equal bytes for equal content, and check them when they are read.

Units are in the metadata of each column. They are also in the metadata of the table, because some readers show only
these. The metadata of the table also contain its kind and the settings that it was made from (model, duration, method,
…), which pandas.read_parquet shows as `attrs`.
"""

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from conveyor_pipeline.common.rule_log import JobError

REMEDY = "delete it, and the next run makes it again"
ROW_GROUP = 1 << 20  # rows: fixed, so that a table's bytes do not depend on how it was computed
LEVEL = 3  # of zstd: higher levels take longer and save little
KIND = b"kind"
UNIT, UNITS = b"unit", b"units"
# Stands for the value of a missing key in messages.
MISSING = "nothing"
# The key under which pandas stores DataFrame.attrs.
SETTINGS = b"PANDAS_ATTRS"


class TableError(JobError):
    """A file is not the expected table; the message names the file and the remedy."""


def make(kind: str, schema: Sequence[pa.Field], columns: Mapping[str, Sequence], settings: dict) -> pa.Table:
    """A table with the columns of a schema. NaN becomes null, and negative zero becomes zero.

    Parameters
    ----------
    kind : of the table, such as sweeps
    schema : columns with types and units
    columns : values by name, each of shape (n,)
    settings : settings that the table was made from, which JSON can represent

    Raises
    ------
    ValueError
        names columns that are missing, unknown or of a wrong type
    """
    expected = pa.schema(schema)
    if difference := set(expected.names) ^ set(columns):
        raise ValueError(f"columns of a table of {kind}: {', '.join(sorted(difference))} missing or unknown")
    arrays = []
    for column in expected:
        try:
            values = columns[column.name]
            if pa.types.is_floating(column.type):
                values = np.asarray(values, dtype=np.float64) + 0.0  # no negative zero
            arrays.append(pa.array(values, type=column.type, from_pandas=True))
        except (ValueError, TypeError) as error:
            raise ValueError(f"column {column.name} of a table of {kind} is not {column.type}: {error}") from error
    units = {column.name: column.metadata[UNIT].decode() for column in expected}
    metadata = {KIND: kind, UNITS: json.dumps(units, ensure_ascii=False), SETTINGS: json.dumps(settings)}
    return pa.Table.from_arrays(arrays, schema=expected.with_metadata(metadata))


@contextmanager
def replaced(path: str | Path) -> Iterator[Path]:
    """A temporary file that replaces `path` when the block ends without an error."""
    part = Path(f"{path}.part")
    try:
        yield part
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def encoding(schema: pa.Schema) -> dict[str, Any]:
    """Options of the Parquet writer. Floats are stored as byte streams, which takes a third less space."""
    floats = [column.name for column in schema if pa.types.is_floating(column.type)]
    others = [column.name for column in schema if column.name not in floats]
    return {
        "compression": "zstd",
        "compression_level": LEVEL,
        "use_byte_stream_split": floats,
        "use_dictionary": others,
        "write_page_checksum": True,
    }


def write(path: str | Path, table: pa.Table) -> None:
    """Write a table to `path`; the bytes depend only on the content and on the version of pyarrow."""
    write_blocks(path, [table])


def write_blocks(path: str | Path, blocks: Iterable[pa.Table]) -> None:
    """Write a table from one or more blocks of its rows, with about one row group in memory at a time.

    The bytes do not depend on the sizes of the blocks.
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
    path: str | Path, shards: Sequence[str | Path], kind: str, settings: dict, rows: Sequence[Sequence[int]]
) -> None:
    """Join the shards of a table, given in the order of their rows; TableError for a file that is not the shard.

    Parameters
    ----------
    path : of the table
    shards : files
    kind, settings : of the table
    rows : first row of each shard, and the row after its last one, which the settings of a shard contain
    """
    for shard, row_range in zip(shards, rows, strict=True):
        check(shard, kind, settings | {"rows": row_range})
    write_blocks(path, read_blocks(shards, settings))


def read_blocks(shards: Sequence[str | Path], settings: dict) -> Iterator[pa.Table]:
    """The row groups of shards, one by one, with the settings of their table."""
    for path in shards:
        with pq.ParquetFile(path, page_checksum_verification=True) as file:
            for number in range(file.num_row_groups):
                block = file.read_row_group(number)
                yield block.replace_schema_metadata(block.schema.metadata | {SETTINGS: json.dumps(settings)})


def check(path: str | Path, kind: str, settings: dict | None = None) -> None:
    """Raise TableError if `path` is not a table of this kind, or was made from settings other than the given ones."""
    try:
        metadata = pq.read_schema(path).metadata or {}
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise TableError(f"{path} cannot be read as a table of {kind} ({error}); {REMEDY}") from error
    if metadata.get(KIND) != kind.encode():
        actual = metadata.get(KIND, b"").decode() or "something else"
        raise TableError(f"{path} is not a table of {kind} but of {actual}; {REMEDY}")
    if settings is not None:
        difference = first_difference(json.loads(metadata[SETTINGS]), json.loads(json.dumps(settings)))
        if difference:
            raise TableError(f"{path} was made from settings other than those requested ({difference}); {REMEDY}")


def read(path: str | Path, kind: str, settings: dict | None = None) -> pd.DataFrame:
    """The table at `path` with its settings in `attrs`; TableError as in `check`, or if the file is damaged."""
    check(path, kind, settings)
    try:
        return pd.read_parquet(path, page_checksum_verification=True)
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        raise TableError(f"{path} is damaged ({error}); {REMEDY}") from error


def first_difference(recorded: Any, requested: Any, key: str = "") -> str:
    """The first difference of two settings as "KEY = FOUND, not REQUESTED"; empty if they are equal."""
    if isinstance(recorded, dict) and isinstance(requested, dict):
        for name in recorded | requested:
            place = f"{key}.{name}".lstrip(".")
            if difference := first_difference(recorded.get(name, MISSING), requested.get(name, MISSING), place):
                return difference
        return ""
    return "" if recorded == requested else f"{key} = {recorded}, not {requested}"
