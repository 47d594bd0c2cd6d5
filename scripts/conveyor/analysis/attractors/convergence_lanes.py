"""Follow trajectories to their attractors side by side, one in each lane of the vector registers.

Lanes in contact take their steps together (see contact_lanes). One by one, the trajectories of a map would take 2.3
times as long, on one conveyor with known attractors as well as over many. A lane leaves them for scalar code at each
event, at the end of a cycle, and when its trajectory ends and the next one takes its place. Scalar code also follows
the contacts that lanes cannot follow, and single trajectories. A trajectory gives the same bits either way, whatever
its lane and its neighbours are.
"""

import functools
from collections import namedtuple

import numpy as np

from ...parallel import call_interruptibly
from ...solver import contact, contact_lanes, pieces, plate, vertical
from ...solver.contact_lanes import COSINE, END, LANES, LENGTH, NONE, SINE, STEPS, TIME, V, W
from ...solver.jit import compiled_entry, compiled_into_callers, no_refcount
from ...solver.model import VZ0, Z0
from ...solver.pieces import BEGIN_OF_CYCLE, time_to_next_cycle
from ...solver.status import OK
from ...solver.vertical import FLIGHT, GRAZE, LANDING, TIME_LIMIT, Motion, Piece
from ...solver.workspace import FIRST
from ..stroboscopic_map import delta_and_v
from . import convergence
from .convergence import BEFORE_FIRST_CYCLE, FOLLOWED, GOES_ON, PAST

# The smallest number of trajectories in lanes: a single one takes about a tenth less time in scalar code.
SIDE_BY_SIDE = 2

# The state of a lane's present cycle: time since the last separation (s), longest flight that ended in the cycle (s),
# phase of the excitation at its beginning (rad).
AIRBORNE, LONGEST, ORIGIN = range(3)

# Excitation cycles of all trajectories, which take some tenths of a second.
LONG = 10_000

# The arguments of `follow_all_to_attractors` that say when a search is over, and the array of strobes. The number of
# cycles is an array, shape (1,), because Ctrl-C sets it to zero.
Search = namedtuple("Search", "max_cycles attractors rows strobes")


@compiled_into_callers
def begin_trajectory(c, parameters, lane, memory, steps, cycle, counts):
    """The Motion at the initial condition of `parameters`, shape (16,); resets all that is known of the lane."""
    contact_lanes.set_constants(memory, steps, lane, c)
    for k in range(4):
        counts[k] = BEFORE_FIRST_CYCLE if k == FOLLOWED else 0
    # The first whole cycle begins within one cycle.
    steps[END, lane] = time_to_next_cycle(c)
    steps[STEPS, lane] = cycle[LONGEST, lane] = cycle[AIRBORNE, lane] = 0.0
    cycle[ORIGIN, lane] = c.psi0
    q, rate = vertical.begin(c, parameters[Z0], parameters[VZ0], c.psi0)
    return vertical.motion_at(c, q, rate, 0.0, c.psi0)


@compiled_into_callers
def stopped_motion(lane, steps):
    """The Motion in contact at which a lane stopped; fields that matter in flight only are zero."""
    t, w, v = steps[TIME, lane], steps[W, lane], steps[V, lane]
    return Motion(t, 0.0, steps[SINE, lane], steps[COSINE, lane], True, w, v, False, 0.0, 0.0, 0.0, 0.0)


@compiled_into_callers
def count_piece(piece, lane, steps, cycle):
    """Count a piece, and its flight, as stroboscopic_map.advance does."""
    steps[STEPS, lane] += 1.0
    if piece.kind == FLIGHT:
        cycle[AIRBORNE, lane] += piece.duration
        if piece.end == LANDING:
            cycle[LONGEST, lane] = max(cycle[LONGEST, lane], cycle[AIRBORNE, lane])
            cycle[AIRBORNE, lane] = 0.0


@compiled_into_callers
def end_cycle(c, i, lane, motion, cycle, search, past, counts, ends):
    """Whether the search of trajectory i is over with the `motion` at the end of a cycle."""
    state = ends.states[i]
    state[0], state[1] = delta_and_v(motion)
    cycles = counts[FOLLOWED]
    if 0 <= cycles < search.strobes.shape[1]:
        search.strobes[i, cycles, 0], search.strobes[i, cycles, 1] = state[0], state[1]
    flight = max(cycle[LONGEST, lane], cycle[AIRBORNE, lane])
    outcome, period, longest = convergence.check_convergence(
        c, state, flight, search.max_cycles[0], search.attractors, search.rows[i], past, counts
    )
    ends.followed[i] = counts[FOLLOWED]
    if cycles == BEFORE_FIRST_CYCLE:
        cycle[AIRBORNE, lane] = 0.0
    if outcome == GOES_ON:
        return False
    ends.outcomes[i], ends.periods[i], ends.flights[i] = outcome, period, longest
    return True


