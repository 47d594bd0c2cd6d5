"""Tables: kinds, units, equal bytes, all or nothing, errors that name the column or the file."""

import json
from itertools import pairwise

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from conveyor_pipeline.common import fields, tables

SETTINGS = {"model": {"mass": 0.7e-3}, "duration": 1.0}
SCHEMA = [fields.AXES["acceleration"], fields.number("lambda", "1/s", "an exponent")]


def estimates(n=3):
    return {"acceleration": np.linspace(20.0, 90.0, n), "lambda": np.array([-1.0, np.nan, 2.0])[:n]}


def estimates_of(n):
    return {"acceleration": np.linspace(20.0, 90.0, n), "lambda": np.arange(n) - 3.0}


def made(columns=None, schema=SCHEMA, settings=SETTINGS, kind="estimates"):
    return tables.make(kind, schema, columns or estimates(), settings)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.parquet"


def test_reading_returns_what_was_written(path):
    tables.write(path, made())
    table = tables.read(path, "estimates", SETTINGS)
    assert list(table) == ["acceleration", "lambda"]
    assert table.acceleration.tolist() == [20.0, 55.0, 90.0]
    assert table["lambda"].isna().tolist() == [False, True, False]
    assert table.attrs == SETTINGS
    assert [file.name for file in path.parent.iterdir()] == ["a.parquet"]


def test_fields_carry_units_and_nan_becomes_null(path):
    tables.write(path, made())
    written = pq.read_table(path)
    units = {field.name: field.metadata[b"unit"].decode() for field in written.schema}
    assert units == {"acceleration": "m/s²", "lambda": "1/s"}
    # For readers that do not show fields, such as DuckDB.
    assert json.loads(written.schema.metadata[b"units"]) == units
    assert written["lambda"].null_count == 1


def test_no_flipped_bit_becomes_another_number(path):
    """Each bit of the pages of a small table in turn: an error, or the numbers that were written."""
    tables.write(path, made())
    sound, written = path.read_bytes(), tables.read(path, "estimates")
    metadata = pq.read_metadata(path)
    end = max(
        metadata.row_group(0).column(place).data_page_offset + metadata.row_group(0).column(place).total_compressed_size
        for place in range(metadata.num_columns)
    )
    found = 0
    for bit in range(8 * 4, 8 * end):
        damaged = bytearray(sound)
        damaged[bit // 8] ^= 1 << bit % 8
        path.write_bytes(damaged)
        try:
            pd.testing.assert_frame_equal(tables.read(path, "estimates"), written)
        except tables.TableError:
            found += 1
    assert found > 0


def test_no_negative_zero(path):
    tables.write(path, made({"acceleration": [0.0], "lambda": [-0.0]}))
    assert not np.signbit(tables.read(path, "estimates")["lambda"][0])


def test_equal_content_gives_equal_bytes(tmp_path):
    for name, columns in (("a", estimates()), ("b", dict(reversed(estimates().items())))):
        tables.write(tmp_path / name, made(columns))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize(
    ("columns", "schema", "message"),
    [
        ({"lambda": [1.0]}, SCHEMA, "acceleration missing"),
        ({"lambda": [1.0], "mu": [1.0]}, SCHEMA[1:], "mu missing or unknown"),
        ({"lambda": ["fast"]}, SCHEMA[1:], "column lambda of a table of estimates is not double"),
    ],
)
def test_wrong_columns_are_named(columns, schema, message):
    with pytest.raises(ValueError, match=message):
        made(columns, schema)


def test_columns_of_unequal_length_are_refused():
    with pytest.raises(ValueError, match="length"):
        made(estimates() | {"lambda": [1.0]})


def test_a_table_is_replaced_at_once(path, monkeypatch):
    tables.write(path, made(estimates(2)))
    before = path.read_bytes()

    def interrupted(writer, table, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(pq.ParquetWriter, "write_table", interrupted)
    with pytest.raises(KeyboardInterrupt):
        tables.write(path, made())
    assert path.read_bytes() == before
    assert [file.name for file in path.parent.iterdir()] == ["a.parquet"]


def damaged(path):
    path.write_bytes(path.read_bytes()[:-20])


def foreign(path):
    pq.write_table(pq.read_table(path).replace_schema_metadata(None), path)


def a_folder(path):
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize("harm", [damaged, foreign, a_folder])
def test_a_file_that_is_not_a_table_is_named_with_the_remedy(path, harm):
    tables.write(path, made())
    harm(path)
    with pytest.raises(tables.TableError, match=r"a\.parquet .*table of estimates.*; delete it"):
        tables.read(path, "estimates")


def test_another_kind_or_other_settings_are_refused(path):
    tables.write(path, made())
    with pytest.raises(tables.TableError, match="is not a table of sweeps but of estimates; delete it"):
        tables.read(path, "sweeps")
    with pytest.raises(tables.TableError, match=r"settings other .*\(duration = 1.0, not 2.0\); delete it"):
        tables.read(path, "estimates", SETTINGS | {"duration": 2.0})
    with pytest.raises(tables.TableError, match=r"\(model.mass = 0.0007, not 0.001\)"):
        tables.read(path, "estimates", SETTINGS | {"model": {"mass": 1.0e-3}})
    with pytest.raises(tables.TableError, match=r"\(duration = 1.0, not nothing\)"):
        tables.read(path, "estimates", {"model": SETTINGS["model"]})


def shards_of(folder, whole, cuts):
    """The files of shards of a table that is cut before some rows, and the rows of each."""
    rows = [list(ends) for ends in pairwise([0, *cuts, len(whole)])]
    paths = [folder / f"{number}.parquet" for number in range(len(rows))]
    for path, (begin, end) in zip(paths, rows, strict=True):
        own = json.dumps(SETTINGS | {"rows": [begin, end]})
        metadata = whole.schema.metadata | {tables.SETTINGS: own}
        tables.write(path, whole.slice(begin, end - begin).replace_schema_metadata(metadata))
    return paths, rows


@pytest.mark.parametrize("cuts", [[], [1, 2], range(1, 23)])
def test_gathered_shards_have_the_bytes_of_the_whole(tmp_path, monkeypatch, cuts):
    """Row groups of five; no shard ends at one."""
    monkeypatch.setattr(tables, "ROW_GROUP", 5)
    whole = made(estimates_of(23))
    tables.write(tmp_path / "whole", whole)
    paths, rows = shards_of(tmp_path, whole, cuts)
    tables.gather(tmp_path / "gathered", paths, "estimates", SETTINGS, rows)
    assert (tmp_path / "gathered").read_bytes() == (tmp_path / "whole").read_bytes()


def test_a_shard_of_other_rows_or_settings_is_named(tmp_path):
    """For example, if one was copied over another by hand."""
    paths, rows = shards_of(tmp_path, made(estimates_of(4)), [2])
    with pytest.raises(tables.TableError, match=r"0\.parquet was made .*\(duration = 1.0, not 2.0\); delete it"):
        tables.gather(tmp_path / "all", paths, "estimates", SETTINGS | {"duration": 2.0}, rows)
    paths[1].write_bytes(paths[0].read_bytes())
    with pytest.raises(tables.TableError, match=r"1\.parquet was made .*\(rows = \[0, 2\], not \[2, 4\]\); delete it"):
        tables.gather(tmp_path / "all", paths, "estimates", SETTINGS, rows)
    assert not (tmp_path / "all").exists()
