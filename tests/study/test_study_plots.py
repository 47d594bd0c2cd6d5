"""Plots of the floor study."""

import numpy as np
import pandas as pd
import pytest

from conveyor_pipeline.study.accuracy import precision, speed
from conveyor_pipeline.study.accuracy.scipy_integrators import (
    EVENT_LOST,
    GAVE_UP,
    NOT_FINITE,
    OK,
    STEP_TOO_SMALL,
    STUCK,
)
from conveyor_pipeline.study.caption_numbers.work_precision import numbers
from conveyor_pipeline.study.figures import work_precision


def test_failures_are_listed_in_order():
    """A method that is right in each run is not listed."""
    runs = pd.DataFrame(
        [
            ("event", "exact", "ok"),
            ("euler", "fixed step", "wrong state"),
            ("DOP853", "events", "through the plate"),
            ("DOP853", "modes", "ok"),
            ("euler", "fixed step", "ok"),
        ],
        columns=["method", "treatment", "outcome"],
    )
    assert work_precision.failing_methods(runs) == [("euler", "fixed step"), ("DOP853", "events")]


def test_every_outcome_has_a_marker():
    of_runs = {OK, GAVE_UP, STUCK, STEP_TOO_SMALL, EVENT_LOST, NOT_FINITE}
    assert set(work_precision.OUTCOMES) == {*of_runs, precision.WRONG, precision.THROUGH}


@pytest.mark.parametrize(("method", "name"), [("rk4", "RK4, fixed step"), ("DOP853", "SciPy's DOP853")])
def test_arrow_and_caption_compare_with_the_fastest_other_method(method, name):
    runs = pd.DataFrame(
        [
            ("event", speed.OWN, np.nan, 1e-10, 1e-12, "ok", 1e-4),
            ("euler", "fixed step", 5e-7, np.nan, 1e-3, "ok", 0.03),
            ("euler", "fixed step", 5e-3, np.nan, 1e-1, "wrong state", 0.001),
            (method, "events", np.nan, 1e-10, 1e-10, "ok", 0.004),
            ("DOP853", "modes", np.nan, 1e-9, 1e-8, "ok", 0.005),
            ("DOP853", "modes", np.nan, 1e-13, 1e-8, "ok", 0.05),
        ],
        columns=["method", "treatment", "step", "tolerance", "trajectory_error", "outcome", "seconds"],
    )
    runs["evaluations"] = [10.0, 2e6, 200.0, 40.0, 50.0, 500.0]
    runs["state_error"] = [1e-12, 1e-3, 1e-1, 1e-10, 1e-9, 2e-13]
    runs.attrs["duration"] = 0.5
    scenes = {f"{scene}{kind}": runs for scene in work_precision.NAMES for kind in ("", "_times")}
    figure = work_precision.plot(**scenes)
    for axes in figure.subfigs[0].axes:
        assert [text.get_text() for text in axes.texts if "×" in text.get_text()] == ["300×", "40×"]
    found = numbers(**scenes)
    assert [found["method_name"](rival.method) for *_, rival in found["comparisons"]] == [name] * 3
    assert found["difference"] == 2e-13
