"""Periodic orbits: Newton on the stroboscopic map, Floquet multipliers, continuation, folds and period doublings.

An orbit of period n is a fixed point of the n-th power of the stroboscopic map in (δ, Y) (see stroboscope). Branches
are followed in the amplitude â by pseudo-arclength (Keller 1977), so that they pass folds. Where a multiplier passes +1
a branch folds, where one passes -1 its period doubles, and where a contact begins or ceases to exist an impact grazes.
The product of the multipliers is positive and at most 1, so that no other bifurcation of a single orbit is generic.
"""

import cmath
import math
from collections.abc import Callable, Iterable
from functools import reduce
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from . import contact, stroboscope
from .model import ACCELERATION, DAMPING, MASS
from .trajectory import OK

TOLERANCE = 1e-13
AMPLITUDE_STEP = 1e-6  # m/s², of the central difference ∂P/∂â
CONVERGED = 1e-10  # of Newton's last correction, in scaled unknowns
STAGNANT = 1e-6  # corrections below this that converge no further are round-off
SAME = 1e-5  # orbits this close are one, in scaled unknowns
# Following a branch: arclength of a step in scaled unknowns, about that in â (m/s²), its first part and its smallest.
LARGEST_STEP, FIRST_STEP, SMALLEST_STEP = 0.1, 1e-3, 1e-7
STRAIGHT = 0.95  # cosine of the largest turn of a branch within one step
MAX_ORBITS = 5000
FEIGENBAUM = 4.669201609102990
RESOLVED = 1e-6  # of 1 + μ at a doubling of the cascade: six digits of its distance to the next one
SECANT_STEPS = 12  # after which a doubling of the cascade is not resolved


class Orbit(NamedTuple):
    """A periodic orbit of the vertical motion at one amplitude."""

    acceleration: float  # m/s²
    state: np.ndarray  # (δ in m, v in m/s) at the phase ψ0
    period: int  # excitation cycles
    multipliers: tuple[complex, complex]  # Floquet multipliers, the larger modulus first
    determinant: float  # their product, from the monodromy matrix
    impacts: int  # per period
    contact_time: float  # s per period
    longest_flight: float  # excitation cycles

    @property
    def stable(self) -> bool:
        """Whether both multipliers lie inside the unit circle."""
        return abs(self.multipliers[0]) < 1.0


class Bifurcation(NamedTuple):
    """A point of a branch at which its stability or its impacts change."""

    kind: str  # fold, period_doubling, grazing
    orbit: Orbit
    multiplier: float  # the real multiplier at +1 or -1; for a grazing the one of larger modulus


class Branch(NamedTuple):
    """A branch of periodic orbits in the order of its arclength, what was found on it, and why it ends."""

    orbits: list[Orbit]
    bifurcations: list[Bifurcation]
    ends: tuple[str, str]  # at the first and at the last orbit: limit, closed, period halving, step, length
    parent: Orbit | None  # the orbit of half the period where it ends in one


