"""Comparison of the solver with other methods, on the scenes of the config."""

import numpy as np
import pandas as pd
import pytest
from project import ROOT, read_config

from conveyor.simulation import simulate
from conveyor_pipeline.common import grid
from conveyor_pipeline.study.accuracy import benchmark_page, precision, speed
from conveyor_pipeline.study.accuracy.scenes import LONGEST, SCENES

CONFIG = read_config()


def compare(scene: str, duration: float, repeats: int) -> pd.DataFrame:
    """Work and precision of the solver and of an integrator of SciPy, with the settings and the times as attributes."""
    model, default = CONFIG["model"] | SCENES[scene], CONFIG["solver"]["tolerance"]
    settings = {"duration": min(duration, LONGEST.get(scene, duration)), "default": default, "model": model}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(precision, "TOLERANCES", (1e-4, 1e-8, 1e-12))
        patch.setattr(precision, "STEPS", (5e-7,))
        patch.setattr(precision, "SCIPY", {"modes": {"DOP853": (1e-4, 1e-13)}})
        patch.setattr(precision, "SECONDS", 0.02)
        tables = precision.make(settings, repeats)
    table = pd.DataFrame(tables["precision"])
    table.attrs = settings | {"times": pd.DataFrame(tables["precision_times"])}
    return table


@pytest.fixture(scope="module", params=SCENES)
def compared(request):
    return compare(request.param, duration=1.0, repeats=2)


def test_the_table_does_not_depend_on_the_repetitions():
    one, two = (compare("jumping", duration=0.1, repeats=repeats) for repeats in (1, 2))
    pd.testing.assert_frame_equal(one, two, check_exact=True)


def test_solver_and_an_independent_integration_agree(compared):
    best = compared[(compared.method == "DOP853") & (compared.tolerance == 1e-13)].iloc[0]
    assert best.outcome == "ok"
    # In chaos, errors grow.
    least = 1e-9 if compared.attrs["duration"] < 1.0 else 1e-11
    assert best.velocity_error < least
    assert best.state_error < least
    # Between its steps, DOP853 interpolates with a lower order.
    assert best.trajectory_error < 1e-9


def test_errors_of_the_trajectory_belong_to_the_run_of_the_method(compared):
    settings = compared.attrs
    conveyor, start = grid.conveyor_and_start(settings["model"])
    interval = precision.SAMPLE_INTERVAL
    times = interval * np.arange(1, int(settings["duration"] / interval) + 1)
    omega = 2.0 * np.pi * conveyor.frequency
    scales = conveyor.acceleration / omega**2 * np.array([np.cos(conveyor.angle), np.sin(conveyor.angle)])

    def observed(**accuracy):
        samples = simulate(conveyor, start, duration=settings["duration"], **accuracy).sample(times)
        return np.stack([samples["x"], samples["z"]], axis=1) / scales

    truth = observed(tolerance=1e-14, reuse=False)
    own = compared[compared.treatment.isin(["exact", "fixed step"]) & (compared.outcome == "ok")]
    assert {"event", "semi_implicit_euler", "rk4"} <= set(own.method)
    for row in own.itertuples():
        accuracy = {"tolerance": row.tolerance} if row.method == "event" else {"step": row.step}
        positions = observed(method=row.method, **accuracy)
        assert row.trajectory_error == pytest.approx(np.sqrt(np.mean((positions - truth) ** 2)), rel=1e-6)


def test_times_belong_to_the_same_runs(compared):
    times = compared.attrs["times"]
    run = list(precision.Method._fields)
    pd.testing.assert_frame_equal(times[run], compared[run])
    solver = times.method == "event"
    assert 0.0 < times.seconds[solver].max() < times.seconds[~solver].min()


def test_the_page_compares_the_default_tolerance_with_the_paper_s_method(compared):
    tables = {
        f"{scene}{ending}": table
        for scene in SCENES
        for ending, table in (("", compared), ("_times", compared.attrs["times"]))
    }
    template = (ROOT / "workflow/rules/study/benchmark.md").read_text(encoding="utf-8")
    text = benchmark_page.make(template, **tables)
    rows = [line.split(" | ") for line in text.splitlines() if line.startswith("| ") and "Motion" not in line]
    assert [row[0] for row in rows] == [f"| {scene}" for scene in SCENES]
    found = speed.at_default("one", compared, compared.attrs["times"])
    assert found["tolerance"] == CONFIG["solver"]["tolerance"]
    assert found["error"] < 1e-8 < 1e-4 * found["paper_error"]
    # Much faster than the paper's method on any machine; results/benchmark.md has the exact factor.
    assert found["speed"] > 10.0
    # A part that rides for a second repeats its steps, a chaotic one cannot. Repeated steps do not count as computed.
    acceleration = compared.attrs["model"]["acceleration"]
    assert (found["repeated_evaluations"] > 0) == (acceleration in (30.0, 47.0))
