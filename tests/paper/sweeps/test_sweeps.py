"""Sweeps from the config: columns and rows, and independence of shards, blocks, threads and order."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from conveyor import Conveyor, Start, simulate
from conveyor.parameters import UNITS
from conveyor_pipeline.common import fields, tables
from conveyor_pipeline.paper.sweeps import shards

# The sweep of the README.
MINE = {
    "axes": {"acceleration": {"start": 30, "stop": 40, "num": 11}, "z0": [0.0, 1.0e-4]},
    "model": {"damping": 0.2},
    "duration": 1.0,
    "method": "event",
    "tolerance": 1.0e-10,
    "needs": "feeding",
}
COLUMNS = [
    "mean_velocity",
    "z_end",
    "vz_end",
    "x_end",
    "vx_end",
    "state",
    "period",
    "max_gap",
    "impacts",
    "contact_fraction",
    "impact_speed",
    "peak_force",
    "status",
    "longest_flight",
]
MIXED = {
    "axes": {
        "tension": ["allow", "clip"],
        "acceleration": {"start": 25, "stop": 85, "num": 4},
        "z0": ["conveyor", 0.0, 2.0e-4],
    },
    "duration": 0.2,
    "needs": "vertical",
}
# Initial conditions on conveyors with shared chaotic sets, between initial conditions on a conveyor without any.
MAP = {
    "axes": {"acceleration": [30.0, 40.0, 45.0, 48.0, 80.0], "psi0": [0.0, 3.0], "z0": [0.0, 1e-4, 2e-4, 3e-4, 4e-4]},
    "model": {},
    "duration": 0.02,
    "method": "event",
    "tolerance": 1.0e-6,
    "settling": 1000,
}
POINTS = 50


@pytest.fixture(scope="module")
def swept(built):
    """The same sweep with different shards and cores; a function returns the path of a table."""

    sweeps = {"mine": MINE, "mixed": MIXED}
    whole = {"prefix": "whole", "sweeps": sweeps}
    built.under(whole).make_in_process("--cores", "2", *(f"results/whole/sweeps/{name}.parquet" for name in sweeps))
    cut = {"prefix": "cut", "sharing": {"rows": 9}, "sweeps": sweeps}  # of 24 rows
    built.under(cut).make_in_process("results/cut/sweeps/mixed.parquet")
    return lambda prefix, name: built.folder / f"results/{prefix}/sweeps/{name}.parquet"


def test_columns_rows_and_units(swept):
    table = pd.read_parquet(swept("whole", "mine"))
    assert list(table) == ["acceleration", "z0", *COLUMNS]
    expected = [(a, z) for a in np.linspace(30, 40, 11) for z in (0.0, 1.0e-4)]
    assert list(zip(table.acceleration, table.z0, strict=True)) == expected
    assert (table.status == "ok").all()
    assert set(table.state) == {"first", "second"}
    schema = pq.read_schema(swept("whole", "mine"))
    units = {field.name: field.metadata[b"unit"].decode() for field in schema}
    assert units["mean_velocity"] == units["vx_end"] == "m/s"
    assert units["acceleration"] == UNITS["acceleration"]
    assert table.attrs["model"]["damping"] == 0.2


def test_a_row_is_a_run(swept):
    row = pd.read_parquet(swept("whole", "mine")).iloc[7]
    run = simulate(Conveyor(acceleration=row.acceleration, damping=0.2), Start(z=row.z0), tolerance=MINE["tolerance"])
    assert row.mean_velocity == pytest.approx(run.mean_velocity(), rel=1e-12)
    assert (row.z_end, row.x_end, row.impacts) == (run.z_end, run.x_end, run.impacts)


def test_words_on_axes_and_vertical_needs(swept):
    table = pd.read_parquet(swept("whole", "mixed"))
    assert list(table)[:3] == ["tension", "acceleration", "z0"]
    assert list(table.tension) == ["allow"] * 12 + ["clip"] * 12
    assert table.z0[:3].isna().tolist() == [True, False, False]
    assert table[["mean_velocity", "x_end", "vx_end"]].isna().all(axis=None)
    on_plate = simulate(Conveyor(acceleration=25.0), Start(z="conveyor"), duration=0.2)
    assert table.z_end[0] == pytest.approx(on_plate.z_end, rel=1e-9)


def test_equal_bytes_for_any_shards_and_cores(swept):
    shards = swept("cut", "mixed").parents[1] / "shards/mixed"
    assert sorted(path.name for path in shards.iterdir()) == ["0.parquet", "1.parquet", "2.parquet"]
    assert swept("whole", "mixed").read_bytes() == swept("cut", "mixed").read_bytes()


def test_a_sweep_has_one_job_unless_it_has_more_rows(built):
    sweep = {"axes": {"z0": {"start": 0.0, "stop": 1.0e-4, "num": 2001}}}
    for rows, jobs in ((2001, {"sweeps": 1}), (2000, {"shards": 2, "joined_sweeps": 1})):
        overlay = {"sharing": {"rows": rows}, "sweeps": {"many": sweep}}
        assert built.under(overlay).planned("results/sweeps/many.parquet") == jobs


def test_a_shard_that_does_not_exist_is_refused_in_the_dry_run(built):
    overlay = {"prefix": "cut", "sharing": {"rows": 9}, "sweeps": {"mixed": MIXED}}
    run = built.under(overlay).snakemake("--dry-run", "results/cut/shards/mixed/3.parquet")
    assert run.returncode != 0
    assert "sweeps.mixed has no shard 3: with this config, it has 3 from 0 on" in run.stdout


@pytest.fixture(scope="module")
def in_one(tmp_path_factory):
    """The file of a sweep that one thread computed in one piece."""
    return gathered(tmp_path_factory.mktemp("one"), MAP, 1, threads=1)


def gathered(folder, settings, count, threads):
    """The file of a sweep that is divided into this number of shards."""
    schema = [*(fields.AXES[axis] for axis in settings["axes"]), *shards.TABLES["sweeps"]]
    cuts = np.linspace(0, POINTS, count + 1).astype(int)
    rows = [list(ends) for ends in pairwise(cuts.tolist())]
    paths = [folder / f"{number}.parquet" for number in range(count)]
    for path, own in zip(paths, rows, strict=True):
        of_shard = settings | {"rows": own}
        blocks = shards.make(of_shard, threads=threads)
        tables.write_blocks(path, (tables.make("sweeps", schema, block, of_shard) for block in blocks))
    tables.gather(folder / "all.parquet", paths, "sweeps", settings, rows)
    return folder / "all.parquet"


@pytest.mark.parametrize(("count", "threads"), [(1, 2), (3, 1), (50, 2)])
def test_equal_bytes_for_any_number_of_shards_and_threads(tmp_path, in_one, count, threads):
    assert gathered(tmp_path, MAP, count, threads).read_bytes() == in_one.read_bytes()


def test_equal_bytes_for_any_blocks(tmp_path, monkeypatch, in_one):
    monkeypatch.setattr(shards, "BLOCK", 7)
    assert gathered(tmp_path, MAP, 2, 1).read_bytes() == in_one.read_bytes()


def test_rows_do_not_depend_on_their_order(in_one):
    """With the values of all axes in another order, the table has the same rows in another order."""
    permuted = {name: np.random.default_rng(1).permutation(values).tolist() for name, values in MAP["axes"].items()}
    found = pd.DataFrame(shards.columns(MAP | {"axes": permuted}))
    axes = list(permuted)
    expected = pd.read_parquet(in_one).sort_values(axes, ignore_index=True)
    assert {"first", "second", "chaos"} <= set(expected.state)
    pd.testing.assert_frame_equal(
        found[list(expected)].sort_values(axes, ignore_index=True), expected, check_dtype=False, check_exact=True
    )


def test_a_run_that_failed_has_no_state(monkeypatch):
    """It has none, whatever its final numbers are; another run of the same motion has its state."""
    true = shards.sweep

    def failing(parameters, **options):
        return {**true(parameters, **options), "status": np.array(["ok", "contact too stiff"])}

    monkeypatch.setattr(shards, "sweep", failing)
    settings = {
        "axes": {"z0": [0.0, 1e-4]},
        "model": {"acceleration": 30.0},
        "duration": 0.1,
        "settling": 2000,
    }
    found = shards.columns(settings)
    assert (list(found["state"]), list(found["period"])) == (["first", "undecided"], [1, 0])
    assert np.isfinite(found["longest_flight"]).tolist() == [True, False]
