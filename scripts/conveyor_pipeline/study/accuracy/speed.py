"""Ratios of processor times between methods at equal error of the trajectory."""

from typing import NamedTuple

import numpy as np
import pandas as pd

PAPER_STEP = 5e-7  # s (Sect. 3)
EQUAL_ERROR = 1e-9  # of the trajectory, at which the fastest methods are compared, in units of the plate's motion
OWN = "exact, nothing repeated"  # the solver with every step computed


class Factor(NamedTuple):
    """Comparison of the solver with another run at an error that neither exceeds."""

    method: str
    error: float
    milliseconds: float  # of the other run
    own_milliseconds: float
    evaluations: float  # of the other run over those of the solver

    @property
    def ratio(self) -> float:
        return self.milliseconds / self.own_milliseconds


def successful_runs(work: pd.DataFrame, times: pd.DataFrame) -> pd.DataFrame:
    """Runs that end in the right state, with their processor times in `milliseconds`."""
    return work.assign(milliseconds=1e3 * times.seconds)[work.outcome == "ok"]


def fastest(runs: pd.DataFrame, error: float) -> pd.Series | None:
    """The fastest run whose error is at most `error`; None if there is none."""
    good = runs[runs.trajectory_error <= error]
    return None if good.empty else good.loc[good.milliseconds.idxmin()]


def paper_run(runs: pd.DataFrame) -> pd.Series:
    """The run of the paper's method with its step."""
    return runs[(runs.method == "euler") & np.isclose(runs.step, PAPER_STEP)].iloc[0]


def independent_run(work: pd.DataFrame) -> pd.Series:
    """The run of SciPy's DOP853 with modes at its tightest tolerance, which does not use the solver."""
    runs = work[(work.method == "DOP853") & (work.treatment == "modes")]
    return runs.loc[runs.tolerance.idxmin()]


def at_default(scene: str, work: pd.DataFrame, times: pd.DataFrame) -> dict:
    """The solver at its default tolerance, compared with the paper's run in a scene; errors of the mean velocity."""
    timed = work.assign(milliseconds=1e3 * times.seconds)
    default = timed[(timed.method == "event") & (timed.tolerance == work.attrs["default"])]
    solver, without = (default[default.treatment == name].iloc[0] for name in ("exact", OWN))
    paper = paper_run(timed)
    return {
        "scene": scene,
        "acceleration": work.attrs["model"]["acceleration"],
        "z0": work.attrs["model"]["z0"],
        "duration": work.attrs["duration"],
        "tolerance": solver.tolerance,
        "evaluations": solver.evaluations,
        "repeated_evaluations": solver.repeated_evaluations,
        "milliseconds": solver.milliseconds,
        "paper_milliseconds": paper.milliseconds,
        "error": solver.velocity_error,
        "paper_error": paper.velocity_error,
        "speed": paper.milliseconds / solver.milliseconds,
        "speed_without": paper.milliseconds / without.milliseconds,
    }


def compare(runs: pd.DataFrame, other_run: pd.Series | None, error: float) -> Factor | None:
    """The fastest run of the solver whose error is at most `error`, compared with another run; None without one."""
    solver = fastest(runs[runs.treatment == OWN], error)
    if solver is None or other_run is None:
        return None
    evaluations = other_run.evaluations / solver.evaluations
    return Factor(other_run.method, error, other_run.milliseconds, solver.milliseconds, evaluations)


def factors(runs: pd.DataFrame, equal_error: float = EQUAL_ERROR) -> list[Factor]:
    """The solver compared with the paper's run at its error, and with the fastest other method at `equal_error`.

    A comparison is left out if no run reaches its error.
    """
    paper = paper_run(runs)
    compared = [
        compare(runs, paper, paper.trajectory_error),
        compare(runs, fastest(runs[runs.method != "event"], equal_error), equal_error),
    ]
    return [factor for factor in compared if factor]


def fastest_fixed_steps(runs: pd.DataFrame) -> Factor:
    """The solver compared with the fastest run with fixed steps whose error is at most that of the paper's run."""
    error = paper_run(runs).trajectory_error
    return compare(runs, fastest(runs[runs.treatment == "fixed step"], error), error)
