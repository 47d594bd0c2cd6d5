"""Comparison of the solver with other methods, on the cases of the benchmark and the scenes of the config."""

import numpy as np
import pandas as pd
import pytest
from project import ROOT, read_config

from accuracy import benchmark, precision
from accuracy.scenes import SCENES
from conveyor.simulation import simulate
from pipeline import grid

CONFIG = read_config()


def test_benchmark_reaches_its_goals():
    cases = benchmark.CASES
    found = benchmark.columns(CONFIG["model"], CONFIG["solver"]["tolerance"], 1)
    assert set(found["case"][found["chosen"] == "default"]) == set(cases)
    wanted = np.array([cases[name]["wanted"]["error"] for name in found["case"]])
    assert (found["error"] <= wanted).all()
    assert (found["euler_error"] > 1e4 * found["error"]).all()
    assert (found["euler_steps"] == benchmark.DURATION / benchmark.STEP).all()
    assert (found["steps"] < 1e-3 * found["euler_steps"]).all()
    # Much faster than the paper's method on any machine; results/benchmark.md has the exact factor.
    assert (found["speed"] > 10.0).all()
    # A riding part repeats its steps, a chaotic one cannot. Repeated steps do not count as computed.
    repeated = dict(zip(found["case"], found["repeated_steps"], strict=True))
    assert repeated["D"] == 0 < repeated["B"]
    template = (ROOT / "workflow/templates/benchmark.md").read_text(encoding="utf-8")
    text = benchmark.report(template, found, 1)
    rows = [line.split(" | ")[0] for line in text.splitlines() if line.startswith("| ") and "Case" not in line]
    assert rows == [f"| {name}" for name in found["case"]]
    slow = {**found, "speed": np.full(len(rows), 1.0)}
    assert "miss a goal at the default tolerance: A (1 of" in benchmark.report(template, slow, 1)


def compare(scene: str, duration: float, threads: int) -> pd.DataFrame:
    """Work and precision of the solver and of an integrator of SciPy, with the settings and the times as attributes."""
    settings = {"duration": duration, "model": CONFIG["model"] | SCENES[scene]}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(precision, "TOLERANCES", (1e-4, 1e-8, 1e-12))
        patch.setattr(precision, "STEPS", (5e-7,))
        patch.setattr(precision, "SCIPY", {"modes": {"DOP853": (1e-4, 1e-13)}})
        patch.setattr(precision, "SECONDS", 0.02)
        tables = precision.make(settings, threads)
    table = pd.DataFrame(tables["precision"])
    table.attrs = settings | {"times": pd.DataFrame(tables["precision_times"])}
    return table


@pytest.fixture(scope="module", params=["jumping", "riding", "bouncing"])
def compared(request):
    return compare(request.param, duration=1.0, threads=2)


def test_the_table_does_not_depend_on_threads():
    one, two = (compare("jumping", duration=0.1, threads=threads) for threads in (1, 2))
    pd.testing.assert_frame_equal(one, two, check_exact=True)


def test_solver_and_an_independent_integration_agree(compared):
    best = compared[(compared.method == "DOP853") & (compared.tolerance == 1e-13)].iloc[0]
    assert best.outcome == "ok"
    assert best.velocity_error < 1e-11
    assert best.state_error < 1e-11
    # Between its steps, DOP853 interpolates with a lower order.
    assert best.trajectory_error < 1e-9
    assert best.event_error < 1e-9


def test_errors_of_trajectory_and_events_belong_to_the_run_of_the_method(compared):
    settings = compared.attrs
    conveyor, start = grid.conveyor_and_start(settings["model"])
    interval = precision.SAMPLE_INTERVAL
    times = interval * np.arange(1, int(settings["duration"] / interval) + 1)
    omega = 2.0 * np.pi * conveyor.frequency
    scales = conveyor.acceleration / omega**2 * np.array([np.cos(conveyor.angle), np.sin(conveyor.angle)])

    def observed(**accuracy):
        run = simulate(conveyor, start, duration=settings["duration"], **accuracy)
        samples = run.sample(times)
        changes = run.events["time"][np.isin(run.events["kind"], ["impact", "separation"])]
        return np.stack([samples["x"], samples["z"]], axis=1) / scales, changes

    truth, true_changes = observed(tolerance=1e-14, reuse=False)
    own = compared[compared.treatment.isin(["exact", "fixed step"]) & (compared.outcome == "ok")]
    assert {"event", "semi_implicit_euler", "rk4"} <= set(own.method)
    for row in own.itertuples():
        accuracy = {"tolerance": row.tolerance} if row.method == "event" else {"step": row.step}
        positions, changes = observed(method=row.method, **accuracy)
        assert row.trajectory_error == pytest.approx(np.sqrt(np.mean((positions - truth) ** 2)), rel=1e-6)
        if len(changes) == len(true_changes):
            largest = np.abs(changes - true_changes).max(initial=0.0) * conveyor.frequency
            assert row.event_error == pytest.approx(largest, rel=1e-6)
        else:
            assert np.isnan(row.event_error)


def test_times_belong_to_the_same_runs(compared):
    times = compared.attrs["times"]
    run = list(precision.Method._fields)
    pd.testing.assert_frame_equal(times[run], compared[run])
    solver = times.method == "event"
    # A fast run is repeated until its turn ends.
    assert times.repeats[solver].min() > 2
    assert 0.0 < times.seconds[solver].max() < times.seconds[~solver].min()


def test_runs_take_turns_until_each_has_run_long_enough(monkeypatch):
    clock, made = 0.0, []

    def lasting(name, seconds):
        def run():
            nonlocal clock
            clock += seconds
            made.append(name)
            return name

        return run

    monkeypatch.setattr(precision, "thread_time", lambda: clock)
    monkeypatch.setattr(precision, "TURN", 0.25)
    runs = [lasting("fast", 0.125), lasting("slow", 0.5), lasting("slowest", 2.0)]
    found, times = precision.run_in_turns(runs, repeats=3, seconds=1.0)
    assert found == ["fast", "slow", "slowest"]
    fast = ["fast"] * 2
    assert made == [*fast, "slow", "slowest", *fast, "slow", *fast]
    assert times == [[0.125] * 6, [0.5] * 2, [2.0]]
