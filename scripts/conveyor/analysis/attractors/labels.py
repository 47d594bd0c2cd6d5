"""Labels: the state of motion that a trajectory ends in, first (moves with the plate), second (jumps) or chaos.

A trajectory is followed from excitation cycle to excitation cycle until it repeats itself with a period of up to 64
cycles. The longest flight of the repeated motion tells the first state from the second. A trajectory that has not
repeated itself after a given number of cycles is chaos if its own largest Lyapunov exponent is positive, beyond its
standard error; otherwise it is a regular motion of a longer period, or `undecided`.

A label depends on nothing but the conveyor and the initial condition. Trajectories on one conveyor may share its known
attractors (see `search`): one that has come so near to a periodic orbit that it must end there, or into a chaotic set
to stay, need not be followed further.
"""

import math
from typing import NamedTuple

import numpy as np

from ...solver.model import FREQUENCY, PSI0, VZ0, Z0
from ...solver.parallel import for_each_chunk
from ..chaos import lyapunov
from . import settling_lanes
from .attractor_table import NO_ATTRACTORS, AttractorTable
from .settling import OPEN, SETTLED, STAYS

STATES = ("first", "second", "chaos", "undecided")
FIRST, SECOND, CHAOS, UNDECIDED = range(len(STATES))

# The second state spends most of a cycle in the air; micro-bounces of the first last a small part of it.
LONG_FLIGHT = 0.5
# Excitation cycles after which a trajectory that has not settled is followed no further.
CYCLES = 20_000
# Trajectories that a thread takes at a time: the last of them leave lanes idle.
TOGETHER = 2048


class Labels(NamedTuple):
    """The labels of n trajectories; every field has the shape (n,)."""

    state: np.ndarray  # str, one of STATES
    period: np.ndarray  # int64, excitation cycles; 0 for none, or none of up to settling.MAX_PERIOD
    longest_flight: np.ndarray  # excitation cycles, of a settled motion; NaN for none
    cycles: np.ndarray  # int64, excitation cycles that the trajectory was followed for


def continued(
    parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, duration: float, *, out: np.ndarray | None = None
) -> np.ndarray:
    """Parameter vectors, shape (n, 16), that go on where runs of `duration` (s) of `parameters` ended.

    out : where they are written, which may be `parameters`; None for a new array
    """
    later = np.empty(parameters.shape) if out is None else out
    if later is not parameters:
        later[:] = parameters
    cycles = parameters[:, FREQUENCY] * duration
    later[:, PSI0] = (parameters[:, PSI0] + 2.0 * math.pi * (cycles - np.floor(cycles))) % (2.0 * math.pi)
    later[:, Z0] = z_end
    later[:, VZ0] = vz_end
    return later


def classify(
    parameters: np.ndarray,
    *,
    cycles: int = CYCLES,
    known: AttractorTable = NO_ATTRACTORS,
    exponents: bool = True,
    tolerance: float = 1e-8,
    threads: int = 1,
    progress: str | None = None,
) -> Labels:
    """The label of each trajectory.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack; after a run, those of `continued`
    cycles : excitation cycles after which a trajectory that has not settled is followed no further
    known : attractors of conveyors; without them each trajectory is followed to its own end
    exponents : whether Lyapunov exponents decide about trajectories that have not settled; otherwise they are undecided
    tolerance : of the contact steps
    threads, progress : as in ensemble.run
    """
    parameters = np.ascontiguousarray(parameters, dtype=np.float64)
    n = len(parameters)
    points, places, no_strobes = np.empty((n, 2)), known.of(parameters), np.empty((n, 0, 2))
    outcomes, periods, flights, followed = (np.empty(n, kind) for kind in (np.int64, np.int64, np.float64, np.int64))

    def work(begin, end):
        rows = slice(begin, end)
        found = points[rows], outcomes[rows], periods[rows], flights[rows], followed[rows]
        settling_lanes.settle_points(parameters[rows], tolerance, cycles, known, places[rows], found, no_strobes[rows])

    for_each_chunk(work, n, threads=threads, chunk=TOGETHER, progress=progress)
    flights /= 1.0 / parameters[:, FREQUENCY]
    codes = np.full(n, UNDECIDED)
    regular = np.where(flights >= LONG_FLIGHT, SECOND, FIRST)
    codes[outcomes == SETTLED] = regular[outcomes == SETTLED]
    codes[outcomes == STAYS] = CHAOS
    still = np.flatnonzero(outcomes == OPEN)
    if exponents and len(still):
        signs = lyapunov.signs(parameters[still], points[still], tolerance=tolerance, threads=threads)
        codes[still[signs > 0]] = CHAOS
        longer = still[signs < 0]
        codes[longer] = regular[longer]
    flights[(codes == CHAOS) | (codes == UNDECIDED)] = math.nan
    return Labels(np.array(STATES, dtype=object)[codes], periods, flights, followed)
