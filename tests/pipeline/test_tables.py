"""Tables: schema, units, equal bytes, all or nothing, errors that name the column."""

import numpy as np
import pyarrow.parquet as pq
import pytest

from conveyor.solver.model import UNITS
from pipeline import tables

SETTINGS = {"model": {"mass": 0.7e-3}, "duration": 1.0}


def estimates(n=3):
    return {"acceleration": np.linspace(20.0, 90.0, n), "lambda": np.array([-1.0, np.nan, 2.0])[:n]}


def test_what_is_written_is_read(tmp_path):
    path = tmp_path / "a.parquet"
    tables.write(path, "estimates", estimates(), axes=["acceleration"], settings=SETTINGS)
    table = tables.read(path, "estimates")
    assert list(table) == ["acceleration", "lambda"]
    assert table.acceleration.tolist() == [20.0, 55.0, 90.0]
    assert table["lambda"].isna().tolist() == [False, True, False]
    assert table.attrs == SETTINGS


def test_fields_carry_units_and_nan_becomes_null(tmp_path):
    path = tmp_path / "a.parquet"
    tables.write(path, "estimates", estimates(), axes=["acceleration"], settings=SETTINGS)
    written = pq.read_table(path)
    units = {field.name: field.metadata[b"unit"].decode() for field in written.schema}
    assert units == {"acceleration": "m/s²", "lambda": "1/s"}
    assert written["lambda"].null_count == 1


def test_every_column_has_unit_and_description():
    for kind in tables.COLUMNS:
        for field in tables.schema(kind, UNITS):
            assert field.metadata[b"description"]
            kind_of_value = getattr(field.type, "value_type", field.type)
            assert bool(field.metadata[b"unit"]) == (kind_of_value in ("double", "int64"))


def test_equal_content_gives_equal_bytes(tmp_path):
    for name, columns in (("a", estimates()), ("b", dict(reversed(estimates().items())))):
        tables.write(tmp_path / name, "estimates", columns, axes=["acceleration"], settings=SETTINGS)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize(
    ("columns", "axes", "message"),
    [
        ({"lambda": [1.0]}, ["acceleration"], "acceleration lacking"),
        ({"lambda": [1.0], "mu": [1.0]}, [], "mu lacking or unknown"),
        ({"lambda": ["fast"]}, [], "column lambda of a table of estimates is not double"),
    ],
)
def test_wrong_columns_are_named(tmp_path, columns, axes, message):
    with pytest.raises(ValueError, match=message):
        tables.write(tmp_path / "a.parquet", "estimates", columns, axes=axes, settings=SETTINGS)
    assert list(tmp_path.iterdir()) == []


def test_columns_of_unequal_length_are_refused(tmp_path):
    with pytest.raises(ValueError, match="length"):
        tables.write(
            tmp_path / "a.parquet",
            "estimates",
            estimates() | {"lambda": [1.0]},
            axes=["acceleration"],
            settings=SETTINGS,
        )


def test_a_table_is_replaced_at_once(tmp_path, monkeypatch):
    path = tmp_path / "a.parquet"
    tables.write(path, "estimates", estimates(2), axes=["acceleration"], settings=SETTINGS)
    before = path.read_bytes()

    def interrupted(table, place, **options):
        place.write_bytes(b"half a tab")
        raise KeyboardInterrupt

    monkeypatch.setattr(pq, "write_table", interrupted)
    with pytest.raises(KeyboardInterrupt):
        tables.write(path, "estimates", estimates(3), axes=["acceleration"], settings=SETTINGS)
    assert path.read_bytes() == before


def test_another_kind_of_table_is_refused(tmp_path):
    path = tmp_path / "a.parquet"
    tables.write(path, "estimates", estimates(), axes=["acceleration"], settings=SETTINGS)
    with pytest.raises(ValueError, match="is not a table of sweeps"):
        tables.read(path, "sweeps")
    changed = pq.read_table(path)
    field = changed.schema.field("lambda").with_metadata({"unit": "1/min"})
    pq.write_table(changed.cast(changed.schema.set(1, field)), path)
    with pytest.raises(ValueError, match="is not a table of estimates"):
        tables.read(path, "estimates")
