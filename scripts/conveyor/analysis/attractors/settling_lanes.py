"""`settling.settle` for many starts at once, one in each lane of the processor's vector registers.

Lanes in contact take their steps together, see contact_lanes. One with an event leaves them for scalar code until it is
in contact again: it flies, comes to the end of a cycle, is found to have settled, makes room for the next start. What a
start gives depends neither on its lane nor on its neighbours nor on the number of lanes: it is what `settle` gives, to
the last bit.
"""

import functools
import math

import numpy as np

from ...solver import contact
from ...solver.contact import FIRST
from ...solver.contact_lanes import (
    COSINE,
    END,
    LENGTH,
    MOST,
    SINE,
    STEPS,
    TIME,
    V,
    W,
    enter,
    fetch,
    first_from,
    return_to_lane,
    room,
    step,
)
from ...solver.jit import compiled, compiled_into_callers, no_refcount
from ...solver.model import VZ0, Z0
from ...solver.trajectory import BEGIN_OF_CYCLE, patience
from ...solver.vertical import (
    FLIGHT,
    GRAZE,
    IMPACT,
    LIMIT,
    LOST,
    Motion,
    Piece,
    arrive,
    begin,
    fly,
    graze,
    grazing,
    motion_at,
    press,
)
from ..stroboscopic_map import delta_and_v
from . import settling
from .attractor_table import AttractingOrbits, AttractorTable, ChaoticSets
from .settling import FOLLOWED, GOES_ON, forget, look, memory

# Eight lanes take the contact steps in less time, but wait longer for those with an event: no gain where they were
# measured, and twice the time for the last starts, which have most lanes for themselves.
LANES = 4

# Fewer starts are followed one after the other.
SIDE_BY_SIDE = LANES

# What is known of a lane's present cycle: time since the last separation (s), longest flight that ended in it (s), the
# excitation's phase at its beginning (rad).
AIRBORNE, LONGEST, ORIGIN = range(3)
# Cycles that a search has followed while its start is on the way to the first one.
ON_THE_WAY = -1
# The row of a lane without a start.
NONE = -1


@compiled_into_callers
def no_refcounts(known):
    """The same attractors, see jit.no_refcount."""
    orbits, chaotic = known.orbits, known.chaotic
    return AttractorTable(
        AttractingOrbits(
            no_refcount(orbits.conveyors),
            no_refcount(orbits.centres),
            no_refcount(orbits.factors),
            no_refcount(orbits.periods),
            no_refcount(orbits.flights),
        ),
        ChaoticSets(
            no_refcount(chaotic.conveyors),
            no_refcount(chaotic.low),
            no_refcount(chaotic.size),
            no_refcount(chaotic.cells),
        ),
    )


@compiled_into_callers
def load(c, start, lane, steps, cycle, past, counts):
    """The Motion at the beginning of a start, shape (16,), that comes into a lane with nothing left of others in it."""
    enter(steps, lane, c, patience(c))
    forget(past, counts)
    counts[FOLLOWED] = ON_THE_WAY
    # At most one cycle is left to the first one that is a whole one.
    steps[END, lane] = ((BEGIN_OF_CYCLE - c.psi0) % (2.0 * math.pi)) / c.omega
    steps[STEPS, lane] = cycle[LONGEST, lane] = cycle[AIRBORNE, lane] = 0.0
    cycle[ORIGIN, lane] = c.psi0
    q, rate = begin(c, start[Z0], start[VZ0], c.psi0)
    return motion_at(c, q, rate, 0.0, c.psi0)


@compiled_into_callers
def stopped_motion(lane, steps):
    """The Motion in contact, without what only flights need, at which a lane left the others."""
    t, w, v = steps[TIME, lane], steps[W, lane], steps[V, lane]
    return Motion(t, 0.0, steps[SINE, lane], steps[COSINE, lane], True, w, v, False, 0.0, 0.0, 0.0, 0.0)


@compiled_into_callers
def count(piece, lane, steps, cycle):
    """Count a piece, and its flight, as stroboscopic_map.advance does."""
    steps[STEPS, lane] += 1.0
    if piece.kind == FLIGHT:
        cycle[AIRBORNE, lane] += piece.duration
        if piece.end == IMPACT:
            cycle[LONGEST, lane] = max(cycle[LONGEST, lane], cycle[AIRBORNE, lane])
            cycle[AIRBORNE, lane] = 0.0


@compiled_into_callers
def failed(motion, piece, lane, steps):
    """Whether stroboscopic_map.advance may fail here: it follows such a start once more, and tells."""
    finite = math.isfinite(motion.w) and math.isfinite(motion.v) and math.isfinite(motion.q)
    return piece.end == LOST or not finite or steps[STEPS, lane] > steps[MOST, lane]


@compiled_into_callers
def next_cycle(c, state, lane, steps, cycle):
    """The Motion at the beginning of a cycle from `state`, δ (m) and v (m/s)."""
    steps[STEPS, lane] = cycle[LONGEST, lane] = 0.0
    steps[END, lane] = c.period
    cycle[ORIGIN, lane] = BEGIN_OF_CYCLE
    return motion_at(c, -state[0], -state[1], 0.0, BEGIN_OF_CYCLE)


