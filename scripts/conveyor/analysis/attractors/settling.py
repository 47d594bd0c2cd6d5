"""When does a motion settle? It is followed until it repeats itself, or comes to a known orbit or chaotic set."""

import math

import numpy as np

from ...solver import contact
from ...solver.jit import compiled, compiled_inline, compiled_into_callers
from ...solver.trajectory import BEGIN_OF_CYCLE, OK
from .. import stroboscopic_map

MAX_PERIOD = 64
# A state repeats itself if it comes back to this distance, in units of the part at rest, for a whole period.
CLOSE = 1e-6
# A motion that doubles its period slowly is near twice its period first: parts of a period this close are one.
SAME = 1e-4
# Cycles in a row within chaotic sets after which a start has come there to stay.
STAY = 64

# What a search for a period ends with; GOES_ON is none of them.
SETTLED, STAYS, OPEN, FAILED, GOES_ON = range(5)

# What a search remembers are the last PAST cycles, δ (m) and v (m/s) at their ends and the longest flights in them (s);
# and numbers of cycles: those followed, the period that was last seen and since when, those in a row within chaos.
PAST = 2 * MAX_PERIOD
DELTA, V, FLIGHTS = range(3)
FOLLOWED, CANDIDATE, REPEATS, STAYED = range(4)


@compiled_inline
def measure(c, centre, factor, state):
    """Both components of a state's distance from a point of an orbit; see attractor_table.AttractingOrbits."""
    along = state[0] - centre[0]
    across = state[1] + c.damping * max(state[0], 0.0) - centre[1]
    return factor[0] * along + factor[1] * across, factor[2] * across


@compiled
def reached(c, state, orbits, first, behind):
    """The known orbit, from number `first` to that before `behind`, in whose neighbourhood a state lies, or -1."""
    for k in range(first, behind):
        along, across = measure(c, orbits.centres[k], orbits.factors[k], state)
        if along * along + across * across <= 1.0:
            return k
    return -1


@compiled
def inside(state, chaotic, first, behind):
    """Whether a state lies in one of the boxes of the chaotic sets from number `first` to that before `behind`."""
    for k in range(first, behind):
        i = (state[0] - chaotic.low[k, 0]) / chaotic.size[k, 0]
        j = (state[1] - chaotic.low[k, 1]) / chaotic.size[k, 1]
        rows, columns = chaotic.cells[k].shape
        if 0.0 <= i < rows and 0.0 <= j < columns and chaotic.cells[k, int(i), int(j)]:
            return True
    return False


@compiled
def memory(searches):
    """Memories of a number of searches: float64, shape (searches, 3, PAST), and int64, shape (searches, 4)."""
    return np.empty((searches, 3, PAST)), np.empty((searches, 4), np.int64)


@compiled_inline
def forget(past, counts):
    """Begin a search with the memory of one that is over."""
    for k in range(PAST):
        past[DELTA, k] = past[V, k] = math.inf
        past[FLIGHTS, k] = 0.0
    for k in range(4):
        counts[k] = 0


@compiled_inline
def near(state, past, lag, n, scale_0, scale_1):
    """Distance of `state`, number n, from the one `lag` cycles before, in units of the part at rest."""
    then = (n - lag) % PAST
    return max(abs(state[0] - past[DELTA, then]) / scale_0, abs(state[1] - past[V, then]) / scale_1)


@compiled_inline
def last_period(state, past, n, scale_0, scale_1):
    """The least number of cycles, up to MAX_PERIOD, after which a motion has come back to `state`, number n, or 0."""
    some = 0
    # Mostly it has not: all distances at a time, without division, tell so.
    reach_0, reach_1 = 2.0 * CLOSE * scale_0, 2.0 * CLOSE * scale_1
    for k in range(PAST):
        some += (abs(state[0] - past[DELTA, k]) <= reach_0) & (abs(state[1] - past[V, k]) <= reach_1)
    if some > 0:
        for period in range(1, min(n, MAX_PERIOD) + 1):
            if near(state, past, period, n, scale_0, scale_1) <= CLOSE:
                return period
    return 0


@compiled_inline
def longest_flight(past, n, cycles):
    """The longest flight (s) in the last of n `cycles`."""
    longest = 0.0
    for k in range(1, cycles + 1):
        longest = max(longest, past[FLIGHTS, (n - k) % PAST])
    return longest


