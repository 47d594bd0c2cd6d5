"""What motions a conveyor has: some starts that spread over all that a part may do, and where they lead.

Which ones they are depends on the conveyor alone, so that every start finds the same, whoever else asks.
"""

import math
from typing import NamedTuple

import numpy as np

from ..solver import contact
from ..solver.jit import kernel
from .known import NOTHING, KnownAttractors
from .settling import settle

STARTS = 32
SETTLING = 400  # cycles within which a start that leads elsewhere than to chaos has mostly settled


class Probes(NamedTuple):
    """Motions of one conveyor; every field is of length n."""

    states: np.ndarray  # float64, shape (n, 2), δ (m), v (m/s) at trajectory.BEGIN_OF_CYCLE, at the end of the search
    outcomes: np.ndarray  # int64, what ended it: settling.SETTLED, …
    periods: np.ndarray  # int64, excitation cycles
    flights: np.ndarray  # float64, s, longest flight
    followed: np.ndarray  # int64, excitation cycles


def starts(parameters: np.ndarray) -> np.ndarray:
    """Starts of one conveyor, shape (13,): (δ, v) in the air at the plate's top, shape (STARTS, 2).

    A part that leaves the plate has at most its speed and half of g T or so to jump over a cycle or two: their sum
    bounds the velocities, and what a part reaches with it the heights. The points are those of an R2 sequence.
    """
    c = contact.constants(parameters, 1e-8)
    fastest = math.pi * (c.gravity + c.a_z) / c.omega
    highest = 0.5 * fastest * fastest / c.gravity
    golden = 1.324717957244746  # the real root of x³ = x + 1
    share = np.modf(np.arange(1, STARTS + 1)[:, None] * np.array([1.0 / golden, 1.0 / golden**2]))[0]
    return np.column_stack([-highest * share[:, 0], fastest * (2.0 * share[:, 1] - 1.0)])


@kernel
def settle_all(parameters, tolerance, cycles, known, mine, strobes, states, outcomes, periods, flights, followed):
    """`settle` from each of `states`, shape (n, 2), on one conveyor; the other fields of Probes are filled."""
    series = contact.workspace()
    c = contact.constants(parameters, tolerance)
    for i in range(states.shape[0]):
        outcomes[i], periods[i], flights[i], followed[i] = settle(c, series, states[i], cycles, known, mine, strobes)


def follow(
    parameters: np.ndarray,
    states: np.ndarray,
    cycles: int,
    tolerance: float,
    known: KnownAttractors = NOTHING,
    strobes: np.ndarray | None = None,
) -> Probes:
    """Follow motions of one conveyor, shape (13,), from `states`, shape (n, 2), until they settle, at most `cycles`.

    known : of this conveyor alone
    strobes : float64, shape (cycles, 2), filled with the states of the last motion after each cycle
    """
    n = len(states)
    found = Probes(np.array(states), *(np.zeros(n, kind) for kind in (np.int64, np.int64, np.float64, np.int64)))
    mine = np.array([0, len(known.orbits.periods), 0, len(known.chaotic.low)])
    strobes = np.empty((0, 2)) if strobes is None else strobes
    settle_all(parameters, tolerance, cycles, known, mine, strobes, *found)
    return found
