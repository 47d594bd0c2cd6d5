"""Factors between methods at equal error."""

import pandas as pd
import pytest

from conveyor_pipeline.study.accuracy import speed

RUNS = pd.DataFrame(
    [
        ("event", speed.OWN, float("nan"), 1e-4, 0.1, 10),
        ("event", speed.OWN, float("nan"), 1e-12, 0.2, 20),
        ("euler", "fixed step", 5e-7, 1e-3, 30.0, 1000),
        ("semi_implicit_euler", "fixed step", 1e-5, 5e-4, 1.0, 50),
        ("rk4", "fixed step", 1e-4, 2e-3, 0.5, 40),
        ("fast", "modes", float("nan"), 1e-10, 4.0, 60),
        ("slow", "modes", float("nan"), 1e-11, 40.0, 80),
    ],
    columns=["method", "treatment", "step", "trajectory_error", "milliseconds", "evaluations"],
)


def test_methods_are_compared_at_an_error_that_both_reach():
    paper, rival = speed.factors(RUNS)
    assert (paper.method, paper.ratio) == ("euler", pytest.approx(300.0))
    assert (rival.method, rival.ratio, rival.evaluations) == ("fast", pytest.approx(20.0), 3.0)


def test_fixed_steps_are_compared_at_the_error_of_the_paper_s_run():
    """Runge and Kutta's method is faster, but not as accurate as the paper's run."""
    fixed = speed.fastest_fixed_steps(RUNS)
    assert (fixed.method, fixed.ratio) == ("semi_implicit_euler", pytest.approx(10.0))


def test_there_is_no_factor_if_no_run_reaches_the_error():
    assert [one.method for one in speed.factors(RUNS, 1e-15)] == ["euler"]


def test_failures_are_not_compared():
    work = RUNS.assign(outcome=["ok"] * 5 + ["wrong state", "ok"]).drop(columns="milliseconds")
    runs = speed.successful_runs(work, pd.DataFrame({"seconds": RUNS.milliseconds / 1e3}))
    assert speed.factors(runs)[1].method == "slow"
