"""Branches of periodic orbits in one parameter, and the bifurcations on them.

Pseudo-arclength (Keller 1977) follows a branch past its folds. A branch folds where a multiplier passes +1. Its period
doubles where a multiplier passes -1. An impact grazes where a contact begins or ceases to exist. With `tension: clip`,
the multipliers jump at a grazing. If they jump past ±1, only the grazing is reported, although the branch may turn
there. The product of the multipliers is positive and at most 1, so that no other bifurcation of a single orbit is
generic.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ... import linear_algebra
from ...arguments import check_choice, check_limits, check_type
from ...columns import Columns
from ...progress import progress_bar
from .bifurcation_points import SIGNS
from .newton import follow_curve
from .periodic_orbits import SAME_ORBIT, Orbit, ReturnMap, check_orbit

# Parameters in which branches are followed: all that act on the motion normal to the track.
CONTINUED = (
    *("acceleration", "angle", "frequency", "stiffness", "damping", "mass", "exponent", "gravity", "inclination"),
)
DOUBLED = 0.02  # distance from a period doubling to the orbit of twice the period, in scaled unknowns
# Arclength of the largest, the first and the smallest step along a branch, in scaled unknowns (m/s² in â).
LARGEST_STEP, FIRST_STEP, SMALLEST_STEP = 0.1, 1e-3, 1e-7
STRAIGHT = 0.95  # cosine of the largest turn of a branch within one step
MAX_ORBITS = 5000
JUMP = 1e-4  # largest value of a test function at its zero, over its change within the step


class Bifurcation(NamedTuple):
    """A point of a branch at which its stability or its impacts change."""

    kind: str  # fold, period_doubling, grazing
    orbit: Orbit
    multiplier: float  # the real multiplier at +1 or -1; for a grazing the one of larger modulus
    parameter: str  # the one that changes along the branch

    def __repr__(self) -> str:
        value = f"{self.parameter} = {self.orbit.value(self.parameter):.6g}"
        return f"Bifurcation({self.kind} at {value}, period {self.orbit.period})"


class Branch(NamedTuple):
    """A branch of periodic orbits in the order of its arclength, its bifurcations, and the reasons of its ends."""

    orbits: list[Orbit]
    bifurcations: list[Bifurcation]
    # At the first and last orbit: limit, closed, period halving, step (none is small enough), length (MAX_ORBITS).
    ends: tuple[str, str]
    parent: Orbit | None  # the orbit of half the period where it ends in one
    parameter: str  # the one that changes along the branch

    @property
    def columns(self) -> Columns:
        """Columns of the shape (n,), one row for each orbit, with its value of the parameter."""
        orbits = self.orbits
        moduli = np.abs([orbit.multipliers for orbit in orbits])
        about = {name: np.array([getattr(orbit, name) for orbit in orbits]) for name in ("stable", "impacts")}
        state = np.array([orbit.state for orbit in orbits])
        return Columns(
            {self.parameter: np.array([orbit.value(self.parameter) for orbit in orbits])}
            | {"delta": state[:, 0], "v": state[:, 1], **about, "multiplier": moduli[:, 0]}
            | {"longest_flight": np.array([orbit.longest_flight for orbit in orbits])}
        )

    def __repr__(self) -> str:
        ends = " to ".join(f"{orbit.value(self.parameter):.6g}" for orbit in (self.orbits[0], self.orbits[-1]))
        found = ", ".join(f"{one.kind} at {one.orbit.value(self.parameter):.6g}" for one in self.bifurcations)
        early = "" if self.ends == ("limit", "limit") else f"; ends: {' and '.join(self.ends)}"
        return f"Branch({len(self.orbits)} orbits, {self.parameter} {ends}; {found or 'no bifurcations'}{early})"


def multiplier_test(orbit: Orbit, sign: float) -> float:
    """(1 ∓ μ1)(1 ∓ μ2), real for complex multipliers too: zero where a multiplier is the sign, ±1."""
    first, second = orbit.multipliers
    return ((1.0 - sign * first) * (1.0 - sign * second)).real


def continue_orbit(orbit: Orbit, parameter: str, limits: Sequence[float], *, progress: str | None = None) -> Branch:
    """The branch of an orbit in one parameter, with its folds, period doublings and grazings.

    Parameters
    ----------
    orbit : from `periodic_orbit`
    parameter : acceleration, angle, frequency, stiffness, damping, mass, exponent, gravity or inclination
    limits : values in SI units between which the branch is followed, on either side of the orbit's value; a branch that
        reaches one of them ends at most one step before it
    progress : as in `sweep`; the bar counts orbits, whose number is not known before

    Returns
    -------
    Branch, with folds, period doublings and grazings located to about 1e-9 m/s²; in another parameter, to a share of
    2.5e-11 of the orbit's own value (of 1 rad for an inclination). Steps are shares of this value, too.

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=50.0), Start(z=3e-4))
    >>> continue_orbit(orbit, "acceleration", (49.5, 54.5)).bifurcations
    [Bifurcation(period_doubling at acceleration = 54.2182, period 1)]
    >>> [one.kind for one in continue_orbit(orbit, "damping", (0.15, 0.32)).bifurcations]
    ['period_doubling']
    """
    check_orbit(orbit)
    check_choice("parameter", parameter, CONTINUED)
    low, high = check_limits(limits, parameter, orbit.value(parameter))
    branch = follow_branch(orbit, parameter, (low, high), progress=progress)
    return branch._replace(
        orbits=[one for one in branch.orbits if low <= one.value(parameter) <= high],
        bifurcations=[one for one in branch.bifurcations if low <= one.orbit.value(parameter) <= high],
    )


def follow_branch(orbit: Orbit, parameter: str, limits: tuple[float, float], *, progress: str | None = None) -> Branch:
    """Follow the branch of `orbit` to both sides (Keller 1977), up to the first orbit beyond each of the limits."""
    upwards = np.array([0.0, 0.0, 1.0])
    with progress_bar(label=progress, unit="orbits") as shown:
        orbits, bifurcations, last, parent = _follow(orbit, parameter, limits, upwards, shown)
        if last == "closed":
            return Branch(orbits, bifurcations, (last, last), None, parameter)
        before, bifurcations_before, first, other = _follow(orbit, parameter, limits, -upwards, shown)
    return Branch(
        [*before[:0:-1], *orbits],
        [*reversed(bifurcations_before), *bifurcations],
        (first, last),
        parent if other is None else other,
        parameter,
    )


def _follow(orbit, parameter, limits, direction, shown):
    """Orbits and bifurcations in the order in which they are met, the reason of the end, and the orbit's parent."""
    returns = ReturnMap(orbit.parameters, orbit.period, parameter)
    current = returns.unknown(orbit)
    first_strobes = returns.strobes(current)
    orbits, bifurcations = [orbit], []
    lengths = {"first": FIRST_STEP, "smallest": SMALLEST_STEP, "largest": LARGEST_STEP}
    steps = follow_curve(returns.correct, returns.tangent, current, direction, **lengths, straight=STRAIGHT)
    for current, following, tangent, _, length in steps:
        if orbit.period % 2 == 0 and linear_algebra.dot(returns.halving(current), returns.halving(following)) < 0.0:
            half = ReturnMap(orbit.parameters, orbit.period // 2, parameter)
            unknown = half.newton(0.5 * (current + following))
            return orbits, bifurcations, "period halving", None if unknown is None else half.describe(unknown)
        orbits.append(returns.describe(following))
        bifurcations += bifurcations_between(returns, *orbits[-2:])
        shown.update()
        if not limits[0] <= orbits[-1].value(parameter) <= limits[1]:
            return orbits, bifurcations, "limit", None
        advance = linear_algebra.dot(first_strobes - current, tangent)
        aside = linear_algebra.length(first_strobes - current - advance[:, None] * tangent)
        if len(orbits) > 3 and ((advance > 0.0) & (advance <= length) & (aside < 0.1 * length)).any():
            return orbits, bifurcations, "closed", None
        if len(orbits) == MAX_ORBITS:
            return orbits, bifurcations, "length", None
    return orbits, bifurcations, "step", None


def bifurcations_between(returns: ReturnMap, before: Orbit, after: Orbit) -> list[Bifurcation]:
    """Bifurcations between two neighbouring orbits of a branch, in the order in which they are met."""
    begin, end = returns.unknown(before), returns.unknown(after)
    direction = (end - begin) / linear_algebra.length(end - begin)

    def at(part: float) -> Orbit | None:
        unknown = returns.correct(begin + part * (end - begin), direction)
        return None if unknown is None else returns.describe(unknown)

    bifurcations = []
    for kind, sign in SIGNS.items():
        test = partial(multiplier_test, sign=sign)
        if test(before) * test(after) < 0.0 and (part := _zero(at, test)) is not None:
            orbit = at(part)
            if abs(test(orbit)) > JUMP * abs(test(after) - test(before)):
                continue  # with `tension: clip`, the multipliers jump at a grazing
            multiplier = min(orbit.multipliers, key=lambda value, sign=sign: abs(value - sign))
            bifurcations.append((part, Bifurcation(kind, orbit, multiplier.real, returns.parameter)))
    if before.impacts != after.impacts:
        part = _zero(at, lambda orbit: 0.5 - (orbit.impacts != before.impacts))
        if part is not None:
            orbit = at(part)
            bifurcations.append((part, Bifurcation("grazing", orbit, orbit.multipliers[0].real, returns.parameter)))
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


def check_doubling(name: str, bifurcation: object) -> None:
    """TypeError or ValueError, with the `name` of the argument, unless `bifurcation` is a period doubling."""
    check_type(name, bifurcation, Bifurcation)
    check_type(f"{name}.orbit", bifurcation.orbit, Orbit)
    check_choice(f"{name}.parameter", bifurcation.parameter, CONTINUED)
    check_choice(f"{name}.kind", bifurcation.kind, ("period_doubling",))


def find_doubled_orbit(bifurcation: Bifurcation) -> Orbit | None:
    """An orbit of twice the period at the distance DOUBLED from a period doubling, along the eigenvector of -1.

    None where Newton's iteration finds no orbit.

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=54.0), Start(z=3e-4))
    >>> (doubling,) = continue_orbit(orbit, "acceleration", (53.9, 54.5)).bifurcations
    >>> doubled = find_doubled_orbit(doubling)
    >>> doubled.period, doubled.stable
    (2, True)
    """
    check_doubling("bifurcation", bifurcation)
    orbit = bifurcation.orbit
    single, double = (ReturnMap(orbit.parameters, n * orbit.period, bifurcation.parameter) for n in (1, 2))
    unknown = single.unknown(orbit)
    matrix = single.residual(unknown)[1] + np.eye(2)
    nearest = min(linear_algebra.eigenvalues(matrix), key=lambda value: abs(value + 1.0))
    along = np.append(linear_algebra.eigenvector(matrix, nearest.real), 0.0)
    corrected = double.correct(unknown + DOUBLED * along, along)
    return None if corrected is None else double.describe(corrected)


def on_branch(branch: Branch, orbit: Orbit) -> bool:
    """Whether an orbit of the same conveyor, at any of its phases, lies on a branch.

    Examples
    --------
    >>> orbits = [periodic_orbit(Conveyor(acceleration=value), Start(z=3e-4)) for value in (40.0, 40.5)]
    >>> on_branch(follow_branch(orbits[0], "acceleration", (39.0, 41.0)), orbits[1])
    True
    """
    if branch.orbits[0].period != orbit.period:
        return False
    returns = ReturnMap(branch.orbits[0].parameters, orbit.period, branch.parameter)
    strobes = returns.strobes(returns.unknown(orbit))
    points = np.array([returns.unknown(other) for other in branch.orbits])
    above = points[:, 2] > strobes[0, 2]
    for i in np.flatnonzero(above[1:] != above[:-1]):
        part = (strobes[0, 2] - points[i, 2]) / (points[i + 1, 2] - points[i, 2])
        guess = points[i] + part * (points[i + 1] - points[i])
        if linear_algebra.length(strobes - guess).min() < LARGEST_STEP:
            unknown = returns.newton(guess)
            if unknown is not None and linear_algebra.length(strobes - unknown).min() < SAME_ORBIT:
                return True
    return False
