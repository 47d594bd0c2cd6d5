"""Quantities that figures show of each kind of table, and visible differences between two tables of the same points."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor_pipeline.common import grid
from conveyor_pipeline.paper.dimensions import portraits
from conveyor_pipeline.paper.motion import critical, impacts, signals, spectra
from conveyor_pipeline.paper.orbits import estimates, exponents, strobes
from conveyor_pipeline.paper.sweeps import shards

LINE = 0.005  # visible change as a share of the axis range: a line of 0.25 mm on an axis of 50 mm


class Shown(NamedTuple):
    """The part of a kind of table that figures show."""

    make: Callable[[dict], Mapping[str, np.ndarray] | pd.DataFrame]  # from the settings of an entry
    keys: tuple[str, ...]  # columns besides the axes that identify a row
    drawn: tuple[str, ...]  # columns that a figure draws
    what: str  # the drawn columns in words
    vertical: bool = False  # whether the vertical motion is sufficient
    motion: tuple[str, ...] = ()  # columns besides the axes that identify a motion, if all its rows belong together
    per_motion: bool = False  # whether every motion has a panel and a range of values of its own

    def observe(self, settings: dict) -> pd.DataFrame:
        """The table of an entry with these settings."""
        return pd.DataFrame(self.make(settings))


def make_critical_heights(settings: dict) -> pd.DataFrame:
    """The critical heights among the heights at which the state changes."""
    table = pd.DataFrame(critical.make(settings))
    return table[table.is_critical]


def make_strobes(settings: dict) -> pd.DataFrame:
    """A table of strobes, sorted by value at each amplitude, because a diagram does not show their order."""
    table = pd.DataFrame(strobes.make(settings | settings["axes"]))
    return table.assign(v=table.groupby(["branch", "acceleration"]).v.transform(lambda v: np.sort(v.to_numpy())))


def make_exponents(settings: dict) -> pd.DataFrame:
    """A table of Lyapunov exponents on the attractors of the same settings."""
    table = pd.DataFrame(strobes.make(settings | settings["axes"]))
    return pd.DataFrame(exponents.make(table, settings))


SHOWN = {
    "sweeps": Shown(shards.columns, (), ("mean_velocity", "state"), "mean velocity, state"),
    "signals": Shown(
        signals.make, ("time",), ("x", "vx", "z", "vz", "contact_force", "friction_force"), "samples", per_motion=True
    ),
    "spectra": Shown(spectra.make, ("signal", "frequency"), ("amplitude",), "spectrum", per_motion=True),
    "estimates": Shown(estimates.make, (), ("lambda",), "exponent"),
    "critical": Shown(make_critical_heights, (), ("z0",), "critical height", vertical=True),
    "impacts": Shown(
        impacts.make, (), ("impact_velocity", "impact_phase", "state"), "first impact, state", vertical=True
    ),
    "dimensions": Shown(portraits.make, (), ("dimension",), "dimension", vertical=True),
    "attractors": Shown(make_strobes, ("branch", "cycle"), ("v",), "strobes", vertical=True, motion=("branch",)),
    "lyapunov": Shown(make_exponents, ("branch",), ("lambda_1",), "exponent", vertical=True),
}


def thin_axes(axes: dict, points: int) -> dict:
    """Axes with about `points` points in total: evenly chosen values with both ends; axes of texts stay unchanged."""
    values = {
        name: list(axis)
        if name == "tension" or "conveyor" in axis
        else [float(x) for x in grid.axis_values(name, axis)]
        for name, axis in axes.items()
    }
    remaining = points / len(values.get("tension", "1"))
    numbers = sorted((name for name in values if name != "tension"), key=lambda name: len(values[name]))
    for axes_left, name in zip(range(len(numbers), 0, -1), numbers, strict=True):
        length = len(values[name])
        count = min(length, max(2, math.ceil(remaining ** (1.0 / axes_left))))
        values[name] = [values[name][k] for k in np.unique(np.linspace(0, length - 1, count).astype(int))]
        remaining = max(1.0, remaining / count)
    return values


def observe_shifted(shown: Shown, settings: dict, shifts: Sequence[float]) -> list[pd.DataFrame]:
    """The tables with the initial height shifted by each of `shifts` (m).

    If the part starts on the conveyor, its velocity is shifted by ω times as much. If the shifted quantity is an axis,
    all tables come from one call, so that they share the search for attractors.
    """
    axes, model = settings["axes"], settings["model"]
    name, unit = "z0", 1.0
    if "z0" not in axes and model["z0"] == "conveyor":
        name, unit = "vz0", 2.0 * math.pi * model["frequency"]
    if name not in axes:
        return [shown.observe(settings | {"model": model | {name: model[name] + unit * shift}}) for shift in shifts]
    originals = [{value + unit * shift: value for value in axes[name]} for shift in shifts]
    table = shown.observe(settings | {"axes": axes | {name: [value for original in originals for value in original]}})
    return [table[table[name].isin(original)].assign(**{name: table[name].map(original)}) for original in originals]


def visible_differences(shown: Shown, truth: pd.DataFrame, other: pd.DataFrame, axes: dict) -> pd.DataFrame:
    """Whether a reader can see the difference of each drawn value of two tables; rows as in `truth`.

    A reader sees the difference of two numbers if it is more than LINE times their range, the difference of unequal
    texts, and a value that only one table has. A column without any value in `other` was not computed and does not
    count.
    """
    keys = [*axes, *shown.keys]
    joined = truth.set_index(keys)[list(shown.drawn)].join(
        other.set_index(keys)[list(shown.drawn)].add_suffix(" of other"), how="left"
    )
    visible = {}
    for name in shown.drawn:
        expected, actual = joined[name], joined[f"{name} of other"]
        if not pd.api.types.is_numeric_dtype(expected):
            visible[name] = expected.ne(actual) & ~(expected.isna() & actual.isna())
        elif other[name].notna().any():
            groups = expected.groupby(level=list(axes)) if shown.per_motion else expected.groupby(lambda _: 0)
            extent = groups.transform("max") - groups.transform("min")
            visible[name] = ~((expected.sub(actual).abs() <= LINE * extent) | (expected.isna() & actual.isna()))
        else:
            visible[name] = pd.Series(False, index=joined.index)
    return pd.DataFrame(visible)


def robust_values(shown: Shown, truth: pd.DataFrame, others: list[pd.DataFrame], axes: dict) -> pd.DataFrame:
    """Whether each drawn value looks the same in all `others`; rows and columns as in `visible_differences`.

    After the first different sample, all samples of a signal count as different. One different strobe makes all strobes
    of its motion different. The reason is that two chaotic motions may look alike at a moment by chance.
    """
    differ = sum(visible_differences(shown, truth, other, axes).astype(int) for other in others) > 0
    if shown.per_motion and "time" in shown.keys:
        differ = differ.groupby(level=list(axes)).cummax()
    if shown.motion:
        differ = differ.groupby(level=[*axes, *shown.motion]).transform("max")
    return ~differ
