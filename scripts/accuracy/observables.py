"""What figures show of the tables they draw, and where a reader can tell two tables of the same points apart."""

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor.solver.model import Conveyor
from dimensions import portraits
from motion import critical_heights, impacts, signals, spectra
from orbits import estimates, exponents, strobes
from pipeline import grid
from sweeps import shards


class Shown(NamedTuple):
    """What a figure shows of a table of a section of the config."""

    observe: Callable[[dict], pd.DataFrame]  # the table, from the settings of its entry
    keys: tuple[str, ...]  # columns that tell its rows apart, beside the axes
    drawn: tuple[str, ...]  # columns that a figure draws
    what: str  # in words
    vertical: bool = False  # whether the vertical motion is enough
    settled: bool = False  # whether it is of the motion that a start ends in, not of the way there
    motion: tuple[str, ...] = ()  # columns beside the axes that tell motions apart which are known as a whole
    each: bool = False  # whether every motion has a panel, and so a range of values, of its own


def swept(settings: dict) -> pd.DataFrame:
    """A table of sweeps."""
    return pd.DataFrame(shards.columns(settings))


def heights_of_change(settings: dict) -> pd.DataFrame:
    """The critical ones in a table of heights at which the state changes."""
    found = pd.DataFrame(critical_heights.make(settings))
    return found[found.is_critical]


def sorted_strobes(settings: dict) -> pd.DataFrame:
    """A table of strobes; those of an amplitude in the order of their size, as a diagram shows them."""
    found = pd.DataFrame(strobes.make(settings | settings["axes"]))
    return found.assign(v=found.groupby(["branch", "acceleration"]).v.transform(lambda v: np.sort(v.to_numpy())))


def own_exponents(settings: dict) -> pd.DataFrame:
    """A table of Lyapunov exponents, on attractors of its own."""
    found = pd.DataFrame(strobes.make(settings | settings["axes"]))
    return pd.DataFrame(exponents.make(found, settings))


def made_by(stage: Callable[[dict], Mapping[str, np.ndarray]]) -> Callable[[dict], pd.DataFrame]:
    """The table that a stage of the pipeline makes from the settings of an entry."""
    return lambda settings: pd.DataFrame(stage(settings))


SHOWN = {
    "sweeps": Shown(swept, (), ("mean_velocity", "state"), "mean velocity, state"),
    "signals": Shown(
        made_by(signals.make),
        ("time",),
        ("x", "vx", "z", "vz", "contact_force", "friction_force"),
        "samples",
        each=True,
    ),
    "spectra": Shown(
        made_by(spectra.make), ("signal", "frequency"), ("amplitude",), "spectrum", settled=True, each=True
    ),
    "estimates": Shown(made_by(estimates.make), (), ("lambda",), "exponent"),
    "critical": Shown(heights_of_change, (), ("z0",), "critical height", vertical=True, settled=True),
    "impacts": Shown(
        made_by(impacts.make),
        (),
        ("impact_velocity", "impact_phase", "state"),
        "first impact, state",
        vertical=True,
    ),
    "dimensions": Shown(made_by(portraits.make), (), ("dimension",), "dimension", vertical=True, settled=True),
    "attractors": Shown(
        sorted_strobes, ("branch", "cycle"), ("v",), "strobes", vertical=True, settled=True, motion=("branch",)
    ),
    "lyapunov": Shown(own_exponents, ("branch",), ("lambda_1",), "exponent", vertical=True, settled=True),
}


def thinned(axes: dict, points: int) -> dict:
    """Axes with evenly chosen values, about `points` of their product, ends included; axes of text stay whole."""
    values = {
        name: list(axis)
        if name == "tension" or "conveyor" in axis
        else [float(x) for x in grid.axis_values(name, axis)]
        for name, axis in axes.items()
    }
    room = points / len(values.get("tension", "1"))
    numbers = sorted((name for name in values if name != "tension"), key=lambda name: len(values[name]))
    for left, name in zip(range(len(numbers), 0, -1), numbers, strict=True):
        length = len(values[name])
        count = min(length, max(2, math.ceil(room ** (1.0 / left))))
        values[name] = [values[name][k] for k in np.unique(np.linspace(0, length - 1, count).astype(int))]
        room = max(1.0, room / count)
    return values


def observe_shifted(shown: Shown, settings: dict, shifts: list[float]) -> list[pd.DataFrame]:
    """The tables of parts that start higher by each of `shifts` (m); on the conveyor, faster by as much in a radian.

    If there is an axis of what is moved, all are observed at once: they share what is found of their conveyors.
    """
    axes, model = settings["axes"], settings["model"]
    name, unit = "z0", 1.0
    if "z0" not in axes and model["z0"] == "conveyor":
        name, unit = "vz0", 2.0 * math.pi * model.get("frequency", Conveyor().frequency)
    if name not in axes:
        return [shown.observe(settings | {"model": model | {name: model[name] + unit * shift}}) for shift in shifts]
    moved = [{value + unit * shift: value for value in axes[name]} for shift in shifts]
    table = shown.observe(settings | {"axes": axes | {name: [value for one in moved for value in one]}})
    return [table[table[name].isin(one)].assign(**{name: table[name].map(one)}) for one in moved]


def differences(shown: Shown, truth: pd.DataFrame, found: pd.DataFrame, axes: dict, line: float) -> pd.DataFrame:
    """Which of the drawn values of two tables a reader can tell apart; rows as in `truth`, a column for each drawn one.

    Numbers that differ by more than `line`, a share of their range, and all texts that differ; what only one of the
    tables has differs. A column that was not computed (no value at all in `found`) does not count.
    """
    keys = [*axes, *shown.keys]
    both = truth.set_index(keys)[list(shown.drawn)].join(
        found.set_index(keys)[list(shown.drawn)].add_suffix(" found"), how="left"
    )
    seen = {}
    for name in shown.drawn:
        here, there = both[name], both[f"{name} found"]
        if not pd.api.types.is_numeric_dtype(here):
            seen[name] = here.ne(there) & ~(here.isna() & there.isna())
        elif found[name].notna().any():
            groups = here.groupby(level=list(axes)) if shown.each else here.groupby(lambda _: 0)
            extent = groups.transform("max") - groups.transform("min")
            alike = (here.sub(there).abs() <= line * extent) | (here.isna() & there.isna())
            seen[name] = ~alike
        else:
            seen[name] = pd.Series(False, index=both.index)
    return pd.DataFrame(seen)


def known_values(
    shown: Shown, truth: pd.DataFrame, others: list[pd.DataFrame], axes: dict, line: float
) -> pd.DataFrame:
    """Which of the drawn values a reader cannot tell from those of the `others`; rows and columns as `differences`.

    Samples behind one that differs differ, and so do all strobes of a motion with one that does: if two chaotic motions
    look alike at a moment, it is by chance.
    """
    differ = sum(differences(shown, truth, other, axes, line).astype(int) for other in others) > 0
    if shown.each and "time" in shown.keys:
        differ = differ.groupby(level=list(axes)).cummax()
    if shown.motion:
        differ = differ.groupby(level=[*axes, *shown.motion]).transform("max")
    return ~differ
