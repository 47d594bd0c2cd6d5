"""Labels: the state of motion that a trajectory ends in, first (moves with the plate), second (jumps) or chaos.

A trajectory is followed until it repeats itself with a period of up to 64 excitation cycles. The longest flight in a
period distinguishes the first state from the second. A trajectory that does not repeat itself within a given number of
cycles is chaos if its largest Lyapunov exponent is positive by more than three standard errors. It is a regular motion
of a longer period if the exponent is negative by more than three standard errors, and `undecided` otherwise.

A label depends only on the conveyor and the initial condition. Trajectories on one conveyor may share its known
attractors (see `search`). A trajectory that has reached the trapping region of a periodic orbit, or stays in a chaotic
set, need not be followed further.

`interface.classify` checks its arguments; `classify` here does not, because a run that failed may hand it any state.
"""

import math
from typing import NamedTuple

import numpy as np

from ...solver.model import FREQUENCY, PSI0, VZ0, Z0
from ...solver.parallel import for_each_chunk
from ..chaos import lyapunov
from . import convergence_lanes
from .attractor_table import NO_ATTRACTORS, AttractorTable
from .convergence import IN_CHAOTIC_SET, NOT_CONVERGED, PERIODIC, new_trajectories

STATES = ("first", "second", "chaos", "undecided")
FIRST, SECOND, CHAOS, UNDECIDED = range(len(STATES))

# Excitation cycles. A flight of the second state takes most of a cycle, a micro-bounce of the first a small part of it.
LONG_FLIGHT = 0.5
# Excitation cycles after which a search for a period ends.
CYCLES = 20_000
# Trajectories that a thread takes at a time. The last ones leave lanes idle, so that many are better.
TOGETHER = 8192


class Labels(NamedTuple):
    """The labels of n trajectories; every field has the shape (n,)."""

    state: np.ndarray  # str, one of STATES
    period: np.ndarray  # int64, excitation cycles; 0 for none of up to stroboscopic_map.MAX_PERIOD
    longest_flight: np.ndarray  # excitation cycles; NaN for chaos and undecided trajectories
    cycles: np.ndarray  # int64, excitation cycles that the trajectory was followed for
    delta: np.ndarray  # m, the last penetration δ at trajectory.BEGIN_OF_CYCLE
    v: np.ndarray  # m/s, its rate there


def continued(parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, duration: float) -> np.ndarray:
    """Packed parameters, shape (n, 16), of trajectories that continue runs of `parameters`.

    z_end, vz_end : where the runs ended, m and m/s, shape (n,)
    duration : of the runs, s, a number or of shape (n,)
    """
    later = np.array(parameters, dtype=np.float64)
    cycles = parameters[:, FREQUENCY] * duration
    later[:, PSI0] = (parameters[:, PSI0] + 2.0 * math.pi * (cycles - np.floor(cycles))) % (2.0 * math.pi)
    later[:, Z0] = z_end
    later[:, VZ0] = vz_end
    return later


def classify(
    parameters: np.ndarray,
    *,
    cycles: int = CYCLES,
    attractors: AttractorTable = NO_ATTRACTORS,
    exponents: bool = True,
    tolerance: float = 1e-8,
    threads: int = 1,
    progress: str | None = None,
) -> Labels:
    """The label of each trajectory.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows from model.pack or, after a run, from `continued`
    cycles : excitation cycles after which the search for a period ends
    attractors : known attractors of the conveyors, see search.find_attractors; by default none
    exponents : whether Lyapunov exponents label trajectories that have not converged; otherwise they stay undecided
    tolerance : of the contact steps
    threads, progress : as in ensemble.run
    """
    parameters = np.ascontiguousarray(parameters, dtype=np.float64)
    n = len(parameters)
    found, table_rows = new_trajectories(n), attractors.rows_of(parameters)

    def work(begin, end):
        rows = slice(begin, end)
        chunk = convergence_lanes.follow_all_to_attractors(
            parameters[rows], tolerance, cycles, attractors, table_rows[rows]
        )
        for column, values in zip(found, chunk, strict=True):
            column[rows] = values

    for_each_chunk(work, n, threads=threads, chunk=TOGETHER, progress=progress)
    outcomes = found.outcomes
    flights = found.flights / (1.0 / parameters[:, FREQUENCY])
    codes = np.full(n, UNDECIDED)
    regular = np.where(flights >= LONG_FLIGHT, SECOND, FIRST)
    codes[outcomes == PERIODIC] = regular[outcomes == PERIODIC]
    codes[outcomes == IN_CHAOTIC_SET] = CHAOS
    still = np.flatnonzero(outcomes == NOT_CONVERGED)
    if exponents and len(still):
        signs = lyapunov.signs(parameters[still], found.states[still], tolerance=tolerance, threads=threads)
        codes[still[signs > 0]] = CHAOS
        longer = still[signs < 0]
        codes[longer] = regular[longer]
    flights[(codes == CHAOS) | (codes == UNDECIDED)] = math.nan
    return Labels(np.array(STATES, dtype=object)[codes], found.periods, flights, found.followed, *found.states.T)
