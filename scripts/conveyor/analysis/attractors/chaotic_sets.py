"""The chaotic attractors of a conveyor, as the boxes of the stroboscopic plane that long trajectories visit.

A trajectory that stays in these boxes and their neighbours for many cycles in a row has reached the same attractor.
"""

import numpy as np

from ..chaos import lyapunov
from . import sampling
from .attractor_table import BOXES, NO_ATTRACTORS, ChaoticSets, append_row, concatenate
from .convergence import NOT_CONVERGED, PERIODIC, Trajectories

LATE = 0.1  # share of the cycles; chaos is only a transient if a trajectory becomes periodic later
MOST = 4  # chaotic sets of one conveyor


def cover_by_boxes(strobes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lower corner and size of a box, shape (2,), and the boxes that a motion visits, with their neighbours."""
    low, high = strobes.min(axis=0), strobes.max(axis=0)
    size = (high - low) / (BOXES - 3)  # leaves an empty box on either side
    low = low - size
    places = ((strobes - low) / size).astype(np.int64)
    near = np.zeros((BOXES, BOXES), dtype=np.bool_)
    near[places[:, 0], places[:, 1]] = True
    for along in (near, near.T):
        along[1:] |= along[:-1]
        along[:-1] |= along[1:]
    return low, size, near


def find_chaotic_sets(
    conveyors: np.ndarray, sampled: list[Trajectories], cycles: int, tolerance: float, *, max_cycles: int
) -> list[ChaoticSets]:
    """The chaotic sets of conveyors, shape (n, 16), from motions that do not converge within twice `cycles`.

    A conveyor on which a trajectory becomes periodic late has no chaotic sets: chaos is a transient there, and every
    trajectory must be followed to its own end. Trajectories of one conveyor run one after the other, and trajectories
    of several conveyors side by side. On each conveyor, no new trajectory begins after `max_cycles` in all.
    """
    candidates = [list(trajectories.states[trajectories.outcomes == NOT_CONVERGED]) for trajectories in sampled]
    chaotic_sets, spent = [NO_ATTRACTORS.chaotic] * len(conveyors), np.zeros(len(conveyors), dtype=np.int64)

    def search(rows: list[int], states: np.ndarray, length: int, strobes: np.ndarray | None = None) -> Trajectories:
        attractors = concatenate([NO_ATTRACTORS, *(NO_ATTRACTORS._replace(chaotic=chaotic_sets[k]) for k in rows)])
        motions = sampling.follow(conveyors[rows], states, length, tolerance, attractors, strobes)
        spent[rows] += motions.followed
        return motions

    while rows := [k for k, states in enumerate(candidates) if states and spent[k] < max_cycles]:
        rows = np.array(rows)
        states = np.array([candidates[k].pop(0) for k in rows])
        # A few cycles are enough to leave out motions that stay in a known set, or that do not stretch.
        goes_on = search(rows, states, sampling.SHORT_SEARCH).outcomes == NOT_CONVERGED
        rows, states = rows[goes_on], states[goes_on]
        early = lyapunov.spectrum_from(conveyors[rows], states, sampling.SHORT_SEARCH, tolerance=tolerance)
        spent[rows] += sampling.SHORT_SEARCH
        goes_on = early.lambda_1 > 0.0
        rows, states, followed = rows[goes_on], states[goes_on], 0
        for record in (False, True):
            strobes = np.empty((len(rows), cycles, 2)) if record else None
            motions = search(rows, states, cycles, strobes)
            for k in rows[(motions.outcomes == PERIODIC) & (followed + motions.followed > LATE * cycles)]:
                chaotic_sets[k], candidates[k] = NO_ATTRACTORS.chaotic, []
            goes_on = motions.outcomes == NOT_CONVERGED
            rows, states, followed = rows[goes_on], motions.states[goes_on], cycles
        spent[rows] += sum(lyapunov.LOOKS)
        stretches = lyapunov.signs(conveyors[rows], states, tolerance=tolerance) > 0
        for k, visited in zip(rows[stretches], strobes[goes_on][stretches], strict=True):
            if len(chaotic_sets[k].low) < MOST:
                chaotic_sets[k] = append_row(chaotic_sets[k], conveyors[k], *cover_by_boxes(visited))
    return chaotic_sets
