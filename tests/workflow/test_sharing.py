"""Estimated costs of sweeps and their division into jobs: counts by hand, and agreement with the estimates."""

import pytest
from project import merged, read_config

from pipeline import grid
from pipeline.labelling import batches_by_conveyor
from workflow.config import problems, sharing
from workflow.config.entries import resolve
from workflow.config.sharing import THREADS, conveyors_of, plan, throwing_share

CONFIG = read_config()
SHARING = CONFIG["sharing"]


def span(stop: float, num: int) -> dict:
    return {"start": 0.0, "stop": stop, "num": num}


def sweep(**axes) -> dict:
    return {"axes": axes, "duration": 0.02, "needs": "vertical"}


def planned(entry: dict):
    config = merged(CONFIG, {"sweeps": {"mine": entry}})
    return plan(config["sharing"], resolve(config, "sweeps", "mine"))


AXES = [
    {"acceleration": [30.0, 40.0, 50.0], "z0": [0.0, 1e-4, 2e-4, 3e-4]},
    {"z0": [0.0, 1e-4, 2e-4, 3e-4], "acceleration": [30.0, 40.0, 50.0]},
    {"acceleration": [30.0, 40.0], "psi0": [0.0, 1.0, 2.0], "friction": [0.1, 0.2]},
    {"psi0": [0.0, 1.0, 2.0], "z0": [0.0, 1e-4]},
]


@pytest.mark.parametrize("axes", AXES, ids=" ".join)
def test_number_of_conveyors_in_the_first_rows(axes):
    """If the rows end within a value of a slow axis, its conveyors count completely."""
    counts = []
    for rows in range(1, 13 if "friction" in axes else 7):
        _, parameters = grid.product(axes, {}, (0, rows))
        conveyors = len(set(zip(parameters["acceleration"], parameters["friction"], strict=True)))
        counts.append((conveyors_of(axes, rows), conveyors))
        assert len(batches_by_conveyor(parameters)) == 1
    assert all(estimated >= found for estimated, found in counts)
    assert counts[0] == (1, 1)
    assert counts[-1][0] == counts[-1][1]


@pytest.mark.parametrize(
    ("axes", "share"),
    [
        # g / sin 12° = 47.18 m/s²
        ({"acceleration": [40.0, 47.0, 48.0, 80.0]}, 0.5),
        ({"acceleration": {"start": 27.18, "stop": 67.18, "num": 5}}, 0.5),
        ({"acceleration": {"start": 60.0, "stop": 60.0, "num": 1}}, 1.0),
        ({"z0": [0.0]}, 0.0),
    ],
)
def test_a_plate_throws_parts_where_its_acceleration_exceeds_gravity(axes, share):
    model = {name: value for name, value in CONFIG["model"].items() if name not in axes}
    assert throwing_share({"axes": axes, "model": model}) == pytest.approx(share, abs=1e-3)


def test_jobs_take_the_requested_time():
    """Slow points make more jobs."""
    points = sweep(psi0=span(6.0, 1000), z0=span(1e-4, 10_000))
    quick, slow = planned(points), planned(points | {"duration": 1.0})
    for shared in (quick, slow):
        assert 0.9 * THREADS * SHARING["job_seconds"] < shared.seconds <= THREADS * SHARING["job_seconds"]
        assert shared.rows * (shared.shards - 1) < shared.points == 10**7 <= shared.rows * shared.shards
    assert slow.shards > 1.5 * quick.shards


@pytest.mark.parametrize("points", [10**5, 10**6, 10**7, 10**8])
def test_no_job_of_a_usual_sweep_takes_a_gigabyte(points):
    shared = planned(sweep(psi0=span(6.0, 1000), z0=span(1e-4, points // 1000)))
    assert max(shared.memory, shared.gathering) < 1000.0


def test_a_sweep_has_at_most_the_allowed_number_of_jobs(monkeypatch):
    monkeypatch.setattr(sharing, "MOST_JOBS", 7)
    shared = planned(sweep(psi0=span(6.0, 10_000), z0=span(1e-4, 10_000)))
    assert shared.shards == 7


def test_an_expensive_sweep_is_refused_with_its_cost_and_the_key():
    huge = sweep(psi0=span(6.0, 100_000), z0=span(1e-4, 100_000))
    (line,) = problems(merged(CONFIG, {"sweeps": {"mine": huge}}))
    shared = planned(huge)
    assert line.startswith(f"sweeps.mine.axes makes 10,000,000,000 points, about {shared.core_hours:.2g} core hours")
    assert line.endswith(f"or raise sharing.core_hours = {SHARING['core_hours']:g}")
    enough = {"sharing": {"core_hours": 1.01 * shared.core_hours}, "sweeps": {"mine": huge}}
    assert problems(merged(CONFIG, enough)) == []
