"""When a trajectory has converged: it repeats itself, or has reached a known periodic orbit or chaotic set."""

import math
from typing import NamedTuple

import numpy as np

from ...solver import contact_law
from ...solver.jit import compiled, compiled_inline
from ..stroboscopic_map import MAX_PERIOD

# A state repeats itself if it comes back to this distance, in units of the part at rest, for a whole period.
CLOSE = 1e-6
# Just behind a period doubling a trajectory almost repeats itself after half its period. It counts as the half period
# if the distance is below this one.
SAME = 1e-4
# Cycles in a row within chaotic sets after which a trajectory is taken to stay there. On the paper's maps no trajectory
# that becomes periodic stays for two.
STAY = 48

# Outcomes of a search; GOES_ON is none of them.
PERIODIC, IN_CHAOTIC_SET, NOT_CONVERGED, FAILED, GOES_ON = range(5)

# The history of a search, shape (3, PAST): δ (m) and v (m/s) at the ends of the last PAST cycles, and the longest
# flights in them (s).
PAST = 2 * MAX_PERIOD
DELTA, V, FLIGHTS = range(3)
# The counters of a search, int64, shape (4,): cycles followed, the last candidate for a period, cycles for which it has
# held, cycles in a row in chaotic sets.
FOLLOWED, CANDIDATE, REPEATS, STAYED = range(4)
# The cycles that a search has followed before its first whole cycle begins.
BEFORE_FIRST_CYCLE = -1


class Trajectories(NamedTuple):
    """How n trajectories ended; every field has the length n."""

    states: np.ndarray  # float64, shape (n, 2), the last δ (m) and v (m/s), at pieces.BEGIN_OF_CYCLE
    outcomes: np.ndarray  # int64, PERIODIC, IN_CHAOTIC_SET, NOT_CONVERGED or FAILED
    periods: np.ndarray  # int64, excitation cycles; 0 for none
    flights: np.ndarray  # float64, s, longest flight
    followed: np.ndarray  # int64, excitation cycles


def new_trajectories(n: int) -> Trajectories:
    """n trajectories that have failed before their first cycle, to be replaced when they end."""
    return Trajectories(
        np.full((n, 2), math.nan),
        np.full(n, FAILED),
        np.zeros(n, np.int64),
        np.full(n, math.nan),
        np.zeros(n, np.int64),
    )


@compiled_inline
def distance_components(c, centre, factor, state):
    """Both components of R (x - centre), see attractor_table.AttractingOrbits."""
    along = state[0] - centre[0]
    across = contact_law.smooth_speed(c, state[0], state[1]) - centre[1]
    return factor[0] * along + factor[1] * across, factor[2] * across


@compiled
def find_reached_orbit(c, state, orbits, first, behind):
    """The orbit, from number `first` to that before `behind`, in whose trapping region a state lies, or -1."""
    for k in range(first, behind):
        along, across = distance_components(c, orbits.centres[k], orbits.factors[k], state)
        if along * along + across * across <= 1.0:
            return k
    return -1


@compiled
def find_reached_set(state, chaotic, first, behind):
    """The chaotic set, from number `first` to the number before `behind`, with a box that contains a state, or -1."""
    for k in range(first, behind):
        i = (state[0] - chaotic.low[k, 0]) / chaotic.size[k, 0]
        j = (state[1] - chaotic.low[k, 1]) / chaotic.size[k, 1]
        rows, columns = chaotic.cells[k].shape
        if 0.0 <= i < rows and 0.0 <= j < columns and chaotic.cells[k, int(i), int(j)]:
            return k
    return -1


