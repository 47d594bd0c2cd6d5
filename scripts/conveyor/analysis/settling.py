"""When does a motion settle? It is followed until it repeats itself, or comes to a known orbit or chaotic set."""

import math

import numpy as np

from ..solver.jit import inlined, kernel
from ..solver.trajectory import BEGIN_OF_CYCLE, OK
from . import stroboscope

MAX_PERIOD = 64
# A state repeats itself if it comes back to this distance, in units of the part at rest, for a whole period.
CLOSE = 1e-6
# A motion that doubles its period slowly is near twice its period first: parts of a period this close are one.
SAME = 1e-4
# Cycles in a row within chaotic sets after which a start has come there to stay.
STAY = 64

# What a search for a period ends with.
SETTLED, STAYS, OPEN, FAILED = range(4)


@inlined
def measure(c, centre, factor, state):
    """Both components of a state's distance from a point of an orbit; see known.AttractingOrbits."""
    along = state[0] - centre[0]
    across = state[1] + c.damping * max(state[0], 0.0) - centre[1]
    return factor[0] * along + factor[1] * across, factor[2] * across


@kernel
def reached(c, state, orbits, first, behind):
    """The known orbit, from number `first` to that before `behind`, in whose neighbourhood a state lies, or -1."""
    for k in range(first, behind):
        along, across = measure(c, orbits.centres[k], orbits.factors[k], state)
        if along * along + across * across <= 1.0:
            return k
    return -1


@kernel
def inside(state, chaotic, first, behind):
    """Whether a state lies in one of the boxes of the chaotic sets from number `first` to that before `behind`."""
    for k in range(first, behind):
        i = (state[0] - chaotic.low[k, 0]) / chaotic.size[k, 0]
        j = (state[1] - chaotic.low[k, 1]) / chaotic.size[k, 1]
        rows, columns = chaotic.cells[k].shape
        if 0.0 <= i < rows and 0.0 <= j < columns and chaotic.cells[k, int(i), int(j)]:
            return True
    return False


@kernel
def near(state, history, lag, n, scale_0, scale_1):
    """Distance of `state`, number n, from the one `lag` cycles before, in units of the part at rest."""
    past = (n - lag) % len(history)
    return max(abs(state[0] - history[past, 0]) / scale_0, abs(state[1] - history[past, 1]) / scale_1)


@kernel
def settle(c, series, state, max_cycles, known, mine, strobes):
    """Follow `state`, at the phase BEGIN_OF_CYCLE, until it is periodic or at a known attractor.

    Parameters
    ----------
    c, series, state : as in stroboscope.advance
    max_cycles : after which the search ends
    known, mine : known.KnownAttractors, and a row of what `of` says of this conveyor
    strobes : float64, shape (max_cycles, 2), filled with the states after each cycle; of length 0 where not wanted

    Returns
    -------
    outcome, period, longest_flight, cycles : SETTLED, STAYS, OPEN or FAILED; excitation cycles (0 for none); s, of one
        period or of the last MAX_PERIOD cycles; excitation cycles followed
    """
    no_tangent = np.empty((0, 2))
    features = np.zeros(stroboscope.FEATURES)
    history = np.full((2 * MAX_PERIOD, 2), np.inf)
    flights = np.zeros(2 * MAX_PERIOD)
    scale_0, scale_1 = c.scale_w * c.scale_w, c.scale_v
    candidate = repeats = stays = 0
    for n in range(max_cycles):
        if stroboscope.advance(c, series, state, BEGIN_OF_CYCLE, c.period, no_tangent, features) != OK:
            return FAILED, 0, math.nan, n
        orbit = reached(c, state, known.orbits, mine[0], mine[1])
        if orbit >= 0:
            return SETTLED, known.orbits.periods[orbit], known.orbits.flights[orbit], n + 1
        flights[n % (2 * MAX_PERIOD)] = max(features[stroboscope.LONGEST_FLIGHT], features[stroboscope.AIRBORNE])
        found = 0
        for period in range(1, min(n, MAX_PERIOD) + 1):
            if near(state, history, period, n, scale_0, scale_1) <= CLOSE:
                found = period
                break
        # Slices would bring in the text functions of their errors, which take long to compile.
        for k in range(2):
            history[n % (2 * MAX_PERIOD), k] = state[k]
            if n < strobes.shape[0]:
                strobes[n, k] = state[k]
        if found > 0 and found == candidate:
            repeats += 1
        else:
            candidate = found
            repeats = 0
        if candidate > 0 and repeats >= candidate:
            for period in range(1, candidate + 1):
                if candidate % period == 0 and near(state, history, period, n, scale_0, scale_1) <= SAME:
                    candidate = period
                    break
            longest = 0.0
            for k in range(candidate):
                longest = max(longest, flights[(n - k) % (2 * MAX_PERIOD)])
            return SETTLED, candidate, longest, n + 1
        stays = stays + 1 if inside(state, known.chaotic, mine[2], mine[3]) else 0
        if stays >= STAY:
            return STAYS, 0, math.nan, n + 1
    longest = 0.0
    for k in range(min(MAX_PERIOD, max_cycles)):
        longest = max(longest, flights[(max_cycles - 1 - k) % (2 * MAX_PERIOD)])
    return OPEN, 0, longest, max_cycles