class ReturnMap:
    """The n-th power of the stroboscopic map and its fixed points, in scaled unknowns u = (δ, Y, â).

    The units are g/ω² (m), g/ω (m/s) and 1 m/s², which makes the three comparable. A map that fails gives NaN.
    """

    def __init__(self, parameters: np.ndarray, period: int):
        c = contact.constants(parameters, TOLERANCE)
        self.parameters = parameters.copy()
        self.period = period
        self.cycle = c.period
        self.damping = parameters[DAMPING] / parameters[MASS]
        self.unit = np.array([c.gravity / c.omega**2, c.gravity / c.omega, 1.0])

    def scaled(self, acceleration: float, state: np.ndarray) -> np.ndarray:
        """The unknowns of a state (δ in m, v in m/s) at an amplitude."""
        return np.array([state[0], state[1] + self.damping * max(state[0], 0.0), acceleration]) / self.unit

    def state(self, unknown: np.ndarray) -> np.ndarray:
        """The state (δ in m, v in m/s) of unknowns."""
        delta, y, _ = unknown * self.unit
        return np.array([delta, y - self.damping * max(delta, 0.0)])

    def row(self, unknown: np.ndarray) -> np.ndarray:
        """The packed parameters at the amplitude of unknowns."""
        row = self.parameters.copy()
        row[ACCELERATION] = unknown[2] * self.unit[2]
        return row

    def strobes(self, unknown: np.ndarray) -> np.ndarray:
        """Unknowns after 1 … n cycles, shape (n, 3)."""
        states, features = np.empty((self.period, 2)), np.empty((self.period, stroboscope.FEATURES))
        stroboscope.follow(self.row(unknown), TOLERANCE, self.state(unknown), self.period, states, features)
        return np.array([self.scaled(unknown[2] * self.unit[2], state) for state in states])

    def linearised(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(δ, Y) after n cycles in their units, the matrices (SI units) and the features of all cycles."""
        state, matrices = self.state(unknown), np.empty((self.period, 2, 2))
        features = np.zeros((self.period, stroboscope.FEATURES))
        if stroboscope.monodromy(self.row(unknown), TOLERANCE, state, matrices, features) != OK:
            return np.full(2, np.nan), np.full((self.period, 2, 2), np.nan), features
        return self.scaled(unknown[2], state)[:2], matrices, features

    def residual(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P(X) - X, shape (2,), and its derivative by (δ, Y), shape (2, 2), scaled."""
        image, matrices, _ = self.linearised(unknown)
        matrix = reduce(lambda product, following: following @ product, matrices)
        return image - unknown[:2], matrix * self.unit[:2] / self.unit[:2, None] - np.eye(2)

    def slope(self, unknown: np.ndarray) -> np.ndarray:
        """Derivative of P by â, scaled, shape (2,)."""
        ahead = np.array([0.0, 0.0, AMPLITUDE_STEP])
        return (self.strobes(unknown + ahead)[-1, :2] - self.strobes(unknown - ahead)[-1, :2]) / (2.0 * AMPLITUDE_STEP)

    def newton(self, unknown: np.ndarray, iterations: int = 30) -> np.ndarray | None:
        """The fixed point that Newton's iteration at constant â finds from `unknown`, or None."""
        unknown, size = unknown.copy(), math.inf
        for _ in range(iterations):
            residual, jacobian = self.residual(unknown)
            step = _solve(jacobian, -residual)
            unknown[:2] += step
            previous, size = size, np.abs(step).max()
            if not size < 1e3:
                return None
            # Close to the solution steps that shrink no more are round-off, which a long unstable orbit amplifies.
            if size < CONVERGED or (previous < STAGNANT and size > 0.1 * previous):
                return unknown
        return None

    def correct(self, guess: np.ndarray, direction: np.ndarray, iterations: int = 10) -> np.ndarray | None:
        """The fixed point in the plane through `guess` normal to `direction`, a unit vector, or None."""
        unknown = guess.copy()
        for _ in range(iterations):
            residual, jacobian = self.residual(unknown)
            system = np.vstack([np.column_stack([jacobian, self.slope(unknown)]), direction])
            step = _solve(system, -np.append(residual, direction @ (unknown - guess)))
            unknown = unknown + step
            if not np.linalg.norm(unknown - guess) < 10.0:
                return None
            if np.abs(step).max() < CONVERGED:
                return unknown
        return None

    def tangent(self, unknown: np.ndarray, previous: np.ndarray) -> np.ndarray:
        """Unit vector along the branch through a fixed point, pointing on from `previous`."""
        _, jacobian = self.residual(unknown)
        slope = self.slope(unknown)
        vector = np.cross(np.append(jacobian[0], slope[0]), np.append(jacobian[1], slope[1]))
        vector /= np.linalg.norm(vector)
        return vector if vector @ previous >= 0.0 else -vector

    def halving(self, unknown: np.ndarray) -> np.ndarray:
        """Distance to the point half a period later, shape (3,): it passes zero where the orbit's period halves."""
        return self.strobes(unknown)[self.period // 2 - 1] - unknown

    def describe(self, unknown: np.ndarray) -> Orbit:
        """The Orbit of a fixed point."""
        _, matrices, features = self.linearised(unknown)
        matrix = reduce(lambda product, following: following @ product, matrices)
        trace, determinant = float(np.trace(matrix)), float(np.prod(np.linalg.det(matrices)))
        root = cmath.sqrt(0.25 * trace * trace - determinant)
        first = max(0.5 * trace + root, 0.5 * trace - root, key=abs)
        second = determinant / first if first != 0.0 else 0.0j
        flights = features[:, [stroboscope.LONGEST_FLIGHT, stroboscope.AIRBORNE]]
        return Orbit(
            acceleration=float(unknown[2] * self.unit[2]),
            state=self.state(unknown),
            period=self.period,
            multipliers=(first, second),
            determinant=determinant,
            impacts=int(features[:, stroboscope.IMPACTS].sum()),
            contact_time=float(features[:, stroboscope.CONTACT_TIME].sum()),
            longest_flight=float(flights.max() / self.cycle),
        )


def _solve(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The solution of a linear system; NaN for a singular one (an orbit that never touches the plate)."""
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        return np.full(len(right), np.nan)


def fold_test(orbit: Orbit) -> float:
    """(1 - μ1)(1 - μ2), real for complex multipliers too: zero where a multiplier is +1."""
    first, second = orbit.multipliers
    return ((1.0 - first) * (1.0 - second)).real


def doubling_test(orbit: Orbit) -> float:
    """(1 + μ1)(1 + μ2), real for complex multipliers too: zero where a multiplier is -1."""
    first, second = orbit.multipliers
    return ((1.0 + first) * (1.0 + second)).real


def find_orbit(parameters: np.ndarray, acceleration: float, state: np.ndarray, period: int) -> Orbit | None:
    """The orbit of `period` cycles that Newton's iteration finds from `state` (δ in m, v in m/s), or None.

    An orbit whose period is a part of `period` is one of `period` cycles, too.
    """
    found = ReturnMap(parameters, period)
    unknown = found.newton(found.scaled(acceleration, state))
    return None if unknown is None else found.describe(unknown)


def settled_orbit(
    parameters: np.ndarray, acceleration: float, state: np.ndarray, periods: Iterable[int], cycles: int
) -> tuple[Orbit | None, np.ndarray]:
    """The stable orbit that a trajectory from `state` ends in, and the state after `cycles` cycles.

    Parameters
    ----------
    parameters : float64, shape (13,); its amplitude is ignored
    acceleration : amplitude, m/s²
    state : δ (m) and v (m/s)
    periods : that are tried, in this order; the orbit is None if it has none of them
    cycles : excitation cycles after which the motion has come near its orbit; Newton's iteration does the rest
    """
    row = parameters.copy()
    row[ACCELERATION] = acceleration
    end = np.array(state, dtype=np.float64)
    strobes, features = np.empty((cycles, 2)), np.empty((cycles, stroboscope.FEATURES))
    if stroboscope.follow(row, TOLERANCE, end, cycles, strobes, features) != OK:
        return None, end
    unit = ReturnMap(parameters, 1).unit[:2]
    for period in periods:
        if np.abs((strobes[-1] - strobes[-1 - period]) / unit).max() < 1e-2:
            orbit = find_orbit(parameters, acceleration, end, period)
            if orbit is not None and orbit.stable and np.abs((orbit.state - end) / unit).max() < 0.1:
                return orbit, end
    return None, end


def follow_branch(parameters: np.ndarray, orbit: Orbit, limits: tuple[float, float]) -> Branch:
    """Follow the branch of `orbit` in â to both sides by pseudo-arclength.

    Parameters
    ----------
    parameters : float64, shape (13,); its amplitude is ignored
    orbit : an orbit within the limits
    limits : lowest and highest â, m/s²

    Returns
    -------
    Branch, with folds, period doublings and grazings located to about 1e-9 m/s²
    """
    upwards = np.array([0.0, 0.0, 1.0])
    orbits, found, last, parent = _follow(parameters, orbit, limits, upwards)
    if last == "closed":
        return Branch(orbits, found, (last, last), None)
    before, found_before, first, other = _follow(parameters, orbit, limits, -upwards)
    return Branch(
        [*before[:0:-1], *orbits], [*reversed(found_before), *found], (first, last), parent if other is None else other
    )


def _follow(parameters, orbit, limits, direction):
    """Orbits and bifurcations in the order in which they are met, the reason of the end and the orbit's parent."""
    returns = ReturnMap(parameters, orbit.period)
    here = returns.scaled(orbit.acceleration, orbit.state)
    beginning = returns.strobes(here)
    tangent = returns.tangent(here, direction)
    orbits, bifurcations = [orbit], []
    length = FIRST_STEP
    while len(orbits) < MAX_ORBITS:
        there = returns.correct(here + length * tangent, tangent)
        following = None if there is None else returns.tangent(there, tangent)
        # A step that turns sharply may have jumped to another branch.
        if there is None or not following @ tangent > STRAIGHT or np.linalg.norm(there - here) > 1.2 * length:
            length *= 0.5
            if length < SMALLEST_STEP:
                return orbits, bifurcations, "step", None
            continue
        if orbit.period % 2 == 0 and returns.halving(here) @ returns.halving(there) < 0.0:
            half = ReturnMap(parameters, orbit.period // 2)
            unknown = half.newton(0.5 * (here + there))
            return orbits, bifurcations, "period halving", None if unknown is None else half.describe(unknown)
        orbits.append(returns.describe(there))
        bifurcations += bifurcations_between(parameters, *orbits[-2:])
        if not limits[0] <= orbits[-1].acceleration <= limits[1]:
            return orbits, bifurcations, "limit", None
        advance = (beginning - here) @ tangent
        aside = np.linalg.norm(beginning - here - advance[:, None] * tangent, axis=1)
        if len(orbits) > 3 and ((advance > 0.0) & (advance <= length) & (aside < 0.1 * length)).any():
            return orbits, bifurcations, "closed", None
        here, tangent = there, following
        length = min(1.3 * length, LARGEST_STEP)
    return orbits, bifurcations, "length", None


def bifurcations_between(parameters: np.ndarray, before: Orbit, after: Orbit) -> list[Bifurcation]:
    """Bifurcations between two neighbouring orbits of a branch, in the order in which they are met."""
    returns = ReturnMap(parameters, before.period)
    begin, end = (returns.scaled(orbit.acceleration, orbit.state) for orbit in (before, after))
    direction = (end - begin) / np.linalg.norm(end - begin)

    def at(part: float) -> Orbit | None:
        unknown = returns.correct(begin + part * (end - begin), direction)
        return None if unknown is None else returns.describe(unknown)

    found = []
    for kind, test, sign in (("fold", fold_test, 1.0), ("period_doubling", doubling_test, -1.0)):
        if test(before) * test(after) < 0.0 and (part := _zero(at, test)) is not None:
            orbit = at(part)
            multiplier = min(orbit.multipliers, key=lambda value, sign=sign: abs(value - sign))
            found.append((part, Bifurcation(kind, orbit, multiplier.real)))
    if before.impacts != after.impacts:
        part = _zero(at, lambda orbit: 0.5 - (orbit.impacts != before.impacts))
        if part is not None:
            orbit = at(part)
            found.append((part, Bifurcation("grazing", orbit, orbit.multipliers[0].real)))
    return [bifurcation for _, bifurcation in sorted(found, key=lambda item: item[0])]


def _zero(at: Callable[[float], Orbit | None], test: Callable[[Orbit], float]) -> float | None:
    """Where a test function of the orbits along a step, parts 0 … 1, is zero; None if an orbit is not found there."""

    def value(part):
        orbit = at(part)
        if orbit is None:
            raise ArithmeticError("no orbit")
        return test(orbit)

    try:
        return brentq(value, 0.0, 1.0, xtol=1e-12, rtol=1e-12)
    except (ArithmeticError, ValueError):
        return None


def doubled(parameters: np.ndarray, bifurcation: Bifurcation, distance: float = 0.02) -> Orbit | None:
    """An orbit of twice the period near a period doubling, `distance` (scaled) from it along the eigenvector of -1."""
    orbit = bifurcation.orbit
    single, double = ReturnMap(parameters, orbit.period), ReturnMap(parameters, 2 * orbit.period)
    unknown = single.scaled(orbit.acceleration, orbit.state)
    values, vectors = np.linalg.eig(single.residual(unknown)[1] + np.eye(2))
    along = np.append(vectors[:, np.argmin(np.abs(values + 1.0))].real, 0.0)
    along /= np.linalg.norm(along)
    found = double.correct(unknown + distance * along, along)
    return None if found is None else double.describe(found)


def on_branch(parameters: np.ndarray, branch: Branch, orbit: Orbit) -> bool:
    """Whether an orbit, at any of its phases, lies on a branch."""
    if branch.orbits[0].period != orbit.period:
        return False
    returns = ReturnMap(parameters, orbit.period)
    strobes = returns.strobes(returns.scaled(orbit.acceleration, orbit.state))
    points = np.array([returns.scaled(other.acceleration, other.state) for other in branch.orbits])
    above = points[:, 2] > strobes[0, 2]
    for i in np.flatnonzero(above[1:] != above[:-1]):
        part = (strobes[0, 2] - points[i, 2]) / (points[i + 1, 2] - points[i, 2])
        guess = points[i] + part * (points[i + 1] - points[i])
        if np.linalg.norm(strobes - guess, axis=1).min() < LARGEST_STEP:
            unknown = returns.newton(guess)
            if unknown is not None and np.linalg.norm(strobes - unknown, axis=1).min() < SAME:
                return True
    return False


def explore(
    parameters: np.ndarray, seeds: Iterable[Orbit], limits: tuple[float, float], max_period: int
) -> list[Branch]:
    """All branches that hang together with the seeds through period doublings, each once.

    Parameters
    ----------
    parameters : float64, shape (13,); its amplitude is ignored
    seeds : orbits to begin with
    limits : lowest and highest â, m/s²
    max_period : longer orbits are left out
    """
    branches: list[Branch] = []
    waiting = list(seeds)
    while waiting:
        orbit = waiting.pop(0)
        if any(on_branch(parameters, branch, orbit) for branch in branches):
            continue
        branch = follow_branch(parameters, orbit, limits)
        branches.append(branch)
        if branch.parent is not None:
            waiting.append(branch.parent)
        if 2 * orbit.period <= max_period:
            doublings = [b for b in branch.bifurcations if b.kind == "period_doubling"]
            waiting += [new for b in doublings if (new := doubled(parameters, b)) is not None]
    return branches


def doubling_cascade(parameters: np.ndarray, first: Bifurcation, second: Bifurcation) -> list[Bifurcation]:
    """The period doublings that follow two successive ones, as far as double precision resolves them.

    Each doubling lies by Feigenbaum's ratio closer to the last one than that to its predecessor. Halfway there the
    doubled orbit is about superstable: a trajectory comes to it at once, and Newton's iteration follows it in â to
    where its multiplier is -1.
    """
    cascade = [first, second]
    while True:
        last = cascade[-1].orbit
        gap = (last.acceleration - cascade[-2].orbit.acceleration) / FEIGENBAUM
        period = 2 * last.period
        before, _ = settled_orbit(parameters, last.acceleration + 0.5 * gap, last.state, (period,), 30 * period)
        if before is None:
            return cascade
        here = find_orbit(parameters, last.acceleration + 0.6 * gap, before.state, period)
        for _ in range(SECANT_STEPS):
            if here is None or abs(doubling_test(here)) <= RESOLVED:
                break
            # A secant step in â, from which Newton's iteration starts on the secant of the states.
            part = doubling_test(here) / (doubling_test(before) - doubling_test(here))
            acceleration = here.acceleration + part * (here.acceleration - before.acceleration)
            state = here.state + part * (here.state - before.state)
            before, here = here, find_orbit(parameters, acceleration, state, period)
            if abs(acceleration - last.acceleration - gap) > 0.5 * abs(gap) or acceleration == before.acceleration:
                return cascade
        if here is None or abs(doubling_test(here)) > RESOLVED:
            return cascade
        cascade.append(Bifurcation("period_doubling", here, min(value.real for value in here.multipliers)))


def ratios(amplitudes: np.ndarray) -> np.ndarray:
    """Feigenbaum's ratios (d_n - d_(n-1))/(d_(n+1) - d_n) of successive doublings, shape (n - 2,)."""
    gaps = np.diff(amplitudes)
    return gaps[:-1] / gaps[1:]


def accumulation(amplitudes: np.ndarray) -> tuple[float, float]:
    """Limit of successive doublings by Aitken's process, and its error: how far the last doubling moved it."""
    before, gap = amplitudes[:-2], np.diff(amplitudes)
    limits = before - gap[:-1] ** 2 / (gap[1:] - gap[:-1])
    return float(limits[-1]), float(abs(limits[-1] - limits[-2]))
