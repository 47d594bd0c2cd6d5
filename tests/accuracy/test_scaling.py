"""Jobs of sweeps in separate processes: their measured times and memory, and the page about them."""

import io
import json

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
from project import ROOT

from accuracy import scaling
from docs import cluster_page
from figures.plots import scaling as chart

SETTINGS = {
    "axes": {"psi0": {"start": 0.0, "stop": 6.0, "num": 10}, "z0": [0.0, 1.0e-4]},
    "model": {"acceleration": 30.0},
    "duration": 0.02,
    "tolerance": 1.0e-6,
    "settling": 1000,
    "mean_settling": 375,
}
PLAN = {"points": 20, "rows": 7, "shards": 3, "seconds": 1.0, "memory": 300.0, "gathering": 300.0}
CASE = {"varied": "points", "settings": SETTINGS, "plan": PLAN, "threads": 1, "conveyors": 1, "measured": 3}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scaling")


def measured(case, folder):
    made = scaling.measure_shards(case, folder)
    return scaling.make_row(case, made, scaling.measure_gathering(case, folder))


def test_all_shards_are_made_and_joined(folder):
    row = measured(CASE, folder)
    assert set(row) == {field.name for field in scaling.TABLES["scaling"]}
    assert [pq.read_metadata(folder / f"{k}.parquet").num_rows for k in range(3)] == [7, 7, 6]
    assert pq.read_metadata(folder / "all.parquet").num_rows == row["gathered"] == 20
    assert (row["measured"], row["computed"]) == (3, 20)
    begin = row["shard_seconds"] - row["loading_seconds"] - row["computing_seconds"]
    assert begin > 0.0 and row["computing_seconds"] > 0.0
    # Memory of the program with its libraries.
    assert 100.0 < row["gathering_memory"] < row["shard_memory"] < 1000.0


def test_shards_that_are_not_made_are_copied(tmp_path):
    row = measured(CASE | {"measured": 1}, tmp_path)
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["0.parquet", "all.parquet"]
    assert (row["measured"], row["computed"], row["gathered"]) == (1, 7, 21)


def test_medians_of_several_rounds_and_the_largest_memory_count():
    def shard(whole, memory):
        return {"loading": 1.0, "computing": whole - 2.0, "memory": memory, "whole": whole}

    rounds = [[shard(3.0, 100.0), shard(9.0, 70.0)], [shard(7.0, 90.0), shard(4.0, 60.0)]]
    rounds.append([shard(4.0, 80.0), shard(5.0, 50.0)])
    assert scaling.summarise(rounds) == [shard(4.0, 100.0), shard(5.0, 70.0)]


def test_sweeps_are_made_in_turns_until_they_have_taken_long_enough(monkeypatch):
    """The first sweep runs in all rounds, the second in two, the third in one; each is joined once."""
    done, together = [], []
    cases = [CASE | {"conveyors": k, "whole": whole} for k, whole in enumerate((1.0, 20.0, 31.0))]

    def shards_of(case, _):
        done.append(case["conveyors"])
        late = 0.1 * done.count(case["conveyors"])
        return [{"loading": 0.5, "computing": late, "memory": 100.0, "whole": case["whole"]}]

    def gather_shards(case, _):
        together.append(case["conveyors"])
        return {"whole": 2.0, "memory": 50.0, "rows": 20, "bytes": 400}

    monkeypatch.setattr(scaling, "measure_job", lambda **_: None)
    monkeypatch.setattr(scaling, "measure_shards", shards_of)
    monkeypatch.setattr(scaling, "measure_gathering", gather_shards)
    found = scaling.make({}, cases)
    assert done == [0, 1, 2, 0, 1, 0, 0, 0]
    assert together == [0, 1, 2]
    assert found["computing_seconds"] == pytest.approx([0.3, 0.15, 0.1])
    assert found["shard_seconds"] == [1.0, 20.0, 31.0]


def test_each_case_is_a_row(monkeypatch):
    monkeypatch.setattr(scaling, "ROUNDS", 1)
    few = CASE | {"plan": PLAN | {"points": 2, "rows": 2, "shards": 1}, "measured": 1}
    few["settings"] = SETTINGS | {"axes": {"z0": [0.0, 1.0e-4]}}
    found = scaling.make({}, [CASE, few])
    assert list(found) == [field.name for field in scaling.TABLES["scaling"]]
    assert found["computed"] == [20, 2]


@pytest.mark.parametrize(("end", "first"), [(9, 9), (40, 15)])
def test_the_first_points_are_computed_alone_before_all(monkeypatch, tmp_path, end, first):
    path, made = tmp_path / "some.parquet", []

    def make_shard(rows, **others):
        made.append(tuple(rows))
        assert not path.exists()  # no job overwrites a file
        path.touch()

    monkeypatch.setattr(scaling, "make_shard", make_shard)
    task = {"path": str(path), "settings": {}, "rows": [7, end], "threads": 1}
    monkeypatch.setattr("sys.stdin", io.StringIO(json.dumps(task)))
    scaling.run_job()
    assert made == [(7, first), (7, end)]


