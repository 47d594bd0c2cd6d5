"""Periodic orbits: Newton's iteration on the stroboscopic map, and Floquet multipliers.

An orbit of period n is a fixed point of the n-th power of the stroboscopic map in (δ, Y) (see stroboscopic_map).
"""

import cmath
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ... import linear_algebra
from ...arguments import LARGEST_COORDINATE, LONGEST_PERIOD, check_array, check_count, check_number
from ...packing import as_rows, check_rows
from ...parameters import RANGES
from ...solver import contact, contact_law
from ...solver.model import ACCELERATION, FREQUENCY
from ...solver.status import OK
from .. import stroboscopic_map
from ..dimensionless_groups import length_and_speed_units
from .newton import newton

ORBIT_TOLERANCE = 1e-13
AMPLITUDE_STEP = 1e-6  # m/s², of the central difference ∂P/∂â
CONVERGED = 1e-10  # of Newton's last correction, in scaled unknowns
STAGNANT = 1e-6  # corrections below this that no longer shrink are round-off


class Orbit(NamedTuple):
    """A periodic orbit of the vertical motion at one amplitude."""

    acceleration: float  # m/s²
    state: np.ndarray  # (δ in m, v in m/s) at the phase ψ0
    period: int  # excitation cycles
    multipliers: tuple[complex, complex]  # Floquet multipliers, the larger modulus first
    determinant: float  # their product, from the monodromy matrix, or from the trace formula where rounding hides it
    impacts: int  # per period
    contact_time: float  # s per period
    longest_flight: float  # excitation cycles

    @property
    def stable(self) -> bool:
        """Whether both multipliers lie inside the unit circle."""
        return abs(self.multipliers[0]) < 1.0


def with_amplitude(parameters: np.ndarray, acceleration: float) -> np.ndarray:
    """Packed parameters, shape (16,), with another amplitude (m/s²)."""
    row = parameters.copy()
    row[ACCELERATION] = acceleration
    return row


