"""Findings from the tables of the stage: confidence intervals, accepted frictions, and convergence of the search."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from identification.search_space import PARAMETERS

UP_ALONE, DOWN_ALONE = "C01.critical_amplitude", "C02.upper_end"
VELOCITIES = {
    "first_low": "C05.velocity_at_lower_end",
    "first_high": "C05.velocity_at_upper_end",
    "fall": "C06.fall",
}


# A table of edges with fewer contacts is coarse.
ENOUGH_CONTACTS = 49


def is_coarse(settings: dict) -> bool:
    """Whether the settings are too coarse for conclusions about the parameters, as in a reduced config."""
    return settings["contacts"]["loss"] * settings["contacts"]["stiffness"] < ENOUGH_CONTACTS


def lowest_profile(profiles: pd.DataFrame, evidence: str, parameter: str) -> pd.DataFrame:
    """The rows with the least total for each value of a parameter over all tension modes, in ascending order."""
    rows = profiles[(profiles.evidence == evidence) & (profiles.parameter == parameter)]
    return rows.loc[rows.groupby(parameter).total.idxmin()].reset_index(drop=True)


class End(NamedTuple):
    """An end of an interval; `held` says whether another parameter is at a bound of the search there."""

    value: float
    held: bool


def find_ends(x: np.ndarray, total: np.ndarray, at_bound: np.ndarray, level: float) -> tuple[End | None, End | None]:
    """The outermost values at which a profile crosses a level, by linear interpolation.

    An end is None if the profile is below the level up to its last value.

    Parameters
    ----------
    x, total, at_bound : ascending values, their totals, and whether another parameter is at a bound, shape (n,)
    level : of the total

    Raises
    ------
    ValueError
        if the whole profile lies above the level
    """
    inside = np.flatnonzero(total <= level)
    if not len(inside):
        raise ValueError("the whole profile lies above the level")

    def end(inner: int, outer: int) -> End | None:
        if not 0 <= outer < len(x):
            return None
        share = (level - total[inner]) / (total[outer] - total[inner])
        return End(float(x[inner] + share * (x[outer] - x[inner])), bool(at_bound[inner] or at_bound[outer]))

    return end(inside[0], inside[0] - 1), end(inside[-1], inside[-1] + 1)


def intervals(profiles: pd.DataFrame, optima: pd.DataFrame, evidence: str) -> dict[str, tuple[End | None, End | None]]:
    """The ends of the confidence interval of each parameter."""
    fits = optima[optima.evidence == evidence]
    level = fits.total.min() + fits.rise.iloc[0]
    best = fits.loc[[fits.total.idxmin()]]
    found = {}
    for name in PARAMETERS:
        rows = lowest_profile(profiles, evidence, name)
        rows = pd.concat([rows, best[[name, "total", "status"]]]).sort_values(name)
        found[name] = find_ends(
            rows[name].to_numpy(), rows.total.to_numpy(), (rows.status == "at a bound").to_numpy(), level
        )
    return found


def accepted_frictions(frictions: pd.DataFrame, numbers: dict[str, dict]) -> dict[str, tuple[float, float] | None]:
    """The range of friction in which each velocity, and `all` of them, lie in their accepted intervals.

    The other parameters are as printed. All three velocities rise with friction. If one does not reach its interval,
    both ends are the same end of the frictions. `all` is None if no friction gives all three.
    """
    ranges = {
        column: tuple(np.interp([numbers[name]["low"], numbers[name]["high"]], frictions[column], frictions.friction))
        for column, name in VELOCITIES.items()
    }
    low, high = max(low for low, _ in ranges.values()), min(high for _, high in ranges.values())
    return ranges | {"all": (low, high) if low <= high else None}


def contradiction(numbers: dict[str, dict]) -> float:
    """The factor by which the intervals of C01 and of the upper end of C02 must be widened until they overlap.

    In the model, both are one quantity: the amplitude up to which the initial height z0 = 0 leads to the first state.
    """
    one, other = numbers[UP_ALONE], numbers[DOWN_ALONE]
    between = abs(one["low"] + one["high"] - other["low"] - other["high"])
    return between / (one["high"] - one["low"] + other["high"] - other["low"])


def summarize_search(front: pd.DataFrame, generations: pd.DataFrame) -> list[dict]:
    """For each tension mode: whether its searches have converged, and the range of their final hypervolumes."""
    last = generations[generations.generation == generations.generation.max()]
    ends = last.groupby("tension", sort=False).hypervolume.agg(["min", "max"])
    return ends.assign(status=front.groupby("tension").status.first()).reset_index().to_dict("records")
