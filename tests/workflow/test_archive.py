"""The archive: complete, unchanged, and enough to draw its figures again without the project."""

import json
import os
import shutil
import subprocess
import sys

import duckdb
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from project import FIGURES, Project

from pipeline import fields


@pytest.fixture(scope="module")
def archive(built, tmp_path_factory):
    """The archive of the small project, moved elsewhere."""
    project = Project(shutil.copytree(built.folder, tmp_path_factory.mktemp("project") / "copy", symlinks=True))
    project.make_in_process("archive")
    return shutil.copytree(project.folder / "archive/paper", tmp_path_factory.mktemp("alone") / "archive")


@pytest.fixture
def copy(archive, tmp_path):
    return shutil.copytree(archive, tmp_path / "copy")


def redraw(folder) -> subprocess.CompletedProcess:
    """Redraw an archive outside the project, with nothing but the archive."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [sys.executable, str(folder / "scripts/redraw.py")]
    return subprocess.run(command, cwd="/", env=environment, capture_output=True, text=True, check=False)


def test_all_files_have_correct_sums(archive):
    check = ["sha256sum", "--quiet", "--strict", "--check", "SHA256SUMS"]
    subprocess.run(check, cwd=archive, check=True)
    listed = {line.split("  ", maxsplit=1)[1] for line in (archive / "SHA256SUMS").read_text().splitlines()}
    files = {path.relative_to(archive).as_posix() for path in archive.rglob("*") if path.is_file()}
    assert files - listed == {"SHA256SUMS", ".snakemake_timestamp"}
    assert listed <= files
    for file in ("results/provenance.json", "results/claims.md", "results/captions/fig08.rst", "config/config.yaml"):
        assert file in listed


def test_redrawn_figures_are_equal_byte_for_byte(archive):
    run = redraw(archive)
    assert run.returncode == 0, run.stderr
    assert f"{len(FIGURES)} figures drawn" in run.stdout
    # Without a terminal there are lines instead of a bar.
    assert "\r" not in run.stderr
    assert run.stderr.splitlines()[-1].startswith(f"drawn: {len(FIGURES)} of {len(FIGURES)} figures")
    for figure in FIGURES:
        again = (archive / f"redrawn/figures/{figure}.pdf").read_bytes()
        assert again == (archive / f"figures/{figure}.pdf").read_bytes()


def test_a_figure_that_differs_is_named(copy):
    drawn = json.loads((copy / "figures.json").read_text())
    drawn = {figure: drawn[figure] for figure in ("figures/fig03.pdf", "figures/fig08.pdf")}
    drawn["figures/fig03.pdf"]["settings"]["critical_acceleration"] += 1.0
    (copy / "figures.json").write_text(json.dumps(drawn))
    run = redraw(copy)
    assert run.returncode == 1
    assert "1 of 2 figures differ from the archive: figures/fig03.pdf" in run.stderr


def test_a_large_archive_is_refused(built, tmp_path):
    project = Project(shutil.copytree(built.folder, tmp_path / "copy", symlinks=True), {"archive": {"megabytes": 0.5}})
    run = project.snakemake("archive")
    assert run.returncode == 1
    assert "MB, more than archive.megabytes = 0.5; largest files" in run.stdout
    assert not (project.folder / "archive/paper").exists()


def test_only_the_final_states_of_runs_are_left_out(archive, built):
    ends = {field.name for field in fields.ENDS}
    for path in archive.rglob("*.parquet"):
        whole = pq.read_table(built.folder / path.relative_to(archive))
        kept = [name for name in whole.column_names if name not in ends]
        assert len(kept) == len(whole.column_names) - (4 if path.parent.name == "sweeps" else 0)
        assert pq.read_table(path).equals(whole.select(kept))


def test_pandas_and_duckdb_read_the_same_numbers_and_units(archive):
    """As ARCHIVE.md describes."""
    files = sorted(archive.rglob("*.parquet"))
    assert len(files) > 4
    for file in files:
        schema = pq.read_schema(file)
        table = pa.Table.from_pandas(pd.read_parquet(file), schema=schema)
        by_duckdb = duckdb.sql(f"SELECT * FROM read_parquet('{file}')").to_arrow_table()
        assert by_duckdb.cast(schema).equals(table)
        query = f"SELECT decode(value) FROM parquet_kv_metadata('{file}') WHERE decode(key) = 'units'"
        units = json.loads(schema.metadata[b"units"])
        assert json.loads(duckdb.sql(query).fetchall()[0][0]) == units
        assert {field.name: field.metadata[b"unit"].decode() for field in schema}.items() <= units.items()
