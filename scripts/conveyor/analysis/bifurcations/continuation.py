"""Branches of periodic orbits in the amplitude â, and the bifurcations on them.

Pseudo-arclength (Keller 1977) follows a branch past its folds. A branch folds where a multiplier passes +1. Its period
doubles where a multiplier passes -1. An impact grazes where a contact begins or ceases to exist; only this is reported
where the multipliers jump past ±1 at a grazing, although the branch may turn there. The product of the multipliers is
positive and at most 1, so that no other bifurcation of a single orbit is generic.
"""

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ... import linear_algebra
from .newton import follow_curve
from .periodic_orbits import Orbit, ReturnMap

SAME_ORBIT = 1e-5  # orbits this close are one, in scaled unknowns
DOUBLED = 0.02  # distance from a period doubling to the orbit of twice the period, in scaled unknowns
# Arclength of the largest, the first and the smallest step along a branch, in scaled unknowns (about m/s² in â).
LARGEST_STEP, FIRST_STEP, SMALLEST_STEP = 0.1, 1e-3, 1e-7
STRAIGHT = 0.95  # cosine of the largest turn of a branch within one step
MAX_ORBITS = 5000
JUMP = 1e-4  # largest value of a test function at its zero, over its change within the step


class Bifurcation(NamedTuple):
    """A point of a branch at which its stability or its impacts change."""

    kind: str  # fold, period_doubling, grazing
    orbit: Orbit
    multiplier: float  # the real multiplier at +1 or -1; for a grazing the one of larger modulus


class Branch(NamedTuple):
    """A branch of periodic orbits in the order of its arclength, its bifurcations, and the reasons of its ends."""

    orbits: list[Orbit]
    bifurcations: list[Bifurcation]
    # At the first and last orbit: limit, closed, period halving, step (none is small enough), length (MAX_ORBITS).
    ends: tuple[str, str]
    parent: Orbit | None  # the orbit of half the period where it ends in one


def fold_test(orbit: Orbit) -> float:
    """(1 - μ1)(1 - μ2), real for complex multipliers too: zero where a multiplier is +1."""
    first, second = orbit.multipliers
    return ((1.0 - first) * (1.0 - second)).real


def doubling_test(orbit: Orbit) -> float:
    """(1 + μ1)(1 + μ2), real for complex multipliers too: zero where a multiplier is -1."""
    first, second = orbit.multipliers
    return ((1.0 + first) * (1.0 + second)).real


def follow_branch(parameters: np.ndarray, orbit: Orbit, limits: tuple[float, float]) -> Branch:
    """Follow the branch of `orbit` in â to both sides (Keller 1977); bifurcations are located to about 1e-9 m/s².

    Parameters
    ----------
    parameters : a row of a table; its amplitude is ignored
    orbit : an orbit within the limits
    limits : lowest and highest â, m/s²

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=40.0), Start(z=3e-4))
    >>> branch = follow_branch(parameter_table(Conveyor()), orbit, (20.0, 60.0))
    >>> [(one.kind, round(one.orbit.acceleration, 3)) for one in branch.bifurcations]  # m/s²
    [('fold', 23.976), ('period_doubling', 54.218)]
    """
    upwards = np.array([0.0, 0.0, 1.0])
    orbits, bifurcations, last, parent = _follow(parameters, orbit, limits, upwards)
    if last == "closed":
        return Branch(orbits, bifurcations, (last, last), None)
    before, bifurcations_before, first, other = _follow(parameters, orbit, limits, -upwards)
    return Branch(
        [*before[:0:-1], *orbits],
        [*reversed(bifurcations_before), *bifurcations],
        (first, last),
        parent if other is None else other,
    )


