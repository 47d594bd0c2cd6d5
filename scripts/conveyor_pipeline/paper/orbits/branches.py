"""Branches of periodic orbits over the amplitude, their bifurcations, and the doubling cascade."""

from collections.abc import Iterable

import numpy as np

from conveyor import (
    Bifurcation,
    Branch,
    Orbit,
    accumulation_point,
    doubling_cascade,
    doubling_ratios,
    find_doubled_orbit,
)
from conveyor.analysis.attractors.labels import LONG_FLIGHT
from conveyor.analysis.bifurcations.continuation import follow_branch, on_branch
from conveyor.analysis.bifurcations.periodic_orbits import ReturnMap
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.paper.orbits.limits import MOST_ORBITS
from conveyor_pipeline.paper.orbits.seeds import seeds

TABLES = {
    "branches": (
        fields.count("branch", "number of the branch"),
        fields.count("point", "number of the orbit along its branch"),
        fields.count("cycle", "excitation cycle within the period; delta and v are the state at its end"),
        fields.flag("stable", "whether both multipliers are inside the unit circle"),
        *fields.ORBIT,
    ),
    "folds_and_doublings": (
        fields.text("kind", "fold, period_doubling or grazing"),
        *fields.ORBIT[:2],
        fields.number("multiplier", "1", "the multiplier at +1 or -1; real part of the larger one for a grazing"),
        *fields.ORBIT[2:],
        fields.count("branch", "number of the branch"),
    ),
    "cascade": (
        fields.count("number", "number of the doubling"),
        *fields.ORBIT,
        fields.number("multiplier", "1", "the multiplier at -1"),
        fields.number("ratio", "1", "distance to the previous doubling over distance to the next (Feigenbaum: 4.669…)"),
        fields.number("accumulation", "m/s²", "accumulation point of the doublings so far, by Aitken's process"),
    ),
}


def describe(orbit: Orbit) -> dict[str, float]:
    """The columns that rows of orbits and of bifurcations share."""
    first, second = orbit.multipliers
    return {
        "period": orbit.period,
        "acceleration": orbit.acceleration,
        "delta": orbit.state[0],
        "v": orbit.state[1],
        "multiplier_1_real": first.real,
        "multiplier_1_imag": first.imag,
        "multiplier_2_real": second.real,
        "multiplier_2_imag": second.imag,
        "determinant": orbit.determinant,
        "contact_time": orbit.contact_time,
        "impacts": orbit.impacts,
        "longest_flight": orbit.longest_flight,
    }


def branch_rows(parameters: np.ndarray, branches: list[Branch]) -> list[dict]:
    """The rows of the table of branches, one for each cycle of each orbit."""
    rows = []
    for number, branch in enumerate(branches):
        returns = ReturnMap(parameters, branch.orbits[0].period)
        for point, orbit in enumerate(branch.orbits):
            unknowns = returns.strobes(returns.unknown(orbit))
            for cycle, unknown in enumerate(unknowns, start=1):
                delta, v = returns.state(unknown)
                place = {"branch": number, "point": point, "cycle": cycle, "stable": orbit.stable}
                rows.append({**describe(orbit), **place, "delta": delta, "v": v})
    return rows


def bifurcation_rows(branches: list[Branch]) -> list[dict]:
    """The rows of the table of bifurcations.

    A closed branch passes the bifurcations around its first orbit twice; they have one row.
    """
    rows = []
    for number, branch in enumerate(branches):
        seen = set()
        for bifurcation in branch.bifurcations:
            key = bifurcation.kind, round(bifurcation.orbit.acceleration, 7)
            if key not in seen:
                seen.add(key)
                about = {"kind": bifurcation.kind, "multiplier": bifurcation.multiplier, "branch": number}
                rows.append({**describe(bifurcation.orbit), **about})
    return rows


def explore_bifurcations(
    seeds: Iterable[Orbit], limits: tuple[float, float], max_period: int, most_orbits: int
) -> list[Branch]:
    """All branches in the amplitude that are connected with the seeds through period doublings, each once.

    Parameters
    ----------
    seeds : orbits to begin with, of conveyors that differ in the amplitude alone
    limits : lowest and highest â, m/s²
    max_period : longest period, excitation cycles
    most_orbits : number of orbits, after which no further branch is followed
    """
    branches: list[Branch] = []
    waiting = list(seeds)
    while waiting and sum(len(branch.orbits) for branch in branches) < most_orbits:
        orbit = waiting.pop(0)
        if any(on_branch(branch, orbit) for branch in branches):
            continue
        branch = follow_branch(orbit, "acceleration", limits)
        branches.append(branch)
        if branch.parent is not None:
            waiting.append(branch.parent)
        if 2 * orbit.period <= max_period:
            doublings = [b for b in branch.bifurcations if b.kind == "period_doubling"]
            waiting += [doubled for b in doublings if (doubled := find_doubled_orbit(b)) is not None]
    return branches


