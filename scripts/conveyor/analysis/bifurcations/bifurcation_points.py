"""Folds, period doublings and grazings in the dimensionless groups, as implicit functions.

A fold or a doubling of an orbit of n cycles is a zero of three functions of the state X = (x, y) and Γ,

    Pⁿ(X) - X = 0,   1 ∓ tr M + det M = 0   (a multiplier ±1),

A grazing is a zero of two functions of Γ and the phase ψ at which the orbit touches the surface of the plate,
Pⁿ(0) = 0. Difference quotients give the derivatives of these functions.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import root

from ... import linear_algebra
from ...packing import as_rows
from ...solver import contact
from ...solver.model import PSI0
from ...solver.status import OK
from .. import stroboscopic_map
from ..dimensionless_groups import Groups, groups_of, length_and_speed_units, packed
from .newton import difference_quotients, newton

TOLERANCE = 1e-14
# Newton's iteration: its last correction, the size below which a correction that does not shrink is round-off, and the
# number of corrections.
CONVERGED, STAGNANT = 1e-12, 1e-7
ITERATIONS = 30
# Searches for a touch, each from the end of the one before; evaluations of each; largest value of the functions there.
# The derivative of the map changes with the square root of the distance from a touch, which is known to TOLERANCE.
SEARCHES, EVALUATIONS, TOUCHES = 6, 60, math.sqrt(TOLERANCE)
FARTHEST = 10.0
DIFFERENCE = 3e-6  # step of difference quotients, in the unknowns
# Largest relative difference of the amplitudes of one bifurcation that was found in two ways.
SAME = 1e-6
# Moments of an orbit at which a touch is looked for.
MOMENTS = 1000

SIGNS = {"fold": 1.0, "period_doubling": -1.0}
GRAZING = "grazing"


class Linearisation(NamedTuple):
    """Pⁿ at a scaled state (x, y), and its derivative."""

    image: np.ndarray  # shape (2,)
    matrix: np.ndarray  # ∂Pⁿ/∂(x, y), shape (2, 2)
    impacts: int  # of all cycles


class BifurcationPoint(NamedTuple):
    """A bifurcation: for a fold or doubling `unknown` is (x, y, Γ), for a grazing (ψ, Γ)."""

    kind: str  # fold, period_doubling or grazing
    period: int  # excitation cycles
    unknown: np.ndarray
    groups: Groups  # with Γ


def linearise(groups: Groups, state: np.ndarray, period: int, psi0: float = 0.0) -> Linearisation | None:
    """The image of a scaled state (x, y) at the phase ψ0 after `period` cycles, or None where the motion is lost."""
    strobe = stroboscopic_map.state_of(groups, state)
    status, matrices, features = stroboscopic_map.monodromy(packed(groups, psi0), TOLERANCE, strobe, period, 0.0)
    if status != OK:
        return None
    impacts = int(features[:, stroboscopic_map.IMPACTS].sum())
    return Linearisation(stroboscopic_map.smooth_state(groups, strobe), linear_algebra.chain(matrices), impacts)


def at_phase_zero(parameters: np.ndarray, state: np.ndarray) -> np.ndarray | None:
    """The scaled state (x, y) of a motion when the phase of the excitation is next 0, shape (2,).

    None where the motion is lost.

    Parameters
    ----------
    parameters : a row of a table
    state : δ (m) and v (m/s) at the phase ψ0, shape (2,)

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=40.0), Start(z=3e-4))
    >>> at_phase_zero(parameter_table(Conveyor(acceleration=40.0)), orbit.state).round(3).tolist()
    [-5.495, 0.686]
    """
    groups, (length, velocity) = groups_of(parameters), length_and_speed_units(parameters)
    psi0 = float(as_rows(parameters)[PSI0])
    c = contact.constants(packed(groups, psi0), TOLERANCE)
    strobe = np.array(state) / (length, velocity)
    remaining = (-psi0 % (2.0 * math.pi)) / c.omega
    features, no_tangent = np.zeros(stroboscopic_map.FEATURES), np.empty((0, 2))
    if remaining > 0.0:
        status = stroboscopic_map.advance(c, contact.workspace(), strobe, psi0, remaining, no_tangent, features)
        if status != OK:
            return None
    return stroboscopic_map.smooth_state(groups, strobe)


def conditions(kind: str, period: int, unknown: np.ndarray, groups: Groups) -> np.ndarray:
    """The functions whose zero is a bifurcation, as many as it has unknowns; NaN where the motion is lost."""
    point_groups = groups._replace(amplitude=float(unknown[-1]))
    if kind == GRAZING:
        touch = linearise(point_groups, np.zeros(2), period, float(unknown[0]))
        return np.full(2, np.nan) if touch is None else touch.image
    cycle = linearise(point_groups, unknown[:2], period)
    return np.full(3, np.nan) if cycle is None else np.append(cycle.image - unknown[:2], multiplier_test(kind, cycle))


def multiplier_test(kind: str, cycle: Linearisation) -> float:
    """1 ∓ tr M + det M, which is 0 where a multiplier is +1 (fold) or -1 (period doubling)."""
    return 1.0 - SIGNS[kind] * np.trace(cycle.matrix) + linear_algebra.determinant(cycle.matrix)


def find_bifurcation(kind: str, period: int, unknown: np.ndarray, groups: Groups) -> BifurcationPoint | None:
    """The bifurcation near a guess of its unknowns, or None.

    Parameters
    ----------
    kind : fold, period_doubling or grazing
    period : excitation cycles of the orbit
    unknown : guess of the unknowns, see BifurcationPoint
    groups : of the conveyor; Γ does not matter, because it is an unknown

    Examples
    --------
    >>> row = parameter_table(Conveyor())
    >>> fold = find_bifurcation("fold", 1, np.array([-3.41, 1.61, 0.508]), groups_of(row))
    >>> round(amplitude_of(row, fold.groups.amplitude), 4)  # m/s²
    23.9763
    """

    def functions(unknowns):
        return conditions(kind, period, unknowns, groups)

    def system(unknowns):
        value = functions(unknowns)
        return (value, difference_quotients(functions, unknowns, DIFFERENCE)) if np.isfinite(value).all() else None

    if kind == GRAZING:
        solved = find_touch(functions, unknown)
    else:
        limits = {"iterations": ITERATIONS, "largest": FARTHEST, "stagnant": STAGNANT}
        solved = newton(system, unknown, converged=CONVERGED, **limits)
    if solved is None:
        return None
    return BifurcationPoint(kind, period, solved, groups._replace(amplitude=float(solved[-1])))


def find_touch(functions: Callable[[np.ndarray], np.ndarray], guess: np.ndarray) -> np.ndarray | None:
    """The zero near a guess of functions whose derivatives jump there, because the orbit touches the plate, or None.

    Newton's iteration may alternate between both sides of the jump. Broyden's method does not, but it converges slowly
    with the derivatives of a guess on one side, so that it begins again.
    """
    for _ in range(SEARCHES):
        solution = root(functions, guess, tol=CONVERGED, options={"maxfev": EVALUATIONS})
        if np.abs(solution.fun).max() < TOUCHES:
            return solution.x
        guess = solution.x
    return None


def bifurcation_near(parameters: np.ndarray, kind: str, state: np.ndarray, period: int) -> BifurcationPoint | None:
    """The bifurcation of a conveyor near one that is known in SI units; None if it is not found.

    Parameters
    ----------
    parameters : a row of a table, with the amplitude of the bifurcation
    kind : fold, period_doubling or grazing
    state : of the orbit there, δ (m) and v (m/s) at the phase ψ0, shape (2,)
    period : excitation cycles of the orbit
    """
    groups, at_zero = groups_of(parameters), at_phase_zero(parameters, state)
    if at_zero is None:
        return None
    guess = touching_point(groups, at_zero, period) if kind == GRAZING else np.append(at_zero, groups.amplitude)
    point = None if guess is None else find_bifurcation(kind, period, guess, groups)
    is_same = point is not None and abs(point.groups.amplitude / groups.amplitude - 1.0) < SAME
    return point if is_same else None


def touching_point(groups: Groups, state: np.ndarray, period: int) -> np.ndarray | None:
    """The phase ψ at which an orbit comes closest to touching the plate with no speed, and Γ.

    It is a guess for `find_bifurcation`, shape (2,). None where the motion is lost, or never turns.

    Parameters
    ----------
    groups : of the conveyor, with Γ
    state : scaled (x, y) of the orbit at the phase 0, shape (2,)
    period : excitation cycles of the orbit

    Examples
    --------
    >>> row, orbit = parameter_table(Conveyor(acceleration=45.6)), periodic_orbit(Conveyor(acceleration=45.6))
    >>> guess = touching_point(groups_of(row), at_phase_zero(row, orbit.state), 1)
    >>> grazing = find_bifurcation("grazing", 1, guess, groups_of(row))
    >>> round(amplitude_of(row, grazing.groups.amplitude), 4)  # m/s²: the part begins to leave the plate
    45.6996
    """
    row = packed(groups)
    c = contact.constants(row, TOLERANCE)
    series, features = contact.workspace(), np.zeros(stroboscopic_map.FEATURES)
    strobe, no_tangent = stroboscopic_map.state_of(groups, state), np.empty((0, 2))
    passed = []
    step = c.period / MOMENTS
    for n in range(period * MOMENTS):
        passed.append((n % MOMENTS * step, *strobe))
        if stroboscopic_map.advance(c, series, strobe, n % MOMENTS * step, step, no_tangent, features) != OK:
            return None
    phase, x, speed = np.array(passed).T
    following = np.roll(speed, -1)
    turns = np.flatnonzero(speed * following < 0.0)
    if not len(turns):
        return None
    nearest = turns[np.argmin(np.abs(x[turns]))]
    part = speed[nearest] / (speed[nearest] - following[nearest])
    return np.array([phase[nearest] + part * step, groups.amplitude])
