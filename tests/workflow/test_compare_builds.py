"""The comparison of two builds: exact, within a tolerance, and differences that it must not miss."""

from types import SimpleNamespace

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import compare_builds
from builds.provenance import MAY_DIFFER

TABLE = {"x": [1.0, 2.0, None], "state": ["first", "second", None], "list": [[1.0], [], [2.0, None]]}


@pytest.fixture
def folders(tmp_path, monkeypatch):
    """Two folders with the same table, and a function that changes the second table."""
    monkeypatch.chdir(tmp_path)
    for name in ("one", "other"):
        (tmp_path / name / "sweeps").mkdir(parents=True)
        pq.write_table(pa.table(TABLE), tmp_path / name / "sweeps/a.parquet")

    def change(name="sweeps/a.parquet", **columns):
        pq.write_table(pa.table(TABLE | columns), tmp_path / "other" / name)
        return tmp_path

    return change


@pytest.fixture
def run(capsys):
    """A function that compares the folders, and returns the exit status and what was printed."""

    def compare(*arguments):
        try:
            status = compare_builds.main(["one", "other", *arguments])
        except SystemExit as error:
            status = error.code
        return SimpleNamespace(returncode=status, **capsys.readouterr()._asdict())

    return compare


def test_equal_tables(run, folders):
    folders()
    found = run()
    assert found.returncode == 0, found.err
    assert found.out == "1 tables: 1 equal\n"


def test_a_difference_within_the_tolerance(run, folders):
    folders(x=[1.0, 2.0 + 1e-12, None])
    found = run()
    assert found.returncode == 0
    assert "sweeps/a.parquet: within tolerance\n    x: 1 of 3 rows, by at most 1e-12 (relative 5e-13)" in found.out
    assert run("--tolerance", "0").returncode == 1


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"x": [1.0, 2.1, None]}, "x: 1 of 3 rows, by at most 0.1 (relative 0.0476), first in row 1, 2 and 2.1"),
        ({"x": [1.0, 2.0, 0.0]}, "x: 1 of 3 rows, by at most inf"),
        ({"state": ["first", "chaos", None]}, "state: first in row 1, second and chaos"),
        ({"list": [[1.0], [], [2.0, 1.0]]}, "list: first in row 2"),
        ({"more": [1, 2, 3]}, "columns: more: int64"),
        ({name: values[:2] for name, values in TABLE.items()}, "rows: 3 and 2"),
    ],
)
def test_a_difference_is_named(run, folders, columns, message):
    folders(**columns)
    found = run()
    assert found.returncode == 1
    assert "sweeps/a.parquet: DIFFERENT" in found.out
    assert message in found.out


def test_a_setting_that_differs_is_named(run, folders):
    folder = folders()
    for name, duration in (("one", 0.5), ("other", 0.6)):
        frame = pa.table(TABLE).to_pandas()
        frame.attrs = {"duration": duration, "step": 1e-6}
        frame.to_parquet(folder / name / "sweeps/a.parquet")
    found = run()
    assert found.returncode == 1
    assert found.out.startswith("sweeps/a.parquet: DIFFERENT\n    setting duration: 0.5 and 0.6\n1 tables")


def test_shards_and_other_prefixes_do_not_count(run, folders):
    folder = folders()
    for name in ("shards/a", "reduced/sweeps"):
        (folder / "other" / name).mkdir(parents=True)
        pq.write_table(pa.table(TABLE), folder / "other" / name / "0.parquet")
    pq.write_table(pa.table(TABLE), folder / "other/reduced/claims.parquet")
    found = run()
    assert found.returncode == 0
    assert found.out == "1 tables: 1 equal\n"


def test_a_table_of_one_build_only(run, folders):
    folders("sweeps/b.parquet")
    found = run()
    assert found.returncode == 1
    assert "sweeps/b.parquet: DIFFERENT\n    only in other" in found.out


def test_measured_times_do_not_count(run, folders):
    folder = folders(x=[5.0, 2.0, None])
    (folder / "one/manifest.sha256").write_text(f"{MAY_DIFFER}one/sweeps/a.parquet\n")
    found = run()
    assert found.returncode == 0
    assert "1 tables: 1 measured times" in found.out


def test_a_folder_without_tables_is_an_error(run, folders):
    folder = folders()
    (folder / "one/sweeps/a.parquet").unlink()
    found = run()
    assert found.returncode == 2
    assert "one has no tables" in found.err
