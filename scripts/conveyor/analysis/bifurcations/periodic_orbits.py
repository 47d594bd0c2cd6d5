"""Periodic orbits: Newton's iteration on the stroboscopic map, and Floquet multipliers.

An orbit of period n is a fixed point of the n-th power of the stroboscopic map in (δ, Y) (see stroboscopic_map).
"""

import cmath
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ... import linear_algebra
from ...arguments import MOST_CYCLES, check_count, check_states, check_type
from ...packing import AT_REST, as_rows, as_table, check_row
from ...parameters import PARAMETERS
from ...solver import contact, contact_law
from ...solver.model import FREQUENCY, Conveyor, Start, unpack
from ...solver.status import OK
from .. import stroboscopic_map
from ..dimensionless_groups import distance, length_and_speed_units
from .newton import newton

ORBIT_TOLERANCE = 1e-13
LONGEST_PERIOD = 1024  # excitation cycles
SAME_ORBIT = 1e-5  # orbits this close are one, in scaled unknowns
UNITS_IN_VALUE = 40.0  # units of a parameter's scale in its value: the paper's amplitude in m/s²
STEP = 1e-6  # of the central difference by the parameter, in its unit
CONVERGED = 1e-10  # of Newton's last correction, in scaled unknowns
STAGNANT = 1e-6  # corrections below this that no longer shrink are round-off


class Orbit(NamedTuple):
    """A periodic orbit of the vertical motion of one conveyor."""

    parameters: np.ndarray  # of the conveyor, a row of a table
    state: np.ndarray  # (δ in m, v in m/s) at the phase ψ0
    period: int  # excitation cycles; of an orbit from `periodic_orbit`, the least one
    multipliers: tuple[complex, complex]  # Floquet multipliers, the larger modulus first
    determinant: float  # their product, from the monodromy matrix, or from the trace formula where rounding hides it
    impacts: int  # per period
    contact_time: float  # s per period
    longest_flight: float  # excitation cycles

    @property
    def stable(self) -> bool:
        """Whether both multipliers lie inside the unit circle."""
        return abs(self.multipliers[0]) < 1.0

    @property
    def acceleration(self) -> float:
        """The amplitude, m/s²."""
        return self.value("acceleration")

    @property
    def conveyor(self) -> Conveyor:
        """The conveyor of the orbit."""
        return unpack(as_rows(self.parameters))[0]

    def value(self, parameter: str) -> float:
        """The value of a parameter of the conveyor."""
        return self.parameters[parameter].item()

    def __repr__(self) -> str:
        stability = "stable" if self.stable else "unstable"
        return f"Orbit({self.acceleration:.6g} m/s², period {self.period}, {stability}, {self.impacts} impacts)"