@compiled
def look(c, state, flight, max_cycles, known, mine, past, counts):
    """Whether a search is over after one more cycle.

    Parameters
    ----------
    c, state, max_cycles, known, mine : as in `settle`; `state` is that at the end of the cycle
    flight : longest flight (s) of those that ended in the cycle or go on
    past, counts : the search's `memory`

    Returns
    -------
    outcome, period, longest_flight : as in `settle`, or GOES_ON
    """
    n = counts[FOLLOWED]
    counts[FOLLOWED] += 1
    orbit = reached(c, state, known.orbits, mine[0], mine[1])
    if orbit >= 0:
        return SETTLED, known.orbits.periods[orbit], known.orbits.flights[orbit]
    scale_0, scale_1 = c.scale_w * c.scale_w, c.scale_v
    found = last_period(state, past, n, scale_0, scale_1)
    past[DELTA, n % PAST], past[V, n % PAST], past[FLIGHTS, n % PAST] = state[0], state[1], flight
    counts[REPEATS] = counts[REPEATS] + 1 if found > 0 and found == counts[CANDIDATE] else 0
    counts[CANDIDATE] = found
    if found > 0 and counts[REPEATS] >= found:
        for period in range(1, found + 1):
            if found % period == 0 and near(state, past, period, n, scale_0, scale_1) <= SAME:
                found = period
                break
        return SETTLED, found, longest_flight(past, n + 1, found)
    counts[STAYED] = counts[STAYED] + 1 if inside(state, known.chaotic, mine[2], mine[3]) else 0
    if counts[STAYED] >= STAY:
        return STAYS, 0, math.nan
    if n + 1 >= max_cycles:
        return OPEN, 0, longest_flight(past, n + 1, min(MAX_PERIOD, n + 1))
    return GOES_ON, 0, math.nan


@compiled_into_callers
def settle(c, series, state, max_cycles, known, mine, strobes):
    """Follow `state`, at the phase BEGIN_OF_CYCLE, until it is periodic or at a known attractor.

    Parameters
    ----------
    c, series, state : as in stroboscopic_map.advance
    max_cycles : after which the search ends
    known, mine : an AttractorTable, and a row of what `of` says of this conveyor
    strobes : float64, shape (max_cycles, 2), filled with the states after each cycle; of length 0 where not wanted

    Returns
    -------
    outcome, period, longest_flight, cycles : SETTLED, STAYS, OPEN or FAILED; excitation cycles (0 for none); s, of one
        period or of the last MAX_PERIOD cycles; excitation cycles followed
    """
    no_tangent = np.empty((0, 2))
    features = np.zeros(stroboscopic_map.FEATURES)
    histories, numbers = memory(1)
    past, counts = histories[0], numbers[0]
    forget(past, counts)
    for n in range(max_cycles):
        if stroboscopic_map.advance(c, series, state, BEGIN_OF_CYCLE, c.period, no_tangent, features) != OK:
            return FAILED, 0, math.nan, n
        if n < strobes.shape[0]:
            strobes[n, 0], strobes[n, 1] = state[0], state[1]
        flight = max(features[stroboscopic_map.LONGEST_FLIGHT], features[stroboscopic_map.AIRBORNE])
        outcome, period, longest = look(c, state, flight, max_cycles, known, mine, past, counts)
        if outcome != GOES_ON:
            return outcome, period, longest, n + 1
    return OPEN, 0, 0.0, 0


@compiled
def settle_points(parameters, tolerance, cycles, known, places, found, strobes):
    """`settle` for rows of `parameters`, shape (n, 16), from their starts on.

    Parameters
    ----------
    tolerance : of the contact steps
    cycles : after which a search ends
    known, places : attractors, and what `of` them says of each row, shape (n, 4)
    found : filled: points, float64, shape (n, 2), states (δ in m, v in m/s) at the end of the search; outcomes and
        periods, int64, flights, float64, in s, and followed, int64, shape (n,), as in `settle`
    strobes : float64, shape (n, m, 2), filled with the states after each of the first m cycles
    """
    points, outcomes, periods, flights, followed = found
    series = contact.workspace()
    stroboscopic_map.to_begin_of_cycle(parameters, tolerance, points)
    for i in range(parameters.shape[0]):
        outcomes[i], periods[i], flights[i], followed[i] = FAILED, 0, math.nan, 0
        c = contact.constants(parameters[i], tolerance)
        if math.isfinite(points[i, 0]) and math.isfinite(points[i, 1]):
            outcomes[i], periods[i], flights[i], followed[i] = settle(
                c, series, points[i], cycles, known, places[i], strobes[i]
            )