@functools.cache
def side_by_side(lanes: int):
    """The compiled function for a number of lanes.

    The number is all that it takes from its surroundings; numba could not cache it with a compiled function there.
    """

    @compiled
    def follow(parameters, tolerance, max_cycles, known, places, found, strobes, left, work):
        parameters, known, places, left = (
            no_refcount(parameters),
            no_refcounts(known),
            no_refcount(places),
            no_refcount(left),
        )
        points, outcomes, periods = no_refcount(found[0]), no_refcount(found[1]), no_refcount(found[2])
        flights, followed, strobes = no_refcount(found[3]), no_refcount(found[4]), no_refcount(strobes)
        steps, cycle, rows, state = (
            no_refcount(work[0]),
            no_refcount(work[1]),
            no_refcount(work[2]),
            no_refcount(work[3]),
        )
        series, pasts, numbers = no_refcount(work[4]), no_refcount(work[5]), no_refcount(work[6])
        constants = [contact.constants(parameters[0], tolerance)] * lanes
        waiting = running = 0
        stopped = (1 << lanes) - 1  # a bit for each lane
        while True:
            for lane in range(lanes):
                if not (stopped >> lane) & 1:
                    continue
                i, c, past, counts = rows[lane], constants[lane], pasts[lane], numbers[lane]
                motion = stopped_motion(lane, steps)
                piece = Piece(GRAZE, 0.0, 0.0, LIMIT, 0.0, 0.0, 0.0, 0.0)
                if i != NONE:
                    fetch(steps, lane, series, FIRST)
                    piece = press(c, series, FIRST, motion, steps[LENGTH, lane], steps[END, lane] - motion.t)
                while True:
                    over = i == NONE
                    if not over:
                        count(piece, lane, steps, cycle)
                        motion = arrive(c, motion, piece, cycle[ORIGIN, lane])
                        if failed(motion, piece, lane, steps):
                            left[i] = over = True
                        elif piece.end == LIMIT:
                            state[0], state[1] = delta_and_v(motion)
                            if counts[FOLLOWED] == ON_THE_WAY:
                                counts[FOLLOWED] = 0
                                cycle[AIRBORNE, lane] = 0.0
                            else:
                                if counts[FOLLOWED] < strobes.shape[1]:
                                    strobes[i, counts[FOLLOWED], 0] = state[0]
                                    strobes[i, counts[FOLLOWED], 1] = state[1]
                                flight = max(cycle[LONGEST, lane], cycle[AIRBORNE, lane])
                                outcome, period, longest = look(
                                    c, state, flight, max_cycles, known, places[i], past, counts
                                )
                                if outcome != GOES_ON:
                                    over = True
                                    points[i, 0], points[i, 1] = state[0], state[1]
                                    outcomes[i], periods[i], flights[i] = outcome, period, longest
                                    followed[i] = counts[FOLLOWED]
                            motion = next_cycle(c, state, lane, steps, cycle)
                    if over:
                        waiting = first_from(waiting, parameters, tolerance, left)
                        if waiting == len(parameters):
                            rows[lane] = NONE
                            running &= ~(1 << lane)
                            break
                        i = rows[lane] = waiting
                        waiting += 1
                        running |= 1 << lane
                        c = constants[lane] = contact.constants(parameters[i], tolerance)
                        motion = load(c, parameters[i], lane, steps, cycle, past, counts)
                    if motion.touching and not grazing(c, motion):
                        return_to_lane(motion, lane, steps)
                        break
                    piece = graze(c, motion) if motion.touching else fly(c, motion, steps[END, lane] - motion.t)
            if running == 0:
                return
            stopped = 0
            while stopped == 0:
                stopped = step(lanes, steps) & running

    return follow


def in_lanes(parameters, tolerance, cycles, known, places, found, strobes, left, lanes):
    """`settle_points` with a given number of lanes, a power of two. Every one gives the same bits.

    left : bool, shape (n,), filled: starts that cannot be followed in lanes, or not to the end; what was found of them
        says nothing
    """
    left[:] = cycles < 1
    if len(parameters) > 0 and cycles > 0:
        rows, state = np.full(lanes, NONE), np.empty(2)
        work = (room(lanes), np.zeros((3, lanes)), rows, state, contact.workspace(), *memory(lanes))
        side_by_side(lanes)(parameters, tolerance, cycles, known, places, found, strobes, left, work)


def settle_points(parameters, tolerance, cycles, known, places, found, strobes):
    """What settling.settle_points finds, which has the same parameters, in lanes where these do not stand idle."""
    left = np.ones(len(parameters), dtype=np.bool_)
    if len(parameters) >= SIDE_BY_SIDE:
        in_lanes(parameters, tolerance, cycles, known, places, found, strobes, left, LANES)
    if left.any():
        *alone, their_strobes = (column[left] for column in (*found, strobes))
        settling.settle_points(parameters[left], tolerance, cycles, known, places[left], tuple(alone), their_strobes)
        for column, values in zip((*found, strobes), (*alone, their_strobes), strict=True):
            column[left] = values