class ReturnMap:
    """The n-th power of the stroboscopic map and its fixed points, in scaled unknowns u = (δ, Y, λ).

    λ is a parameter of the conveyor, by default the amplitude. The units are g/ω² (m), g/ω (m/s) and 1 m/s², which
    makes the three comparable; the unit of any other parameter is a share of its value, of an inclination a share of
    1 rad. A map that fails gives NaN.
    """

    def __init__(self, parameters: np.ndarray, period: int, parameter: str = "acceleration"):
        self.parameters = parameters = as_rows(parameters).copy()
        self.period, self.parameter, self.column = period, parameter, PARAMETERS.index(parameter)
        scale = 1.0
        if parameter != "acceleration":
            value = 1.0 if parameter == "inclination" else abs(parameters[self.column])
            scale = (value or 1.0) / UNITS_IN_VALUE
        self.unit = np.array([*length_and_speed_units(parameters), scale])
        self.known = contact.constants(parameters, ORBIT_TOLERANCE)

    def row(self, value: float) -> np.ndarray:
        """Packed parameters, shape (16,), with a value of λ in its unit."""
        row = self.parameters.copy()
        row[self.column] = value * self.unit[2]
        return row

    def constants(self, value: float) -> contact.Constants:
        """The constants of the contact for a value of λ in its unit; the amplitude does not change those used here."""
        return self.known if self.parameter == "acceleration" else contact.constants(self.row(value), ORBIT_TOLERANCE)

    def scaled(self, value: float, state: np.ndarray) -> np.ndarray:
        """The unknowns of a state (δ in m, v in m/s) at a value of λ in SI units."""
        smooth = stroboscopic_map.smooth_state(self.constants(value / self.unit[2]), state)
        return np.append(smooth, value) / self.unit

    def unknown(self, orbit: Orbit) -> np.ndarray:
        """The unknowns of an Orbit."""
        return self.scaled(orbit.value(self.parameter), orbit.state)

    def state(self, unknown: np.ndarray) -> np.ndarray:
        """The state (δ in m, v in m/s) of unknowns."""
        return stroboscopic_map.state_of(self.constants(unknown[2]), unknown * self.unit)

    def strobes(self, unknown: np.ndarray) -> np.ndarray:
        """Unknowns after 1 … n cycles, shape (n, 3)."""
        row, value = self.row(unknown[2]), unknown[2] * self.unit[2]
        _, states = stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, self.state(unknown), self.period)
        known = self.constants(value / self.unit[2])  # once for all states, as in `scaled` for one
        return np.array([(*stroboscopic_map.smooth_state(known, state), value) for state in states]) / self.unit

    def linearised(self, unknown: np.ndarray, airborne: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(δ, Y) after n cycles in their units, the matrices (SI units) and the features of all cycles.

        airborne : time since the last separation, s
        """
        row, state = self.row(unknown[2]), self.state(unknown)
        status, matrices, features = stroboscopic_map.monodromy(row, ORBIT_TOLERANCE, state, self.period, airborne)
        if status != OK:
            return np.full(2, np.nan), np.full((self.period, 2, 2), np.nan), features
        return self.scaled(unknown[2] * self.unit[2], state)[:2], matrices, features

    def residual(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P(X) - X, shape (2,), and its derivative by (δ, Y), shape (2, 2), scaled."""
        image, matrices, _ = self.linearised(unknown)
        matrix = linear_algebra.chain(matrices)
        return image - unknown[:2], matrix * self.unit[:2] / self.unit[:2, None] - np.eye(2)

    def slope(self, unknown: np.ndarray) -> np.ndarray:
        """Derivative of P by λ, scaled, shape (2,)."""
        ahead = np.array([0.0, 0.0, STEP])
        return (self.strobes(unknown + ahead)[-1, :2] - self.strobes(unknown - ahead)[-1, :2]) / (2.0 * STEP)

    def system(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """P(X) - X, shape (2,), and its derivative by (δ, Y, λ), shape (2, 3), scaled."""
        residual, jacobian = self.residual(unknown)
        return residual, np.column_stack([jacobian, self.slope(unknown)])

    def newton(self, guess: np.ndarray) -> np.ndarray | None:
        """The fixed point that Newton's iteration at constant λ finds from a guess, or None."""
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
        row, constants = self.row(unknown[2]), self.constants(unknown[2])
        contractions = np.exp(contact_law.log_contraction(constants, features[:, stroboscopic_map.DAMPER_TIME]))
        determinants = np.where(hidden, contractions, linear_algebra.determinant(matrices))
        trace, determinant = float(np.trace(matrix)), float(np.prod(determinants))
        root = cmath.sqrt(0.25 * trace * trace - determinant)
        first = max(0.5 * trace + root, 0.5 * trace - root, key=abs)
        second = determinant / first if first != 0.0 else 0.0j
        flights = features[:, stroboscopic_map.LONGEST_FLIGHT]
        return Orbit(
            parameters=as_table(row),
            state=self.state(unknown),
            period=self.period,
            multipliers=(first, second),
            determinant=determinant,
            impacts=int(features[:, stroboscopic_map.IMPACTS].sum()),
            contact_time=float(features[:, stroboscopic_map.CONTACT_TIME].sum()),
            longest_flight=float(flights.max() / (1.0 / row[FREQUENCY])),
        )


def orbit_near(row: np.ndarray, state: np.ndarray, period: int) -> Orbit | None:
    """The orbit of `period` cycles that Newton's iteration finds from a state (δ in m, v in m/s), or None.

    An orbit whose period divides `period` is an orbit of `period` cycles, too.

    row : of a table, or packed, shape (16,)
    """
    returns = ReturnMap(row, period)
    unknown = returns.newton(returns.scaled(float(returns.parameters[returns.column]), state))
    return None if unknown is None else returns.describe(unknown)


def settled_orbit(row: np.ndarray, state: np.ndarray, periods: Iterable[int], cycles: int) -> Orbit | None:
    """The stable orbit that a trajectory ends in, the first of some `periods`, or None; arguments as in `orbit_near`.

    cycles : excitation cycles that bring the trajectory near its orbit; Newton's iteration does the rest
    """
    row, end = as_rows(row), np.array(state, dtype=np.float64)
    status, strobes = stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, end, cycles)
    if status != OK:
        return None
    for period in periods:
        if period < cycles and distance(row, strobes[-1 - period], strobes[-1]) < 1e-2:
            orbit = orbit_near(row, end, period)
            if orbit is not None and orbit.stable and distance(row, end, orbit.state) < 0.1:
                return orbit
    return None


def check_orbit(orbit: object) -> None:
    """TypeError or ValueError unless the argument `orbit` is an Orbit of its conveyor."""
    check_type("orbit", orbit, Orbit)
    check_row("orbit.parameters", orbit.parameters)
    check_count("orbit.period", orbit.period, 1, LONGEST_PERIOD)
    check_count("orbit.impacts", orbit.impacts, 0, LONGEST_PERIOD * MOST_CYCLES)
    if np.shape(orbit.multipliers) != (2,) or np.asarray(orbit.multipliers).dtype.kind not in "iufc":
        raise ValueError(f"orbit.multipliers must be two numbers, got {orbit.multipliers!r}")
    check_states("orbit.state", orbit.state, (2,))
    returns = ReturnMap(orbit.parameters, orbit.period)
    given = returns.unknown(orbit)
    solved = returns.newton(given)
    if solved is None or not linear_algebra.length(solved - given) < SAME_ORBIT:
        raise ValueError("orbit is no orbit of its conveyor; find one with periodic_orbit")


def least_period(orbit: Orbit) -> int:
    """The number of cycles after which an orbit is first back, a divisor of its period."""
    returns = ReturnMap(orbit.parameters, orbit.period)
    unknown = returns.unknown(orbit)
    distances = linear_algebra.length(returns.strobes(unknown) - unknown)
    divisors = (n for n in range(1, orbit.period) if orbit.period % n == 0)
    return next((n for n in divisors if distances[n - 1] < SAME_ORBIT), orbit.period)


def periodic_orbit(
    conveyor: Conveyor | np.ndarray,
    start: Start | ArrayLike = AT_REST,
    *,
    period: int | Iterable[int] = 1,
    transient: int = 1000,
) -> Orbit | None:
    """A periodic orbit of the vertical motion, from the end of a trajectory.

    Parameters
    ----------
    conveyor : a Conveyor, or a row of a table, whose initial condition is the default of `start`
    start : where the trajectory begins: a Start, or a state (δ in m, v in m/s) at the phase ψ0, shape (2,)
    period : excitation cycles, 1 to 1024. Newton's iteration looks for an orbit with one period, which may be unstable.
        With several periods, such as range(1, 9), the trajectory must end in a stable orbit with one of them
    transient : excitation cycles of the trajectory, up to 1e6; 0 begins Newton's iteration at `start`, which unstable
        orbits need

    Returns
    -------
    Orbit with its Floquet multipliers, at the phase ψ0, with its least period; None where there is none

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=40.0), Start(z=3e-4))
    >>> orbit.impacts, orbit.stable, round(abs(orbit.multipliers[0]), 4)
    (1, True, 0.7254)
    >>> periodic_orbit(Conveyor(acceleration=57.0), Start(z=3e-4), period=range(1, 9))
    Orbit(57 m/s², period 2, stable, 2 impacts)
    """
    transient = check_count("transient", transient, 0, MOST_CYCLES)
    several = np.iterable(period) and not isinstance(period, str)
    periods = [check_count("period", one, 1, LONGEST_PERIOD) for one in (period if several else [period])]
    if not periods:
        raise ValueError(f"period = {period!r} has no period to look for")
    if isinstance(start, Start):
        row = check_row("conveyor", conveyor, start)
        (state,) = stroboscopic_map.initial_states(row[None], ORBIT_TOLERANCE)
    else:
        row = check_row("conveyor", conveyor)
        state = check_states("start", start, (2,))
    if several:
        return settled_orbit(row, state, periods, transient)
    stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, state, transient)
    orbit = orbit_near(row, state, *periods)
    if orbit is not None and (least := least_period(orbit)) < orbit.period:
        orbit = orbit_near(row, orbit.state, least)
    return orbit
