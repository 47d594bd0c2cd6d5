"""Labels: the state of motion that a trajectory ends in, first (moves with the plate), second (jumps) or chaos.

A trajectory is followed until it repeats itself with a period of up to 64 excitation cycles. The longest flight in a
period distinguishes the first state from the second. A trajectory that does not repeat itself within a given number of
cycles is chaos if its largest Lyapunov exponent is positive by more than three standard errors. It is a regular motion
of a longer period if the exponent is negative by more than three standard errors, and `undecided` otherwise.

A label depends only on the conveyor and the initial condition. Trajectories on one conveyor may share its known
attractors (see `search`). A trajectory that has reached the trapping region of a periodic orbit, or stays in a chaotic
set, need not be followed further.

A run that failed hands `classify` a state of NaN; such a trajectory is undecided.
"""

import math

import numpy as np

from ...arguments import MOST_CYCLES, check_count, check_flag, check_threads, check_tolerance, check_type
from ...columns import Columns
from ...packing import as_table, check_rows
from ...parallel import for_each_chunk
from ...parameters import DEFAULT_TOLERANCE
from ...progress import progress_bar
from ...solver.model import FREQUENCY, Conveyor
from ..chaos import lyapunov
from . import convergence_lanes
from .attractor_table import NO_ATTRACTORS, AttractorTable, distinct_rows
from .convergence import IN_CHAOTIC_SET, NOT_CONVERGED, PERIODIC, new_trajectories
from .identity import Attractors, identify

STATES = ("first", "second", "chaos", "undecided")
FIRST, SECOND, CHAOS, UNDECIDED = range(len(STATES))

# Excitation cycles. A flight of the second state takes most of a cycle, a micro-bounce of the first a small part of it.
LONG_FLIGHT = 0.5
# Excitation cycles after which a search for a period ends.
CYCLES = 20_000
# Trajectories that a thread takes at a time. The last ones leave lanes idle, so that many are better.
TOGETHER = 8192
# Rows of a group. Neighbours have similar motions, which take about three quarters of the time of different motions
# side by side. With groups of 64, the progress bar of a few hundred trajectories is uneven.
NEIGHBOURS = 16


def regular_state(flight: float) -> str:
    """The state of motion of a regular motion with a longest flight, in excitation cycles."""
    return STATES[SECOND if flight >= LONG_FLIGHT else FIRST]


def classify(
    parameters: Conveyor | np.ndarray,
    *,
    cycles: int = CYCLES,
    attractors: AttractorTable | Attractors = NO_ATTRACTORS,
    exponents: bool = True,
    other_tolerance: float | None = None,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """The label of the attractor that each initial condition leads to: its state of motion and its period.

    Parameters
    ----------
    parameters : from `parameter_table` or, after a run, from `restart`, of any shape
    cycles : excitation cycles after which the search for a period ends, up to 1e6
    attractors : known attractors of the conveyors, which save time: from search.find_attractors, or, of one conveyor,
        from `attractors`
    exponents : whether Lyapunov exponents label trajectories that have not converged; otherwise they stay undecided
    other_tolerance : a second tolerance, with which each label is found once more
    tolerance : of the contact steps
    threads, progress : as in `sweep`

    Returns
    -------
    columns of the shape of `parameters`: state, one of `STATES`; period (int64, excitation cycles), 0 for none of up to
    MAX_PERIOD; longest_flight (excitation cycles), NaN for chaos and undecided trajectories; cycles (int64) that the
    trajectory was followed for; delta (m) and v (m/s), the last penetration at the beginning of a cycle and its rate.
    With `attractors` of one conveyor: attractor (int64), its number among them, -1 for another one. With
    `other_tolerance`: confirmed (bool), whether state and period are the same with it

    Examples
    --------
    >>> labels = classify(parameter_table(Conveyor(), acceleration=[40.0, 57.0, 80.0], z0=3e-4))
    >>> list(zip(labels.state.tolist(), labels.period.tolist()))
    [('second', 1), ('second', 2), ('chaos', 0)]
    """
    cycles = check_count("cycles", cycles, 1, MOST_CYCLES)
    tolerance, threads = check_tolerance(tolerance), check_threads(threads)
    parameters, shape = check_rows(parameters)
    if not isinstance(attractors, Attractors):
        check_type("attractors", attractors, AttractorTable)
    elif not all(np.array_equal(row, attractors.conveyor) for row in distinct_rows(parameters)[0]):
        raise ValueError("attractors are those of another conveyor; give an AttractorTable for several")
    table = attractors.table if isinstance(attractors, Attractors) else attractors
    exponents, n = check_flag("exponents", exponents), len(parameters)
    if other_tolerance is not None:
        tolerances = tolerance, check_tolerance(other_tolerance, "other_tolerance")
        options = {"cycles": cycles, "attractors": attractors, "exponents": exponents, "threads": threads}
        with progress_bar(total=2 * n, label=progress) as shown:
            rows = as_table(parameters).reshape(shape)
            labelled, again = (classify(rows, **options, tolerance=limit, progress=shown) for limit in tolerances)
        return Columns({**labelled, "confirmed": (again.state == labelled.state) & (again.period == labelled.period)})
    trajectories, table_rows = new_trajectories(n), table.rows_of(parameters)
    # Trajectories in chaos take a hundred times as long as others. With groups in a mixed order, all ranges take about
    # as long as the ones before, so that the progress bar moves evenly.
    groups = np.random.default_rng(0).permutation(math.ceil(n / NEIGHBOURS))
    order = (groups[:, None] * NEIGHBOURS + np.arange(NEIGHBOURS)).flatten()
    order = order[order < n]

    def work(begin, end):
        rows = order[begin:end]
        chunk = convergence_lanes.follow_all_to_attractors(parameters[rows], tolerance, cycles, table, table_rows[rows])
        for column, values in zip(trajectories, chunk, strict=True):
            column[rows] = values

    for_each_chunk(work, n, threads=threads, chunk=TOGETHER, progress=progress)
    outcomes = trajectories.outcomes
    flights = trajectories.flights / (1.0 / parameters[:, FREQUENCY])
    codes = np.full(n, UNDECIDED)
    regular = np.where(flights >= LONG_FLIGHT, SECOND, FIRST)
    codes[outcomes == PERIODIC] = regular[outcomes == PERIODIC]
    codes[outcomes == IN_CHAOTIC_SET] = CHAOS
    still = np.flatnonzero(outcomes == NOT_CONVERGED)
    if exponents and len(still):
        signs = lyapunov.signs(parameters[still], trajectories.states[still], tolerance=tolerance, threads=threads)
        codes[still[signs > 0]] = CHAOS
        longer = still[signs < 0]
        codes[longer] = regular[longer]
    flights[(codes == CHAOS) | (codes == UNDECIDED)] = math.nan
    delta, v = trajectories.states.T
    labels = {"state": np.array(STATES, dtype=object)[codes], "period": trajectories.periods, "longest_flight": flights}
    labels |= {"cycles": trajectories.followed, "delta": delta, "v": v}
    labelled = Columns({name: column.reshape(shape) for name, column in labels.items()})
    if isinstance(attractors, Attractors):
        labelled = Columns({**labelled, "attractor": identify(attractors, labelled)})
    return labelled
