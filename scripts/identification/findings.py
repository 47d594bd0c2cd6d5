"""What the tables of the stage say: intervals, and friction alone."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from identification.misfits import number, smallest_widening
from identification.search_space import PARAMETERS

UP_ALONE, DOWN_ALONE = "C01.critical_amplitude", "C02.upper_end"
VELOCITIES = {
    "first_low": "C05.velocity_at_lower_end",
    "first_high": "C05.velocity_at_upper_end",
    "fall": "C06.fall",
}


# Fewer contacts than these are a coarse table of edges.
ENOUGH_CONTACTS = 49


def coarse(asked: dict) -> bool:
    """Whether what was made with these settings shows no more than that it can be made."""
    return asked["contacts"]["loss"] * asked["contacts"]["stiffness"] < ENOUGH_CONTACTS


def lowest_profile(profiles: pd.DataFrame, evidence: str, parameter: str) -> pd.DataFrame:
    """The rows with the least total for each value of a parameter, under whichever reading, ascending in the value."""
    rows = profiles[(profiles.evidence == evidence) & (profiles.parameter == parameter)]
    return rows.loc[rows.groupby(parameter).total.idxmin()].reset_index(drop=True)


class End(NamedTuple):
    """An end of an interval; `held` tells that another parameter has come to the end of what is searched there."""

    value: float
    held: bool


def ends(x: np.ndarray, total: np.ndarray, at_bound: np.ndarray, level: float) -> tuple[End | None, End | None]:
    """Outermost values at which a profile passes a level, by straight lines; None where it is below at that end.

    Parameters
    ----------
    x, total, at_bound : values, ascending, their totals, and whether another parameter is at a bound, shape (n,)
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
    """For each parameter the ends of its interval of confidence."""
    of_set = optima[optima.evidence == evidence]
    level = of_set.total.min() + of_set.rise.iloc[0]
    found = {}
    for name in PARAMETERS:
        rows = lowest_profile(profiles, evidence, name)
        best = of_set.loc[[of_set.total.idxmin()]]
        rows = pd.concat([rows, best[[name, "total", "status"]]]).sort_values(name)
        found[name] = ends(
            rows[name].to_numpy(), rows.total.to_numpy(), (rows.status == "at a bound").to_numpy(), level
        )
    return found


def accepted_frictions(frictions: pd.DataFrame, numbers: dict[str, dict]) -> dict[str, tuple[float, float]]:
    """From which to which friction each velocity lies in its accepted interval, all else as printed.

    All three rise with friction; where one does not reach its interval, both ends are that of the frictions.
    """
    return {
        name: tuple(
            float(np.interp(numbers[name][end], frictions[column], frictions.friction)) for end in ("low", "high")
        )
        for column, name in VELOCITIES.items()
    }


def contradiction(numbers: dict[str, dict]) -> float:
    """By which factor the intervals of C01 and of the upper end of C02 must be widened to have a value in common.

    For the model both are one quantity: the amplitude up to which the start z0 = 0 ends in the first state.
    """
    return smallest_widening(number(numbers[UP_ALONE]), number(numbers[DOWN_ALONE]))


def friction_alone(frictions: pd.DataFrame, numbers: dict[str, dict]) -> str:
    """At which frictions the velocities are accepted, all else as printed, in words."""
    each = accepted_frictions(frictions, numbers)
    low, high = max(low for low, _ in each.values()), min(high for _, high in each.values())
    parts = [
        f"{words} from {each[VELOCITIES[column]][0]:.3f} to {each[VELOCITIES[column]][1]:.3f}"
        for column, words in (
            ("first_low", "the lower end is accepted"),
            ("first_high", "the upper end"),
            ("fall", "the fall"),
        )
    ]
    together = f"all three from {low:.3f} to {high:.3f}" if low <= high else "all three at no friction"
    return f"{', '.join(parts)}, {together}"


def search(front: pd.DataFrame, generations: pd.DataFrame) -> str:
    """Whether the searches have converged, in words."""
    last = generations[generations.generation == generations.generation.max()]
    parts = []
    for tension, rows in last.groupby("tension", sort=False):
        share = rows.hypervolume
        state = front[front.tension == tension].status.iloc[0]
        parts.append(f"{tension}: {state}, hypervolume {share.min():.3f} to {share.max():.3f} of the cube by the seeds")
    return "; ".join(parts)
