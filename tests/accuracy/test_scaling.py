"""Jobs of sweeps in processes of their own: what is measured of them, and the page that says what it means."""

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from accuracy import scaling
from docs import cluster_page
from figures.plots import scaling as chart

SETTINGS = {
    "axes": {"psi0": {"start": 0.0, "stop": 6.0, "num": 10}, "z0": [0.0, 1.0e-4]},
    "model": {"acceleration": 30.0},
    "duration": 0.02,
    "tolerance": 1.0e-6,
    "settling": 1000,
}
PLAN = {"points": 20, "rows": 7, "shards": 3, "seconds": 1.0, "memory": 300.0, "gathering": 300.0}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scaling")


def test_all_shards_are_made_and_put_together(folder):
    case = {"varied": "shards", "settings": SETTINGS, "plan": PLAN, "threads": 1, "conveyors": 1}
    row = scaling.measured(case, folder)
    assert set(row) == {field.name for field in scaling.TABLES["scaling"]}
    assert [pq.read_metadata(folder / f"{k}.parquet").num_rows for k in range(3)] == [7, 7, 6]
    assert pq.read_metadata(folder / "all.parquet").num_rows == row["gathered"] == 20
    assert 0.0 < row["computing_seconds"] < row["shard_seconds"]
    # The program with its libraries.
    assert 100.0 < row["gathering_memory"] < row["shard_memory"] < 1000.0


def test_memory_is_that_of_the_process_itself(tmp_path):
    ballast = np.ones(10**8)
    before = scaling.peak_memory()
    assert before > 800.0
    row = scaling.run(settings=SETTINGS, threads=1, rows=[0, 1], path=str(tmp_path / "one.parquet"))
    assert row["memory"] < before - 300.0 < before
    del ballast


def table() -> pd.DataFrame:
    """One job of 100 points in 2 s on two threads; of the larger sweep one of ten."""
    columns = {
        "varied": ["points", "points", "conveyors", "threads", "threads", "shards"],
        "points": [100, 1000, 100, 100, 100, 100],
        "conveyors": [1, 1, 100, 1, 1, 1],
        "shards": [1, 10, 1, 1, 1, 2],
        "rows": [100, 100, 100, 100, 100, 50],
        "threads": [2, 2, 2, 1, 2, 2],
        "measured": [1, 1, 1, 1, 1, 2],
        "shard_seconds": [3.0, 3.0, 3.0, 5.0, 3.0, 4.0],
        "computing_seconds": [2.0, 2.0, 2.0, 4.0, 2.0, 2.0],
        "shard_memory": [300.0, 301.0, 302.0, 303.0, 304.0, 305.0],
        "estimated_seconds": [1.0, 4.0, 2.0, 4.0, 2.0, 1.0],
        "estimated_memory": [400.0] * 6,
        "gathered": [100, 300, 100, 100, 100, 100],
        "gathering_seconds": [1.0, 6.0, 1.0, 1.0, 1.0, 1.0],
        "gathering_memory": [200.0] * 6,
        "bytes": [30.0] * 6,
    }
    return pd.DataFrame(columns)


def test_what_the_whole_sweep_costs():
    rows = cluster_page.costs(table()).set_index("points")
    assert rows.core_hours[1000] == pytest.approx(10 * 3.0 * 2 / 3600.0)
    assert rows.minutes.to_dict() == pytest.approx({100: 1.0 / 60.0, 1000: 1000 * 6.0 / 300 / 60.0})
    told = cluster_page.numbers(table(), {"core_hours": 24.0, "most_jobs": 500, "job_seconds": 60.0})
    assert (told["least_ratio"], told["most_ratio"]) == ("0.5", "2")
    assert told["within_limit"]
    assert not cluster_page.numbers(table(), {"core_hours": 0.01, "most_jobs": 500, "job_seconds": 60.0})[
        "within_limit"
    ]
    assert (told["points"], told["most_memory"], told["start"]) == ("1,000", "305", "1.0")


def test_rates_count_the_points_that_were_made():
    rates = chart.rate(table())
    assert rates.tolist() == pytest.approx([100 / 3, 100 / 3, 100 / 3, 20, 100 / 3, 25])
