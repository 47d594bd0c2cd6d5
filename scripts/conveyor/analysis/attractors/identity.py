"""The attractors of one conveyor with what distinguishes them, and which of them a trajectory has reached."""

from typing import NamedTuple

import numpy as np

from ...columns import Columns
from ...solver import contact
from .. import stroboscopic_map
from ..bifurcations.periodic_orbits import ORBIT_TOLERANCE, Orbit, orbit_near
from ..dimensionless_groups import distance
from .attractor_table import AttractorTable
from .convergence import find_reached

CLOSE = 1e-3  # states this close, in g/ω² and g/ω, belong to one orbit
UNKNOWN = -1  # the number of an attractor that no sampled initial condition leads to


class Attractor(NamedTuple):
    """An attractor of a conveyor."""

    state: str  # first, second, chaos or undecided
    period: int  # excitation cycles; 0 for none
    orbit: Orbit | None  # with its multipliers, at the beginning of a cycle; None if Newton's iteration finds none
    strobes: np.ndarray  # δ (m) and v (m/s) at the beginning of each cycle of a period, or one such state, shape (n, 2)
    mean_velocity: float = np.nan  # m/s, of feeding
    share: float = 0.0  # of the sampled initial conditions

    def __repr__(self) -> str:
        period = f"period {self.period}, " if self.period else ""
        return f"Attractor({self.state}, {period}share {self.share:.3g}, {self.mean_velocity:.4g} m/s)"


class Attractors(NamedTuple):
    """The attractors of a conveyor. Columns and arrays refer to them by their number in `found`.

    Orbits and chaotic sets of the table come first, in its order.
    """

    found: list[Attractor]
    conveyor: np.ndarray  # float64, shape (16,), packed, its phase and initial condition zero
    table: AttractorTable  # with which `classify` is fast

    @property
    def columns(self) -> Columns:
        """Columns of the shape (n,): state, period, share, mean_velocity (m/s), multiplier (modulus), delta, v."""
        found = {name: np.array([getattr(attractor, name) for attractor in self.found]) for name in ("period", "share")}
        moduli = [abs(attractor.orbit.multipliers[0]) if attractor.orbit else np.nan for attractor in self.found]
        delta, v = np.array([attractor.strobes[0] for attractor in self.found]).reshape(-1, 2).T
        found |= {
            "mean_velocity": np.array([attractor.mean_velocity for attractor in self.found]),
            "multiplier": np.array(moduli),
        }
        return Columns(
            {
                "state": np.array([attractor.state for attractor in self.found], dtype=object),
                **found,
                "delta": delta,
                "v": v,
            }
        )

    def __repr__(self) -> str:
        return "\n".join(map(repr, self.found))


def orbit_attractor(row: np.ndarray, label: str, period: int, state: np.ndarray) -> Attractor:
    """The attractor of a periodic motion from a state (δ in m, v in m/s) close to it at the beginning of a cycle.

    A motion that approaches its orbit slowly repeats itself although it is still far away: its steps sum up to the
    distance that is left.
    """
    row = stroboscopic_map.begin_at_top(row)
    orbit = orbit_near(row, state, period)
    if orbit is not None and orbit.stable:
        _, strobes = stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, np.array(state), period)
        remaining = 2.0 * distance(row, strobes[-1], np.array(state)) / (1.0 - abs(orbit.multipliers[0]))
        orbit = orbit if distance(row, orbit.state, state) < max(CLOSE, remaining) else None
    else:
        orbit = None
    start = np.array(state if orbit is None else orbit.state)
    _, strobes = stroboscopic_map.follow_map(row, ORBIT_TOLERANCE, start.copy(), period)
    return Attractor(label, period, orbit, np.vstack([start, strobes[:-1]]))


def identify(attractors: Attractors, labels: Columns) -> np.ndarray:
    """The number of the attractor of each label of its conveyor, int64, in the shape of the labels; or UNKNOWN.

    labels : from `classify`, with the table of the attractors
    """
    row, states = attractors.conveyor, np.stack([labels.delta, labels.v], axis=-1).reshape(-1, 2)
    state, period = labels.state.ravel(), labels.period.ravel()
    constants, numbers = contact.constants(row, ORBIT_TOLERANCE), np.empty(len(states), np.int64)
    find_reached(constants, states, period, state == "chaos", attractors.table, numbers)
    # All motions without a known chaotic set, or without a label, count as one attractor.
    others = np.flatnonzero(numbers == UNKNOWN)
    for k, attractor in enumerate(attractors.found):
        alike = others[(state[others] == attractor.state) & (period[others] == attractor.period)]
        if attractor.period:
            alike = alike[distance(row, states[alike], attractor.strobes) < CLOSE]
        numbers[alike] = k
    return numbers.reshape(labels.period.shape)
