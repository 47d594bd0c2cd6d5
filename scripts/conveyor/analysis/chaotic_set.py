"""Where the chaotic attractors of a conveyor lie: boxes of the stroboscopic plane that their motions visit.

Long trajectories visit them. Another start that stays within them and their neighbours for many cycles in a row has
come to the same attractor.
"""

import numpy as np
from scipy.ndimage import binary_dilation

from . import lyapunov, probes
from .known import BOXES, NOTHING, ChaoticSets, chaotic_sets_of
from .probes import Probes
from .settling import OPEN, SETTLED

LATE = 0.1  # of the time: a start that settles later shows that chaos is a long transient here
MOST = 4  # chaotic sets of one conveyor
SIGNIFICANT = 3.0  # standard errors by which the exponent of chaos exceeds zero
LENGTHS = (probes.SETTLING, 2000)  # excitation cycles over which an exponent is found: where chaos is weak, the longer


def boxes_of(strobes: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lower corner, shape (2,), size of a box, shape (2,), and which boxes are visited or next to one, for a motion."""
    low, high = strobes.min(axis=0), strobes.max(axis=0)
    size = (high - low) / (BOXES - 3)  # an empty one on either side
    low = low - size
    places = ((strobes - low) / size).astype(np.int64)
    visited = np.zeros((BOXES, BOXES), dtype=np.bool_)
    visited[places[:, 0], places[:, 1]] = True
    return low, size, binary_dilation(visited, np.ones((3, 3), dtype=np.bool_))


def exponents(parameters: np.ndarray, states: np.ndarray, cycles: int, tolerance: float) -> lyapunov.Spectrum:
    """Exponents of trajectories of one conveyor, shape (13,), from `states`, shape (n, 2), at the plate's top."""
    rows = np.repeat(parameters[None], len(states), axis=0)
    return lyapunov.spectrum(
        rows, states, begin_of_cycle=True, transient=0, cycles=cycles // 20, blocks=20, tolerance=tolerance
    )


def sets_of_conveyor(parameters: np.ndarray, probed: Probes, cycles: int, tolerance: float) -> ChaoticSets:
    """The chaotic sets of one conveyor, shape (13,): of motions that do not settle within twice `cycles`.

    None if a start settles late: then chaos is a transient, and every start has to be followed to its own end.
    """
    nothing = known = chaotic_sets_of(parameters, [])
    for start in probed.states[probed.outcomes == OPEN]:
        # What is told in few cycles comes first: motions that stay in a set that is known, or do not stretch.
        soon = probes.follow(parameters, start[None], probes.SETTLING, tolerance, NOTHING._replace(chaotic=known))
        if (
            soon.outcomes[0] != OPEN
            or exponents(parameters, start[None], probes.SETTLING, tolerance).lambda_1[0] <= 0.0
        ):
            continue
        state, followed = start[None], 0
        for strobes in (None, np.empty((cycles, 2))):
            motion = probes.follow(parameters, state, cycles, tolerance, NOTHING._replace(chaotic=known), strobes)
            state, followed = motion.states, followed + motion.followed[0]
            if motion.outcomes[0] != OPEN:
                break
        if motion.outcomes[0] == SETTLED and followed > LATE * cycles:
            return nothing
        if motion.outcomes[0] == OPEN and len(known.low) < MOST:
            last = (exponents(parameters, state, length, tolerance) for length in LENGTHS)
            if any(one.lambda_1[0] > SIGNIFICANT * one.stderr[0] for one in last):
                known = chaotic_sets_of(
                    parameters, [*zip(known.low, known.size, known.cells, strict=True), boxes_of(strobes)]
                )
    return known