@pytest.mark.parametrize("rows", [[7, 13], [0, 20]])
def test_loading_compiled_code_does_not_count_as_computing(tmp_path, rows):
    """A few points take about a millisecond, loading takes about a hundred, also of code that only many points need."""
    for name in ("compiled", "some"):
        made = scaling.measure_job(settings=SETTINGS, threads=1, rows=rows, path=str(tmp_path / f"{name}.parquet"))
    assert made["computing"] < 0.5 * made["loading"] < 0.5 * made["whole"]
    assert pq.read_table(tmp_path / "some.parquet")["z0"].to_pylist() == ([0.0, 1.0e-4] * 10)[slice(*rows)]


def test_memory_of_the_process_itself_counts(tmp_path):
    ballast = np.ones(10**8)
    before = scaling.peak_memory()
    assert before > 800.0
    row = scaling.measure_job(settings=SETTINGS, threads=1, rows=[0, 1], path=str(tmp_path / "one.parquet"))
    assert row["memory"] < before - 300.0 < before
    del ballast


def table() -> pd.DataFrame:
    """One job: 100 points in 2 s on two threads. The largest sweep ran one of ten shards, another sweep all three."""
    columns = {
        "varied": ["points", "points", "points", "conveyors", "threads", "threads", "shards"],
        "points": [100, 250, 1000, 100, 100, 100, 100],
        "conveyors": [1, 1, 1, 100, 1, 1, 1],
        "shards": [1, 3, 10, 1, 1, 1, 2],
        "rows": [100, 100, 100, 100, 100, 100, 50],
        "threads": [2, 2, 2, 2, 1, 2, 2],
        "measured": [1, 3, 1, 1, 1, 1, 2],
        "computed": [100, 250, 100, 100, 100, 100, 100],
        "shard_seconds": [3.0, 8.0, 3.0, 3.0, 5.0, 3.0, 4.0],
        "loading_seconds": [0.25, 0.75, 0.25, 0.25, 0.25, 0.25, 0.5],
        "computing_seconds": [2.0, 5.0, 2.0, 2.0, 4.0, 2.0, 2.0],
        "shard_memory": [300.0, 300.0, 301.0, 302.0, 303.0, 304.0, 305.0],
        "estimated_seconds": [1.0, 4.0, 4.0, 2.0, 4.0, 2.0, 1.0],
        "estimated_memory": [400.0] * 7,
        "gathered": [100, 250, 300, 100, 100, 100, 100],
        "gathering_seconds": [1.0, 2.0, 6.0, 1.0, 1.0, 1.0, 1.0],
        "gathering_memory": [200.0] * 7,
        "bytes": [30.0] * 7,
    }
    return pd.DataFrame(columns)


def test_cost_of_the_whole_sweep():
    rows = cluster_page.total_costs(table()).set_index("points")
    assert rows.core_hours.to_dict() == pytest.approx(
        {100: 3.0 * 2 / 3600.0, 250: 8.0 * 2 / 3600.0, 1000: 10 * 3.0 * 2 / 3600.0}
    )
    assert rows.microseconds.tolist() == pytest.approx([2e4, 2e4, 2e4])
    assert rows.minutes.to_dict() == pytest.approx({100: 1.0 / 60.0, 250: 2.0 / 60.0, 1000: 1000 * 6.0 / 300 / 60.0})


def test_cost_of_a_point_without_and_with_the_start_of_the_job():
    computing, whole = chart.costs(table())
    assert computing.tolist() == pytest.approx([2e4, 2e4, 2e4, 2e4, 4e4, 2e4, 2e4])
    assert whole.tolist() == pytest.approx([3e4, 3.2e4, 3e4, 3e4, 5e4, 3e4, 4e4])


def cluster(core_hours: float) -> str:
    """The page of clusters with a limit on core hours, on one line."""
    found = table()
    found.attrs["sharing"] = {"core_hours": core_hours, "most_jobs": 500, "job_seconds": 60.0}
    template = (ROOT / "workflow/templates/cluster.md").read_text(encoding="utf-8")
    return " ".join(cluster_page.make(template, found).split())


def test_the_page_of_clusters():
    page = cluster(24.0)
    assert "| 250 | 3 | 3 | 100 | 20000.0 |" in page
    assert "For sweeps of up to 250 points" in page
    assert "spends 0.8 s on starting Python and its imports, and 0.2 s on its first points" in page
    assert "The estimates are 0.5 to 2 times the measured times" in page
    assert "No job took more than 305 MB" in page
    assert "At 1,000 points:" in page
    assert "The limit is not reached." in page
    assert "The sweep is rejected unless you raise the limit." in cluster(0.01)
