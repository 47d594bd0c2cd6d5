"""Folds, period doublings and grazings in the dimensionless groups, and their derivatives, as implicit functions.

A fold or a doubling of an orbit of n cycles is a zero of three functions of the state X = (x, y) and Γ,

    Pⁿ(X) - X = 0,   1 ∓ tr M + det M = 0   (a multiplier ±1),

A grazing is a zero of two functions of Γ and the phase ψ at which the orbit touches the surface of the plate,
Pⁿ(0) = 0. The derivatives of these functions by X, Γ, D, K and p come from second_derivatives, without differences.
"""

import math
from typing import NamedTuple

import numpy as np

from ... import linear_algebra
from ...packing import as_rows
from ...solver import contact
from ...solver.model import PSI0
from ...solver.trajectory import OK
from .. import second_derivatives, stroboscopic_map
from ..dimensionless_groups import Groups, groups_of, length_and_speed_units, packed
from .newton import newton

TOLERANCE = 1e-14
# Newton's iteration: its last correction; the size and number of corrections that no longer shrink and therefore are
# round-off (at a grazing their size alternates, because the solver sees the touch or not); the number of corrections.
CONVERGED, STAGNANT, OFTEN = 1e-12, 1e-7, 4
ITERATIONS = 30
FARTHEST = 10.0
# Moments of an orbit at which a touch is looked for.
MOMENTS = 1000

SIGNS = {"fold": 1.0, "period_doubling": -1.0}
GRAZING = "grazing"


class Derivatives(NamedTuple):
    """Pⁿ of the scaled state (x, y) and its derivatives by the first k of x, y, Γ, D, K and p."""

    image: np.ndarray  # shape (2,)
    first: np.ndarray  # shape (2, k)
    second: np.ndarray  # shape (2, 2, k), of first[:, :2]
    states: np.ndarray  # (x, y) after each cycle, shape (n, 2)
    impacts: int  # of all cycles


class BifurcationPoint(NamedTuple):
    """A bifurcation: for a fold or doubling `unknown` is (x, y, Γ), for a grazing (ψ, Γ)."""

    kind: str  # fold, period_doubling or grazing
    period: int  # excitation cycles
    unknown: np.ndarray
    groups: Groups  # with Γ


def derivatives(
    groups: Groups, state: np.ndarray, period: int, psi0: float = 0.0, *, exponent: bool = False
) -> Derivatives | None:
    """The image of a scaled state (x, y) at the phase ψ0 and its derivatives, or None where the motion is lost.

    exponent : whether to compute the derivatives by p, which take several times as long
    """
    count = second_derivatives.QUANTITIES if exponent else second_derivatives.EXPONENT
    begin = velocity_for_y(groups, np.array(state, dtype=np.float64))
    cycles = second_derivatives.cycles(packed(groups, psi0), TOLERANCE, begin, period, count)
    status, first, second, states, impacts = cycles
    if status != OK:
        return None
    states[:, 1] += groups.damping * np.maximum(states[:, 0], 0.0)
    # The chain rule for the derivatives of (x, y, Γ, D, K, p) by their values at the beginning.
    whole, bent = np.eye(count), np.zeros((2, 2, count))
    for of_one, of_two in zip(first, second, strict=True):
        along = linear_algebra.product(linear_algebra.product(whole[:2, :2].T, of_two), whole)
        bent = sum(of_one[:, k, None, None] * bent[k] for k in range(2)) + along
        whole[:2] = linear_algebra.product(of_one, whole)
    return Derivatives(states[-1], whole[:2].copy(), bent, states, int(impacts.sum()))


def at_phase_zero(parameters: np.ndarray, state: np.ndarray) -> np.ndarray | None:
    """Scaled (x, y) at the phase 0 of a motion whose δ (m) and v (m/s) at the phase ψ0 are `state`, or None."""
    groups, (length, velocity) = groups_of(parameters), length_and_speed_units(parameters)
    psi0 = float(as_rows(parameters)[PSI0])
    c = contact.constants(packed(groups, psi0), TOLERANCE)
    here = np.array(state) / (length, velocity)
    remaining = (-psi0 % (2.0 * math.pi)) / c.omega
    features, no_tangent = np.zeros(stroboscopic_map.FEATURES), np.empty((0, 2))
    if remaining > 0.0:
        status = stroboscopic_map.advance(c, contact.workspace(), here, psi0, remaining, no_tangent, features)
        if status != OK:
            return None
    return np.array([here[0], here[1] + groups.damping * max(here[0], 0.0)])


def velocity_for_y(groups: Groups, state: np.ndarray) -> np.ndarray:
    """(x, ẋ) of a scaled state (x, y)."""
    return np.array([state[0], state[1] - groups.damping * max(state[0], 0.0)])


