"""Sampled initial conditions of a conveyor, and the attractors that they lead to.

The samples depend only on the conveyor. The attractors that are found therefore do not depend on the caller.
"""

import math

import numpy as np

from ...packing import as_rows
from ...solver import contact
from .. import stroboscopic_map
from . import convergence_lanes
from .attractor_table import NO_ATTRACTORS, AttractorTable
from .convergence import Trajectories

SAMPLES = 32
SHORT_SEARCH = 400  # cycles; most trajectories that do not end in chaos become periodic within them


def sampled_initial_conditions(parameters: np.ndarray, count: int = SAMPLES) -> np.ndarray:
    """Initial conditions of one conveyor, a row of a table: δ (m) and v (m/s), shape (count, 2).

    The parts are in the air while the plate is at its highest point. To jump over one or two cycles a part leaves the
    plate with about the plate's speed plus half of g T at most. This sum bounds the velocities, and the height that a
    part reaches with it bounds the heights. The points are an R2 sequence (Roberts 2018).

    Examples
    --------
    >>> states = sampled_initial_conditions(parameter_table(Conveyor()))
    >>> states.shape, bool((states[:, 0] <= 0.0).all())
    ((32, 2), True)
    """
    c = contact.constants(as_rows(parameters), 1e-8)
    fastest = math.pi * (c.gravity + c.bounds.lift) / c.omega
    highest = 0.5 * fastest * fastest / c.gravity
    golden = 1.324717957244746  # the real root of x³ = x + 1
    share = np.modf(np.arange(1, count + 1)[:, None] * np.array([1.0 / golden, 1.0 / golden**2]))[0]
    return np.column_stack([-highest * share[:, 0], fastest * (2.0 * share[:, 1] - 1.0)])


def follow(
    parameters: np.ndarray,
    states: np.ndarray,
    cycles: int,
    tolerance: float,
    attractors: AttractorTable = NO_ATTRACTORS,
    strobes: np.ndarray | None = None,
) -> Trajectories:
    """Follow a trajectory on each of n conveyors, shape (n, 16), to its attractor, for at most `cycles`.

    states : float64, shape (n, 2), δ (m), v (m/s) at pieces.BEGIN_OF_CYCLE
    strobes : float64, shape (n, cycles, 2), filled with the states after each cycle
    """
    rows = stroboscopic_map.pack_states(stroboscopic_map.begin_at_top(parameters), states, tolerance)
    table_rows = attractors.rows_of(rows)
    return convergence_lanes.follow_all_to_attractors(rows, tolerance, cycles, attractors, table_rows, strobes)


def sample_conveyors(conveyors: np.ndarray, cycles: int, tolerance: float) -> list[Trajectories]:
    """The trajectories of each of n conveyors, shape (n, 16), from its sampled initial conditions, for some cycles."""
    states = np.concatenate([sampled_initial_conditions(row) for row in conveyors])
    trajectories = follow(np.repeat(conveyors, SAMPLES, axis=0), states, cycles, tolerance)
    return [
        Trajectories(*(column[begin : begin + SAMPLES] for column in trajectories))
        for begin in range(0, len(states), SAMPLES)
    ]