def _follow(parameters, orbit, limits, direction):
    """Orbits and bifurcations in the order in which they are met, the reason of the end, and the orbit's parent."""
    returns = ReturnMap(parameters, orbit.period)
    here = returns.scaled(orbit.acceleration, orbit.state)
    beginning = returns.strobes(here)
    orbits, bifurcations = [orbit], []
    lengths = {"first": FIRST_STEP, "smallest": SMALLEST_STEP, "largest": LARGEST_STEP}
    steps = follow_curve(returns.correct, returns.tangent, here, direction, **lengths, straight=STRAIGHT)
    for here, there, tangent, _, length in steps:
        if orbit.period % 2 == 0 and linear_algebra.dot(returns.halving(here), returns.halving(there)) < 0.0:
            half = ReturnMap(parameters, orbit.period // 2)
            unknown = half.newton(0.5 * (here + there))
            return orbits, bifurcations, "period halving", None if unknown is None else half.describe(unknown)
        orbits.append(returns.describe(there))
        bifurcations += bifurcations_between(parameters, *orbits[-2:])
        if not limits[0] <= orbits[-1].acceleration <= limits[1]:
            return orbits, bifurcations, "limit", None
        advance = linear_algebra.dot(beginning - here, tangent)
        aside = linear_algebra.length(beginning - here - advance[:, None] * tangent)
        if len(orbits) > 3 and ((advance > 0.0) & (advance <= length) & (aside < 0.1 * length)).any():
            return orbits, bifurcations, "closed", None
        if len(orbits) == MAX_ORBITS:
            return orbits, bifurcations, "length", None
    return orbits, bifurcations, "step", None


def is_orbit(parameters: np.ndarray, orbit: Orbit) -> bool:
    """Whether an Orbit is one of `parameters`, a row of a table; its amplitude is ignored."""
    returns = ReturnMap(parameters, orbit.period)
    given = returns.scaled(orbit.acceleration, orbit.state)
    solved = returns.newton(given)
    return solved is not None and bool(linear_algebra.length(solved - given) < SAME_ORBIT)


def bifurcations_between(parameters: np.ndarray, before: Orbit, after: Orbit) -> list[Bifurcation]:
    """Bifurcations between two neighbouring orbits of a branch, in the order in which they are met."""
    returns = ReturnMap(parameters, before.period)
    begin, end = (returns.scaled(orbit.acceleration, orbit.state) for orbit in (before, after))
    direction = (end - begin) / linear_algebra.length(end - begin)

    def at(part: float) -> Orbit | None:
        unknown = returns.correct(begin + part * (end - begin), direction)
        return None if unknown is None else returns.describe(unknown)

    bifurcations = []
    for kind, test, sign in (("fold", fold_test, 1.0), ("period_doubling", doubling_test, -1.0)):
        if test(before) * test(after) < 0.0 and (part := _zero(at, test)) is not None:
            orbit = at(part)
            if abs(test(orbit)) > JUMP * abs(test(after) - test(before)):
                continue  # the multipliers jump at a grazing
            multiplier = min(orbit.multipliers, key=lambda value, sign=sign: abs(value - sign))
            bifurcations.append((part, Bifurcation(kind, orbit, multiplier.real)))
    if before.impacts != after.impacts:
        part = _zero(at, lambda orbit: 0.5 - (orbit.impacts != before.impacts))
        if part is not None:
            orbit = at(part)
            bifurcations.append((part, Bifurcation("grazing", orbit, orbit.multipliers[0].real)))
    return [bifurcation for _, bifurcation in sorted(bifurcations, key=lambda item: item[0])]


def _zero(at: Callable[[float], Orbit | None], test: Callable[[Orbit], float]) -> float | None:
    """The part (0 … 1) of a step at which a test function of its orbits is zero; None if an orbit is not found."""

    def value(part):
        orbit = at(part)
        if orbit is None:
            raise ArithmeticError("no orbit")
        return test(orbit)

    try:
        return brentq(value, 0.0, 1.0, xtol=1e-12, rtol=1e-12)
    except (ArithmeticError, ValueError):
        return None


def find_doubled_orbit(parameters: np.ndarray, bifurcation: Bifurcation) -> Orbit | None:
    """An orbit of twice the period at the distance DOUBLED from a period doubling, along the eigenvector of -1.

    parameters : a row of a table; its amplitude is ignored
    Returns None where Newton's iteration finds no orbit.

    Examples
    --------
    >>> row = parameter_table(Conveyor())
    >>> branch = follow_branch(row, periodic_orbit(Conveyor(acceleration=40.0), Start(z=3e-4)), (20.0, 60.0))
    >>> doubled = find_doubled_orbit(row, branch.bifurcations[-1])
    >>> doubled.period, doubled.stable
    (2, True)
    """
    orbit = bifurcation.orbit
    single, double = ReturnMap(parameters, orbit.period), ReturnMap(parameters, 2 * orbit.period)
    unknown = single.scaled(orbit.acceleration, orbit.state)
    matrix = single.residual(unknown)[1] + np.eye(2)
    nearest = min(linear_algebra.eigenvalues(matrix), key=lambda value: abs(value + 1.0))
    along = np.append(linear_algebra.eigenvector(matrix, nearest.real), 0.0)
    corrected = double.correct(unknown + DOUBLED * along, along)
    return None if corrected is None else double.describe(corrected)


def on_branch(parameters: np.ndarray, branch: Branch, orbit: Orbit) -> bool:
    """Whether an orbit, at any of its phases, lies on a branch.

    parameters : a row of a table, the conveyor of the branch and the orbit; its amplitude is ignored

    Examples
    --------
    >>> row, start = parameter_table(Conveyor()), Start(z=3e-4)
    >>> branch = follow_branch(row, periodic_orbit(Conveyor(acceleration=40.0), start), (39.0, 41.0))
    >>> on_branch(row, branch, periodic_orbit(Conveyor(acceleration=40.5), start))
    True
    """
    if branch.orbits[0].period != orbit.period:
        return False
    returns = ReturnMap(parameters, orbit.period)
    strobes = returns.strobes(returns.scaled(orbit.acceleration, orbit.state))
    points = np.array([returns.scaled(other.acceleration, other.state) for other in branch.orbits])
    above = points[:, 2] > strobes[0, 2]
    for i in np.flatnonzero(above[1:] != above[:-1]):
        part = (strobes[0, 2] - points[i, 2]) / (points[i + 1, 2] - points[i, 2])
        guess = points[i] + part * (points[i + 1] - points[i])
        if linear_algebra.length(strobes - guess).min() < LARGEST_STEP:
            unknown = returns.newton(guess)
            if unknown is not None and linear_algebra.length(strobes - unknown).min() < SAME_ORBIT:
                return True
    return False


def explore_bifurcations(
    parameters: np.ndarray, seeds: Iterable[Orbit], limits: tuple[float, float], max_period: int, most: int
) -> list[Branch]:
    """All branches that are connected with the seeds through period doublings, each once.

    Parameters
    ----------
    parameters : a row of a table; its amplitude is ignored
    seeds : orbits to begin with
    limits : lowest and highest â, m/s²
    max_period : longest period, excitation cycles
    most : number of orbits, after which no further branch is followed

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=54.0), Start(z=3e-4))
    >>> branches = explore_bifurcations(parameter_table(Conveyor()), [orbit], (53.9, 54.4), max_period=2, most=1000)
    >>> [branch.orbits[0].period for branch in branches]
    [1, 2]
    """
    branches: list[Branch] = []
    waiting = list(seeds)
    while waiting and sum(len(branch.orbits) for branch in branches) < most:
        orbit = waiting.pop(0)
        if any(on_branch(parameters, branch, orbit) for branch in branches):
            continue
        branch = follow_branch(parameters, orbit, limits)
        branches.append(branch)
        if branch.parent is not None:
            waiting.append(branch.parent)
        if 2 * orbit.period <= max_period:
            doublings = [b for b in branch.bifurcations if b.kind == "period_doubling"]
            waiting += [new for b in doublings if (new := find_doubled_orbit(parameters, b)) is not None]
    return branches
