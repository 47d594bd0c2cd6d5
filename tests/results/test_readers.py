"""Tables as readers get them: a unit for every column of numbers."""

import json

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from made import RESULTS, entries

TABLES = sorted({table for entry in entries().values() for table in entry["tables"].values()})


def has_numbers(column: pa.Field) -> bool:
    kind = column.type.value_type if pa.types.is_list(column.type) else column.type
    return pa.types.is_floating(kind) or pa.types.is_integer(kind)


@pytest.mark.parametrize("name", TABLES)
def test_every_column_of_numbers_has_a_unit(name):
    schema = pq.read_schema(RESULTS / f"{name.removeprefix('results/')}.parquet")
    units = json.loads(schema.metadata[b"units"])
    assert all(units[column.name] for column in schema if has_numbers(column))
