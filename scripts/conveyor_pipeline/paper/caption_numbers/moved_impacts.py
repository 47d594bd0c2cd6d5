"""Numbers of the caption of the figure moved_impacts."""

from typing import Any

import pandas as pd

from conveyor_pipeline.paper.figures.moved_impacts import ACCELERATION


def shortest_sufficient_shift(ends: pd.DataFrame) -> float:
    """The smallest time shift, in time steps, from which on no run by Euler ends with a positive estimate."""
    shifts = ends.time_shift / ends.step
    return shifts[shifts > shifts[ends.difference >= ends.epsilon].max()].min()


def longest_useless_shift(ends: pd.DataFrame) -> float:
    """The largest time shift, in time steps, up to which all runs by Euler end with a positive estimate."""
    shifts = ends.time_shift / ends.step
    return shifts[shifts < shifts[ends.difference < ends.epsilon].min()].max()


def numbers(*, moved: pd.DataFrame) -> dict[str, Any]:
    ends = moved[moved.time == moved.time.max()]
    smallest = ends[ends.epsilon == ends.epsilon.min()]
    by_euler, converged = (smallest[smallest.method == method] for method in ("euler", "event"))
    return {
        "acceleration": f"{ACCELERATION:g}",
        "smallest": f"{ends.epsilon.min():g}",
        "largest": f"{ends.epsilon.max():g}",
        "time_shift": smallest.time_shift.min(),
        "duration": f"{ends.time.max():g}",
        "mean_shift": converged["mean_shift"].mean(),
        "useless": longest_useless_shift(ends[ends.method == "euler"]),
        "helps": shortest_sufficient_shift(ends[ends.method == "euler"]),
        "moved": by_euler.moved.sum(),
        "impacts": by_euler.impacts.sum(),
        "steps": ", ".join(f"{1e6 * step:g}" for step in sorted(by_euler.step.unique())),
    }