def system(
    kind: str, period: int, unknown: np.ndarray, groups: Groups, *, exponent: bool = False
) -> tuple[np.ndarray, np.ndarray] | None:
    """The functions whose zero is a bifurcation, shape (k,), and their derivatives by its k unknowns, D, K (and p)."""
    if kind == GRAZING:
        return touch_system(period, unknown, groups, exponent=exponent)
    here = groups._replace(amplitude=float(unknown[2]))
    expansion = derivatives(here, unknown[:2], period, exponent=exponent)
    if expansion is None:
        return None
    matrix = expansion.first[:, :2]
    trace = expansion.second[0, 0] + expansion.second[1, 1]
    determinant = (
        expansion.second[0, 0] * matrix[1, 1]
        + expansion.second[1, 1] * matrix[0, 0]
        - expansion.second[0, 1] * matrix[1, 0]
        - expansion.second[1, 0] * matrix[0, 1]
    )
    test = 1.0 - SIGNS[kind] * np.trace(matrix) + linear_algebra.determinant(matrix)
    jacobian = np.vstack([expansion.first - np.eye(2, expansion.first.shape[1]), determinant - SIGNS[kind] * trace])
    return np.append(expansion.image - unknown[:2], test), jacobian


def touch_system(
    period: int, unknown: np.ndarray, groups: Groups, *, exponent: bool = False
) -> tuple[np.ndarray, np.ndarray] | None:
    """The state n cycles after a part touches the plate at relative rest, and its derivatives by ψ, Γ, D, K (and p)."""
    psi, amplitude = (float(value) for value in unknown)
    here = groups._replace(amplitude=amplitude)
    expansion = derivatives(here, np.zeros(2), period, psi, exponent=exponent)
    if expansion is None:
        return None
    # A change of ψ shifts the end of the motion, and its beginning.
    press = 1.0 + amplitude * math.cos(psi)
    x, y = expansion.image
    end = np.array([y - groups.damping * max(x, 0.0), press - groups.stiffness * max(x, 0.0) ** groups.exponent])
    by_phase = end - expansion.first[:, 1] * press
    return expansion.image, np.column_stack([by_phase, expansion.first[:, 2:]])


def find_bifurcation(kind: str, period: int, unknown: np.ndarray, groups: Groups) -> BifurcationPoint | None:
    """The bifurcation that Newton's iteration finds from a guess, or None.

    Parameters
    ----------
    kind : fold, period_doubling or grazing
    period : excitation cycles of the orbit
    unknown : guess of the unknowns, see Point
    groups : of the conveyor; Γ does not matter, because it is an unknown
    """

    def by_unknowns(here):
        evaluated = system(kind, period, here, groups)
        return None if evaluated is None else (evaluated[0], evaluated[1][:, : len(here)])

    limits = {"largest": FARTHEST, "stagnant": STAGNANT, "often": OFTEN}
    here = newton(by_unknowns, unknown, converged=CONVERGED, iterations=ITERATIONS, **limits)
    return None if here is None else BifurcationPoint(kind, period, here, groups._replace(amplitude=float(here[-1])))


def differentiate_unknowns(point: BifurcationPoint) -> np.ndarray | None:
    """Derivatives of the unknowns of a bifurcation by D, K and p, shape (k, 3), by the implicit function theorem.

    The last row is that of Γ. None where the system is singular (a codimension-two point) or cannot be evaluated.
    """
    evaluated = system(point.kind, point.period, point.unknown, point.groups, exponent=True)
    count = len(point.unknown)
    return None if evaluated is None else linear_algebra.solve(evaluated[1][:, :count], -evaluated[1][:, count:])


def touching_point(groups: Groups, state: np.ndarray, period: int) -> np.ndarray | None:
    """The phase ψ at which an orbit comes closest to touching the plate with no speed, and Γ.

    It is a guess for `find_bifurcation`, shape (2,). None where the motion is lost, or never turns.

    Parameters
    ----------
    groups : of the conveyor, with Γ
    state : scaled (x, y) of the orbit at the phase 0, shape (2,)
    period : excitation cycles of the orbit
    """
    row = packed(groups)
    c = contact.constants(row, TOLERANCE)
    series, features = contact.workspace(), np.zeros(stroboscopic_map.FEATURES)
    here, no_tangent = velocity_for_y(groups, np.array(state, dtype=np.float64)), np.empty((0, 2))
    passed = []
    step = c.period / MOMENTS
    for n in range(period * MOMENTS):
        passed.append((n % MOMENTS * step, *here))
        if stroboscopic_map.advance(c, series, here, n % MOMENTS * step, step, no_tangent, features) != OK:
            return None
    phase, x, speed = np.array(passed).T
    following = np.roll(speed, -1)
    turns = np.flatnonzero(speed * following < 0.0)
    if not len(turns):
        return None
    nearest = turns[np.argmin(np.abs(x[turns]))]
    part = speed[nearest] / (speed[nearest] - following[nearest])
    return np.array([phase[nearest] + part * step, groups.amplitude])
