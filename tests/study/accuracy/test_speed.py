"""Factors between methods at equal error."""

import pandas as pd
import pytest

from conveyor_pipeline.study.accuracy import speed

RUNS = pd.DataFrame(
    [
        ("event", speed.OWN, float("nan"), 1e-4, 0.1),
        ("event", speed.OWN, float("nan"), 1e-12, 0.2),
        ("euler", "fixed step", 5e-7, 1e-3, 30.0),
        ("fast", "modes", float("nan"), 1e-10, 4.0),
        ("slow", "modes", float("nan"), 1e-11, 40.0),
    ],
    columns=["method", "treatment", "step", "trajectory_error", "milliseconds"],
)


def test_methods_are_compared_at_an_error_that_both_reach():
    paper, rival = speed.factors(RUNS)
    assert (paper.method, paper.ratio) == ("euler", pytest.approx(300.0))
    assert (rival.method, rival.ratio) == ("fast", pytest.approx(20.0))


def test_there_is_no_factor_if_no_run_reaches_the_error():
    assert [one.method for one in speed.factors(RUNS, 1e-15)] == ["euler"]


def test_failures_are_not_compared():
    work = RUNS.assign(outcome=["ok", "ok", "ok", "wrong state", "ok"]).drop(columns="milliseconds")
    runs = speed.successful_runs(work, pd.DataFrame({"seconds": RUNS.milliseconds / 1e3}))
    assert speed.factors(runs)[1].method == "slow"