@compiled
def find_reached(c, states, periods, is_chaos, attractors, numbers):
    """Fill the number of the known orbit or chaotic set that each trajectory has reached, or -1.

    The numbers of chaotic sets follow those of the orbits.

    states, periods, is_chaos : last state, period (0 for none) and label of each trajectory
    """
    orbits = len(attractors.orbits.periods)
    for i in range(len(states)):
        numbers[i] = -1
        if is_chaos[i]:
            k = find_reached_set(states[i], attractors.chaotic, 0, len(attractors.chaotic.low))
            numbers[i] = orbits + k if k >= 0 else -1
        elif periods[i] > 0:
            numbers[i] = find_reached_orbit(c, states[i], attractors.orbits, 0, orbits)


@compiled_inline
def distance_from_past(state, past, lag, n, scale_0, scale_1):
    """Distance of `state`, number n, from the state `lag` cycles before, in units of the part at rest."""
    then = (n - lag) % PAST
    return max(abs(state[0] - past[DELTA, then]) / scale_0, abs(state[1] - past[V, then]) / scale_1)


@compiled_inline
def find_period(state, past, n, scale_0, scale_1):
    """The least number of cycles, up to MAX_PERIOD, after which a trajectory is back at `state`, number n, or 0."""
    near = 0
    # Most states have no near one in the past. This loop has no branches and no divisions, and shows so quickly.
    reach_0, reach_1 = 2.0 * CLOSE * scale_0, 2.0 * CLOSE * scale_1
    for k in range(min(n, PAST)):
        near += (abs(state[0] - past[DELTA, k]) <= reach_0) & (abs(state[1] - past[V, k]) <= reach_1)
    if near > 0:
        for period in range(1, min(n, MAX_PERIOD) + 1):
            if distance_from_past(state, past, period, n, scale_0, scale_1) <= CLOSE:
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
def check_convergence(c, state, flight, max_cycles, attractors, rows, past, counts):
    """Whether a search is over after one more cycle, or at the beginning of its first whole cycle.

    Parameters
    ----------
    c : contact.Constants
    state : δ (m) and v (m/s) at the end of the cycle
    flight : longest flight (s) that ended in the cycle or goes on
    max_cycles : excitation cycles after which the search ends
    attractors, rows : an AttractorTable, and the row of `AttractorTable.rows_of` for this conveyor
    past, counts : history and counters of the search

    Returns
    -------
    outcome : PERIODIC, IN_CHAOTIC_SET, NOT_CONVERGED or GOES_ON
    period : excitation cycles, 0 for none
    longest_flight : s, in one period, or in the last MAX_PERIOD cycles
    """
    n = counts[FOLLOWED]
    counts[FOLLOWED] += 1
    orbit = find_reached_orbit(c, state, attractors.orbits, rows[0], rows[1])
    if orbit >= 0:
        return PERIODIC, attractors.orbits.periods[orbit], attractors.orbits.flights[orbit]
    if n == BEFORE_FIRST_CYCLE:
        return GOES_ON, 0, math.nan
    scale_0, scale_1 = c.scale_w * c.scale_w, c.scale_v
    period = find_period(state, past, n, scale_0, scale_1)
    past[DELTA, n % PAST], past[V, n % PAST], past[FLIGHTS, n % PAST] = state[0], state[1], flight
    counts[REPEATS] = counts[REPEATS] + 1 if period > 0 and period == counts[CANDIDATE] else 0
    counts[CANDIDATE] = period
    if period > 0 and counts[REPEATS] >= period:
        for shorter in range(1, period):
            if period % shorter == 0 and distance_from_past(state, past, shorter, n, scale_0, scale_1) <= SAME:
                period = shorter
                break
        return PERIODIC, period, longest_flight(past, n + 1, period)
    counts[STAYED] = counts[STAYED] + 1 if find_reached_set(state, attractors.chaotic, rows[2], rows[3]) >= 0 else 0
    if counts[STAYED] >= STAY:
        return IN_CHAOTIC_SET, 0, math.nan
    if n + 1 >= max_cycles:
        return NOT_CONVERGED, 0, longest_flight(past, n + 1, min(MAX_PERIOD, n + 1))
    return GOES_ON, 0, math.nan
