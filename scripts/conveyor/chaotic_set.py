"""Where the chaotic attractors of a conveyor lie: boxes of the stroboscopic plane that their motions visit.

Long trajectories visit them. Another start that stays within them and their neighbours for many cycles in a row has
come to the same attractor. Which trajectories are followed depends on the conveyor alone, so that every start finds the
same boxes, whoever else asks.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_dilation

from . import contact, lyapunov
from .jit import kernel
from .model import PARAMETERS, PSI0, VZ0, Z0
from .parallel import for_each_chunk
from .settling import OPEN, SETTLED, settle

BOXES = 256  # along each axis
STARTS = 32  # from which chaotic motions are looked for
SETTLING = 400  # cycles within which a start that leads elsewhere has mostly settled
LATE = 0.1  # of the time: a start that settles later shows that chaos is a long transient here
MOST = 4  # chaotic sets of one conveyor
SIGNIFICANT = 3.0  # standard errors by which the exponent of chaos exceeds zero


class ChaoticSets(NamedTuple):
    """The m chaotic sets of some conveyors, those of one conveyor side by side."""

    conveyors: np.ndarray  # float64, shape (m, 13), packed, sorted, their phases and starts zero
    low: np.ndarray  # float64, shape (m, 2), lower corner of the boxes: δ (m), v (m/s) at trajectory.BEGIN_OF_CYCLE
    size: np.ndarray  # float64, shape (m, 2), of a box
    cells: np.ndarray  # bool, shape (m, BOXES, BOXES): visited, or next to one that is

    def of(self, parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First set, and that behind the last one, of each row of `parameters`, shape (n, 13): int64, shape (n,)."""
        first, behind = {}, {}
        for k, row in enumerate(self.conveyors):
            first.setdefault(row.tobytes(), k)
            behind[row.tobytes()] = k + 1
        keys = [row.tobytes() for row in without_starts(parameters)]
        return tuple(np.array([places.get(key, 0) for key in keys], dtype=np.int64) for places in (first, behind))


def chaotic_sets_of(conveyors: np.ndarray, boxes: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> ChaoticSets:
    """Sets from the conveyor and the `boxes_of` each, also from none."""
    low, size, cells = zip(*boxes, strict=True) if boxes else ((), (), ())
    return ChaoticSets(
        np.asarray(conveyors, dtype=np.float64).reshape(-1, len(PARAMETERS)),
        np.asarray(low, dtype=np.float64).reshape(-1, 2),
        np.asarray(size, dtype=np.float64).reshape(-1, 2),
        np.asarray(cells, dtype=np.bool_).reshape(-1, BOXES, BOXES),
    )


def without_starts(parameters: np.ndarray) -> np.ndarray:
    """The conveyors of rows, shape (n, 13): ψ0 only shifts the phase at which one looks, the start is no part of it."""
    conveyors = np.array(parameters, dtype=np.float64)
    conveyors[:, [PSI0, Z0, VZ0]] = 0.0
    return conveyors


def probes(parameters: np.ndarray) -> np.ndarray:
    """Starts that spread over what a part of one conveyor may do: (δ, v) in the air at the plate's top, shape (n, 2).

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
def settle_starts(parameters, tolerance, starts, cycles, low, size, cells, strobes, outcomes, followed):
    """Follow `starts`, shape (n, 2), of one conveyor by at most `cycles`; they are advanced.

    low, size, cells : chaotic sets of this conveyor
    strobes : float64, shape (cycles, 2) or (0, 2), filled with the motion of the last start
    outcomes, followed : int64, shape (n,), filled with what ends each search and after how many cycles
    """
    series = contact.workspace()
    c = contact.constants(parameters, tolerance)
    for i in range(starts.shape[0]):
        outcomes[i], _, _, followed[i] = settle(
            c, series, starts[i], cycles, low, size, cells, 0, cells.shape[0], strobes
        )


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


def sets_of_conveyor(parameters: np.ndarray, cycles: int, tolerance: float) -> ChaoticSets:
    """The chaotic sets of one conveyor, shape (13,): of motions that do not settle within twice `cycles`.

    None if a start settles late: then chaos is a transient, and every start has to be followed to its own end.
    """
    known = chaotic_sets_of([], [])

    def follow(starts, most, strobes):
        outcomes, followed = np.empty(len(starts), dtype=np.int64), np.empty(len(starts), dtype=np.int64)
        settle_starts(
            parameters, tolerance, starts, most, known.low, known.size, known.cells, strobes, outcomes, followed
        )
        return outcomes, followed

    starts, no_strobes = probes(parameters), np.empty((0, 2))
    outcomes, _ = follow(starts, min(SETTLING, cycles), no_strobes)
    starts = starts[outcomes == OPEN]
    stretching = exponents(parameters, starts, SETTLING, tolerance).lambda_1 if len(starts) else np.empty(0)
    order = np.argsort(-stretching, kind="stable")
    for start in starts[order[stretching[order] > 0.0]]:
        state = start[None].copy()
        for strobes in (no_strobes, np.empty((cycles, 2))):
            (outcome,), (followed,) = follow(state, cycles, strobes)
            if outcome != OPEN:
                break
        if outcome == SETTLED and followed > LATE * cycles:
            return chaotic_sets_of([], [])
        if outcome == OPEN:
            last = exponents(parameters, state, 2000, tolerance)
            if last.lambda_1[0] > SIGNIFICANT * last.stderr[0] and len(known.low) < MOST:
                boxes = [*zip(known.low, known.size, known.cells, strict=True), boxes_of(strobes)]
                known = chaotic_sets_of([parameters] * len(boxes), boxes)
    return known


def chaotic_sets(
    parameters: np.ndarray, *, cycles: int, tolerance: float = 1e-8, threads: int = 1, progress: str | None = None
) -> ChaoticSets:
    """The chaotic sets of the conveyors in `parameters`, shape (n, 13), whatever their starts are.

    Parameters
    ----------
    cycles : excitation cycles after which a motion that has not settled is followed no further, as in states.classify
    tolerance, threads, progress : as in sweep.run
    """
    conveyors = np.unique(without_starts(parameters), axis=0)
    found = [chaotic_sets_of([], [])] * len(conveyors)

    def work(begin, end):
        for k in range(begin, end):
            found[k] = sets_of_conveyor(conveyors[k], cycles, tolerance)

    for_each_chunk(work, len(conveyors), threads=threads, chunk=1, progress=progress)
    boxes = [one for sets in found for one in zip(sets.low, sets.size, sets.cells, strict=True)]
    return chaotic_sets_of([row for sets in found for row in sets.conveyors], boxes)
