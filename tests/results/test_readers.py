"""Tables in pandas and DuckDB: the same numbers, with a unit for every column of numbers."""

import json

import duckdb
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from made import RESULTS, entries

TABLES = sorted({table for entry in entries().values() for table in entry["tables"].values()})


def has_numbers(column: pa.Field) -> bool:
    kind = column.type.value_type if pa.types.is_list(column.type) else column.type
    return pa.types.is_floating(kind) or pa.types.is_integer(kind)


@pytest.mark.parametrize("name", TABLES)
def test_pandas_and_duckdb_read_the_same_with_units(name):
    file = RESULTS / f"{name.removeprefix('results/')}.parquet"
    table = pa.Table.from_pandas(pd.read_parquet(file), schema=pq.read_schema(file))
    by_duckdb = duckdb.sql(f"SELECT * FROM read_parquet('{file}')").to_arrow_table()
    assert by_duckdb.cast(table.schema).equals(table)
    query = f"SELECT decode(value) FROM parquet_kv_metadata('{file}') WHERE decode(key) = 'units'"
    units = json.loads(duckdb.sql(query).fetchall()[0][0])
    assert all(units[column.name] for column in table.schema if has_numbers(column))