@compiled_into_callers
def begin_cycle(c, state, lane, steps, cycle):
    """The Motion at the beginning of a cycle from `state`, δ (m) and v (m/s)."""
    steps[STEPS, lane] = cycle[LONGEST, lane] = 0.0
    steps[END, lane] = c.period
    cycle[ORIGIN, lane] = BEGIN_OF_CYCLE
    return vertical.motion_at(c, -state[0], -state[1], 0.0, BEGIN_OF_CYCLE)


@functools.cache
def compiled_for(harmonics):
    """The compiled part of `follow_all_to_attractors` for plates with a number of harmonics, or None."""

    @compiled_entry
    def follow(parameters, tolerance, search, ends, side_by_side, work):
        """Follow trajectories.

        Parameters
        ----------
        search : a Search
        ends : convergence.new_trajectories, filled
        side_by_side : whether lanes take contact steps together; otherwise one trajectory follows the other
        work : the memory of contact_lanes, the state of each lane's cycle, shape (3, LANES), the trajectory of each
            lane, a contact.workspace, and history and counters of each lane's search
        """
        parameters, search, ends = no_refcount((parameters, search, ends))
        memory, steps, cycle, trajectories, series, histories, counters = no_refcount(work)
        constants = [contact.compute_constants(parameters[0], tolerance, harmonics)] * LANES
        waiting = running = 0
        stopped = (1 << LANES) - 1  # a bit for each lane
        while True:
            for lane in range(LANES):
                if not (stopped >> lane) & 1:
                    continue
                i, c, past, counts = trajectories[lane], constants[lane], histories[lane], counters[lane]
                motion = stopped_motion(lane, steps)
                piece = Piece(GRAZE, 0.0, 0.0, TIME_LIMIT, 0.0, 0.0, 0.0, 0.0, False)
                if i != NONE:
                    contact_lanes.copy_series(steps, lane, series, FIRST)
                    piece = vertical.press(c, series, FIRST, motion, steps[LENGTH, lane], steps[END, lane] - motion.t)
                while True:
                    over = i == NONE
                    if not over:
                        clock = pieces.clock_of(cycle[ORIGIN, lane], int(steps[STEPS, lane]))
                        motion, _, status = pieces.end_piece(c, series, clock, motion, piece)
                        count_piece(piece, lane, steps, cycle)
                        over = status != OK
                        if piece.end == TIME_LIMIT and not over:
                            over = end_cycle(c, i, lane, motion, cycle, search, past, counts, ends)
                            motion = begin_cycle(c, ends.states[i], lane, steps, cycle)
                    if over:
                        waiting, running = contact_lanes.refill(lane, trajectories, waiting, running, len(parameters))
                        i = trajectories[lane]
                        if i == NONE:
                            break
                        c = constants[lane] = contact.compute_constants(parameters[i], tolerance, harmonics)
                        motion = begin_trajectory(c, parameters[i], lane, memory, steps, cycle, counts)
                    if (
                        side_by_side
                        and contact_lanes.can_follow(c)
                        and motion.touching
                        and not vertical.is_grazing(c, motion)
                    ):
                        contact_lanes.set_motion(motion, lane, steps)
                        break
                    piece = vertical.next_piece(c, series, FIRST, motion, steps[END, lane] - motion.t)
            if running == 0:
                return
            stopped = 0
            while stopped == 0:
                stopped = contact_lanes.step(memory, LANES, harmonics) & running

    return follow


def follow_all_to_attractors(parameters, tolerance, max_cycles, attractors, rows, strobes=None):
    """The Trajectories from initial conditions until they are periodic or have reached a known attractor.

    Parameters
    ----------
    parameters : float64, shape (n, 16)
    tolerance : of the contact steps
    max_cycles : excitation cycles after which a search ends, at least one
    attractors, rows : an AttractorTable, and its `rows_of` the parameters, shape (n, 4)
    strobes : float64, shape (n, m, 2), filled with the states after each of the first m cycles
    """
    ends = convergence.new_trajectories(len(parameters))
    if len(parameters) > 0:
        harmonics = plate.count_harmonics(parameters)
        strobes = np.empty((len(parameters), 0, 2)) if strobes is None else strobes
        trajectories, side_by_side = np.full(LANES, NONE), len(parameters) >= SIDE_BY_SIDE
        work = (
            *contact_lanes.new_memory(contact_lanes.row_count(harmonics)),
            np.zeros((3, LANES)),
            trajectories,
            contact.workspace(),
            np.empty((LANES, 3, PAST)),
            np.empty((LANES, 4), np.int64),
        )
        follow, limit = compiled_for(harmonics), np.array([max_cycles])

        def run():
            follow(parameters, tolerance, Search(limit, attractors, rows, strobes), ends, side_by_side, work)

        call_interruptibly(run, lambda: limit.fill(0), is_long=len(parameters) * max_cycles > LONG)
    return ends