def explore_branches(orbits: list[Orbit], settings: dict) -> list[Branch]:
    """All branches that are connected with some orbits, each once.

    Orbits from a search are explored in the order of their periods. An orbit on a doubled branch then lies on a branch
    that is already known. In another order, its branch would be found twice, because close to a period doubling both
    copies cannot be recognised as one.
    """
    options = tuple(settings["limits"]), settings["max_period"]
    if settings["seeds"]:
        return explore_bifurcations(orbits, *options, MOST_ORBITS)
    branches = []
    for period in sorted({orbit.period for orbit in orbits}):
        unexplored = [
            orbit
            for orbit in orbits
            if orbit.period == period and not any(on_branch(branch, orbit) for branch in branches)
        ]
        remaining = MOST_ORBITS - sum(len(branch.orbits) for branch in branches)
        branches += explore_bifurcations(unexplored, *options, remaining)
    return branches


def is_doubling(bifurcation: Bifurcation) -> bool:
    return bifurcation.kind == "period_doubling"


def first_doublings(branches: list[Branch], jumping: Orbit) -> list[Bifurcation]:
    """The first two period doublings of the orbit `jumping` with growing amplitude.

    Raises
    ------
    JobError
        if the branches do not reach them
    """
    begin = jumping.acceleration
    jumps = [branch for branch in branches if on_branch(branch, jumping)]
    first = next(
        (b for branch in jumps for b in branch.bifurcations if is_doubling(b) and b.orbit.acceleration > begin), None
    )
    if first is None:
        end = max((orbit.acceleration for branch in jumps for orbit in branch.orbits), default=begin)
        raise JobError(
            f"the jumping orbit at {begin:g} m/s² (the last of orbits.seeds) does not double its period up to "
            f"{end:g} m/s²; raise the upper value of orbits.limits beyond its first period doubling"
        )
    if (double := find_doubled_orbit(first)) is None:
        raise JobError(
            f"no orbit of twice the period was found at the doubling at {first.orbit.acceleration:g} m/s²; choose "
            "another orbit as the last of orbits.seeds"
        )
    span = (first.orbit.acceleration - 1.0, first.orbit.acceleration + 20.0)
    following = follow_branch(double, "acceleration", span)
    second = min(filter(is_doubling, following.bifurcations), key=lambda b: b.orbit.acceleration, default=None)
    if second is None:
        raise JobError(
            f"the orbit that doubles its period at {first.orbit.acceleration:g} m/s² does not double it again below "
            f"{span[1]:g} m/s², so that there is no cascade; choose another orbit as the last of orbits.seeds"
        )
    return [first, second]


def find_cascade(branches: list[Branch], orbits: list[Orbit], settings: dict) -> list[Bifurcation]:
    """The doubling cascade of the config's last seed or of the first jumping orbit; an empty list if there is none."""
    if settings["seeds"]:
        return doubling_cascade(*first_doublings(branches, orbits[-1]))
    jumps = [orbit for orbit in orbits if orbit.longest_flight >= LONG_FLIGHT]
    for orbit in sorted(jumps, key=lambda orbit: (orbit.period, orbit.acceleration)):
        try:
            doublings = first_doublings(branches, orbit)
        except JobError:
            continue
        return doubling_cascade(*doublings)
    return []


def cascade_rows(cascade: list[Bifurcation]) -> list[dict]:
    """The rows of the table of the cascade."""
    if not cascade:
        return []
    amplitudes = np.array([b.orbit.acceleration for b in cascade])
    ratios = [np.nan, *doubling_ratios(amplitudes), np.nan]
    rows = []
    for n, (bifurcation, ratio) in enumerate(zip(cascade, ratios, strict=True), start=1):
        limit, _ = accumulation_point(amplitudes[:n])
        about = {"number": n, "multiplier": bifurcation.multiplier, "ratio": ratio}
        rows.append({**describe(bifurcation.orbit), **about, "accumulation": limit})
    return rows


def make(settings: dict) -> dict[str, dict[str, np.ndarray]]:
    """The columns of the three tables, by their kinds, for the section `orbits` of the config."""
    parameters = grid.row_of(settings["model"])
    orbits = seeds(parameters, settings)
    branches = explore_branches(orbits, settings)
    cascade = find_cascade(branches, orbits, settings)
    rows = {
        "branches": branch_rows(parameters, branches),
        "folds_and_doublings": bifurcation_rows(branches),
        "cascade": cascade_rows(cascade),
    }
    return {kind: fields.columns(rows_of_kind, TABLES[kind]) for kind, rows_of_kind in rows.items()}