class ReturnMap:
    """The n-th power of the stroboscopic map and its fixed points, in scaled unknowns u = (δ, Y, â).

    The units are g/ω² (m), g/ω (m/s) and 1 m/s², which makes the three comparable. A map that fails gives NaN.
    """

    def __init__(self, parameters: np.ndarray, period: int):
        self.parameters = parameters = as_rows(parameters).copy()
        self.period = period
        self.constants = contact.constants(parameters, ORBIT_TOLERANCE)
        self.unit = np.array([*length_and_speed_units(parameters), 1.0])

    def scaled(self, acceleration: float, state: np.ndarray) -> np.ndarray:
        """The unknowns of a state (δ in m, v in m/s) at an amplitude."""
        return (
            np.array([state[0], contact_law.smooth_speed(self.constants, state[0], state[1]), acceleration]) / self.unit
        )

    def state(self, unknown: np.ndarray) -> np.ndarray:
        """The state (δ in m, v in m/s) of unknowns."""
        delta, y, _ = unknown * self.unit
        return np.array([delta, contact_law.speed_of_approach(self.constants, delta, y)])

    def strobes(self, unknown: np.ndarray) -> np.ndarray:
        """Unknowns after 1 … n cycles, shape (n, 3)."""
        row = with_amplitude(self.parameters, unknown[2])
        _, states, _ = stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, self.state(unknown), self.period)
        return np.array([self.scaled(unknown[2], state) for state in states])

    def linearised(self, unknown: np.ndarray, airborne: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(δ, Y) after n cycles in their units, the matrices (SI units) and the features of all cycles.

        airborne : time since the last separation, s
        """
        row, state = with_amplitude(self.parameters, unknown[2]), self.state(unknown)
        status, matrices, features = stroboscopic_map.monodromy(row, ORBIT_TOLERANCE, state, self.period, airborne)
        if status != OK:
            return np.full(2, np.nan), np.full((self.period, 2, 2), np.nan), features
        return self.scaled(unknown[2], state)[:2], matrices, features

    def residual(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P(X) - X, shape (2,), and its derivative by (δ, Y), shape (2, 2), scaled."""
        image, matrices, _ = self.linearised(unknown)
        matrix = linear_algebra.chain(matrices)
        return image - unknown[:2], matrix * self.unit[:2] / self.unit[:2, None] - np.eye(2)

    def slope(self, unknown: np.ndarray) -> np.ndarray:
        """Derivative of P by â, scaled, shape (2,)."""
        ahead = np.array([0.0, 0.0, AMPLITUDE_STEP])
        return (self.strobes(unknown + ahead)[-1, :2] - self.strobes(unknown - ahead)[-1, :2]) / (2.0 * AMPLITUDE_STEP)

    def system(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P(X) - X, shape (2,), and its derivative by (δ, Y, â), shape (2, 3), scaled."""
        residual, jacobian = self.residual(unknown)
        return residual, np.column_stack([jacobian, self.slope(unknown)])

    def newton(self, guess: np.ndarray) -> np.ndarray | None:
        """The fixed point that Newton's iteration at constant â finds from a guess, or None."""
        # Steps of a long unstable orbit end in round-off, which it amplifies.
        limits = {"converged": CONVERGED, "iterations": 30, "largest": 1e3, "stagnant": STAGNANT}
        solved = newton(lambda state: self.residual(np.append(state, guess[2])), guess[:2], **limits)
        return None if solved is None else np.append(solved, guess[2])

    def correct(self, guess: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """The fixed point in the plane through `guess` normal to `direction`, a unit vector, or None."""
        return newton(self.system, guess, direction, converged=CONVERGED, iterations=10, farthest=10.0)

    def tangent(self, unknown: np.ndarray, previous: np.ndarray) -> np.ndarray:
        """Unit vector along the branch through a fixed point, pointing on from `previous`."""
        vector = np.cross(*self.system(unknown)[1])
        vector /= linear_algebra.length(vector)
        return vector if linear_algebra.dot(vector, previous) >= 0.0 else -vector

    def halving(self, unknown: np.ndarray) -> np.ndarray:
        """Distance to the point half a period later, shape (3,): it passes zero where the orbit's period halves."""
        return self.strobes(unknown)[self.period // 2 - 1] - unknown

    def describe(self, unknown: np.ndarray) -> Orbit:
        """The Orbit of a fixed point."""
        _, _, features = self.linearised(unknown)
        # The period may begin in the flight in which it ends.
        _, matrices, features = self.linearised(unknown, features[-1, stroboscopic_map.AIRBORNE])
        matrix = linear_algebra.chain(matrices)
        # The trace formula of the flow gives determinants that are lost in rounding.
        hidden = [stroboscopic_map.hides_determinant(one) for one in matrices]
        contractions = np.exp(contact_law.log_contraction(self.constants, features[:, stroboscopic_map.DAMPER_TIME]))
        determinants = np.where(hidden, contractions, linear_algebra.determinant(matrices))
        trace, determinant = float(np.trace(matrix)), float(np.prod(determinants))
        root = cmath.sqrt(0.25 * trace * trace - determinant)
        first = max(0.5 * trace + root, 0.5 * trace - root, key=abs)
        second = determinant / first if first != 0.0 else 0.0j
        flights = features[:, stroboscopic_map.LONGEST_FLIGHT]
        return Orbit(
            acceleration=float(unknown[2]),
            state=self.state(unknown),
            period=self.period,
            multipliers=(first, second),
            determinant=determinant,
            impacts=int(features[:, stroboscopic_map.IMPACTS].sum()),
            contact_time=float(features[:, stroboscopic_map.CONTACT_TIME].sum()),
            longest_flight=float(flights.max() / (1.0 / self.parameters[FREQUENCY])),
        )


def find_orbit(parameters: np.ndarray, acceleration: float, state: np.ndarray, period: int) -> Orbit | None:
    """The orbit of `period` cycles that Newton's iteration finds from `state`, or None.

    An orbit whose period divides `period` is an orbit of `period` cycles, too.

    Parameters
    ----------
    parameters : a row of a table; its amplitude is ignored
    acceleration : amplitude, m/s²
    state : δ (m) and v (m/s) at the phase ψ0, shape (2,)
    period : excitation cycles

    Examples
    --------
    >>> orbit = find_orbit(parameter_table(Conveyor()), 40.0, np.array([-5.5e-4, 0.02]), 1)
    >>> orbit.stable, orbit.impacts, round(abs(orbit.multipliers[0]), 4)
    (True, 1, 0.7254)
    """
    (parameters,), _ = check_rows(parameters)
    acceleration = check_number("acceleration", acceleration, *RANGES["acceleration"], "m/s²")
    check_count("period", period, 1, LONGEST_PERIOD)
    state = check_array("state", state, -LARGEST_COORDINATE, LARGEST_COORDINATE)
    if state.shape != (2,):
        raise ValueError(f"state must be δ (m) and v (m/s), got the shape {state.shape}")
    return orbit_near(parameters, acceleration, state, period)


def orbit_near(parameters: np.ndarray, acceleration: float, state: np.ndarray, period: int) -> Orbit | None:
    """`find_orbit` without checks of its arguments; None, too, for arguments that are not finite."""
    returns = ReturnMap(parameters, period)
    unknown = returns.newton(returns.scaled(acceleration, state))
    return None if unknown is None else returns.describe(unknown)


def settled_orbit(
    parameters: np.ndarray, acceleration: float, state: np.ndarray, periods: Iterable[int], cycles: int
) -> Orbit | None:
    """The stable orbit that a trajectory from `state` ends in, or None.

    Parameters
    ----------
    parameters : a row of a table; its amplitude is ignored
    acceleration : amplitude, m/s²
    state : δ (m) and v (m/s)
    periods : the periods to try, in this order
    cycles : excitation cycles that bring the trajectory near its orbit; Newton's iteration does the rest

    Examples
    --------
    >>> row = parameter_table(Conveyor(), z0=3e-4)
    >>> orbit = settled_orbit(row, 57.0, initial_states(row[None], 1e-10)[0], periods=(1, 2), cycles=1000)
    >>> orbit.period, orbit.stable
    (2, True)
    """
    (parameters,), _ = check_rows(parameters)
    row, end = with_amplitude(parameters, acceleration), np.array(state, dtype=np.float64)
    status, strobes, _ = stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, end, cycles)
    if status != OK:
        return None
    unit = np.array(length_and_speed_units(parameters))
    for period in periods:
        if np.abs((strobes[-1] - strobes[-1 - period]) / unit).max() < 1e-2:
            orbit = orbit_near(parameters, acceleration, end, period)
            if orbit is not None and orbit.stable and np.abs((orbit.state - end) / unit).max() < 0.1:
                return orbit
    return None
