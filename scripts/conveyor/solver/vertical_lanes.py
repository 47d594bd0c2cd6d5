"""Vertical runs of many trajectories at once, one in each lane of the processor's vector registers.

Lanes in contact take their steps together, see contact_lanes. Whatever else a trajectory does (an event in a step, a
flight, a repeated step, the end of a cycle) is scalar code. A run has the bits that trajectory.integrate gives it
without the horizontal motion, whatever its lane and its neighbours are; on maps it takes about half the time.
"""

import functools
import math

import numpy as np

from . import contact, memory, peaks, trajectory
from .contact import FIRST, NOTHING
from .contact_lanes import COSINE, END, LAPSE, LENGTH, SINE, V, W, enter, fetch, first_from, return_to_lane, room, step
from .flight import highest_gap
from .horizontal import SAMPLES, Horizontal, Step, first_segment, sample_contact
from .jit import compiled, compiled_inline, compiled_into_callers, no_refcount
from .model import VZ0, Z0
from .trajectory import BEGIN_OF_CYCLE, MAX_PIECES, next_cycle, patience, sample_flight
from .vertical import (
    CONTACT,
    FLIGHT,
    LIMIT,
    LOST,
    Piece,
    arrive,
    begin,
    fly,
    graze,
    grazing,
    motion_at,
    press,
    take_off,
)

# Eight lanes wait longer for those with an event: no gain where they were measured.
LANES = 4
# The row of a lane without a trajectory.
NONE = -1
# What is known of a lane's run: when it ends (s); the time at which its present cycle begins (s), and the number of the
# cycle; pieces in the cycle, contact steps among them; time with contact force (s), largest gap (m), impacts; the time
# (s) from which speeds of impacts (m/s) and contact forces per mass (m/s²) count, and the largest of both.
DURATION, BASE, CYCLE, PIECES, PLACE, CONTACT_TIME, MAX_GAP, IMPACTS, SINCE, IMPACT_SPEED, PEAK_FORCE = range(11)
COUNTS = 11
# Steps that end this close to the end of a run, in cycles, are scalar: the last sample may lie in them.
MARGIN = 1e-6
# Steps that a lane may take: their number is looked at here.
ANY = 1e300

# For a lane that has none yet.
NO_PIECE = Piece(CONTACT, 0.0, 0.0, NOTHING, 0.0, 0.0, 0.0, 0.0)
# What a piece leads to.
GOES_ON, OVER, FAILED = range(3)


@compiled_inline
def begin_cycle(c, run, steps, lane):
    """Let a lane's steps end with the cycle, or just before the run does."""
    run[BASE] = run[CYCLE] * c.period - ((c.psi0 - BEGIN_OF_CYCLE) % (2.0 * math.pi)) / c.omega
    run[PIECES] = run[PLACE] = 0.0
    steps[END, lane] = min(c.period, run[DURATION] - run[BASE] - MARGIN * c.period)


@compiled_into_callers
def load(c, parameters, times, run, steps, lane, kept):
    """The Motion at the beginning of a trajectory, shape (16,), that comes into a lane."""
    memory.forget(kept)
    enter(steps, lane, c, ANY)
    q, rate = begin(c, parameters[Z0], parameters[VZ0], c.psi0)
    run[SINCE], run[DURATION] = times
    run[CYCLE] = run[CONTACT_TIME] = run[IMPACTS] = run[IMPACT_SPEED] = run[PEAK_FORCE] = 0.0
    run[MAX_GAP] = max(q, 0.0)
    begin_cycle(c, run, steps, lane)
    return motion_at(c, q, rate, ((c.psi0 - BEGIN_OF_CYCLE) % (2.0 * math.pi)) / c.omega, c.psi0)


@compiled_into_callers
def find_series(c, kept, again, run, steps, lane):
    """Write the series of a lane's last step into the workspace; one that is taken `again` has it no longer."""
    if again:
        w, v, sine, cosine = memory.beginning(kept, int(run[PLACE]))
        contact.begin_step(c, kept.series, FIRST, w, v, sine, cosine, False)
    else:
        fetch(steps, lane, kept.series, FIRST)


@compiled_into_callers
def peak_of_step(c, kept, motion, piece, again, run, steps, lane):
    """Largest F_c/m (m/s²) of a lane's contact step where it counts, see trajectory.peak_of_step."""
    begins, place = run[BASE] + motion.t, int(run[PLACE])
    first, last = run[SINCE] - begins, run[DURATION] - begins
    is_whole = not (first > 0.0 or last < piece.duration)
    if is_whole:
        found = kept.steps[place, memory.PEAK]
        if not math.isnan(found):
            return found
        if peaks.is_monotonic(c, motion, piece):
            found = peaks.largest_force_at_ends(c, motion, piece)
            kept.steps[place, memory.PEAK] = found
            return found
    find_series(c, kept, again, run, steps, lane)
    if is_whole:
        found = peaks.largest_force(c, kept.series, FIRST, 0.0, piece.length)
        kept.steps[place, memory.PEAK] = found
        return found
    return peaks.largest_force_between(c, kept.series, FIRST, piece, first, last)


@compiled_into_callers
def finish_contact(c, kept, motion, piece, again, run, steps, lane, sample):
    """Sample a run that ends within a contact step."""
    find_series(c, kept, again, run, steps, lane)
    begins = run[BASE] + motion.t
    segment = first_segment(c, motion, Horizontal(0.0, 0.0, 0.0))
    sample_contact(c, Step(kept.series, FIRST, motion, piece, begins), segment, run[DURATION] - begins, sample)


@compiled_into_callers
def count(c, kept, motion, piece, again, run, steps, lane, sample):
    """Count a Piece as trajectory.follow_part does; what it leads to."""
    begins = run[BASE] + motion.t
    ends, end = begins + piece.duration, run[DURATION]
    run[PIECES] += 1.0
    if piece.kind == FLIGHT:
        if piece.end == LOST:
            return FAILED
        run[MAX_GAP] = max(run[MAX_GAP], highest_gap(take_off(c, motion), piece.duration))
        if ends >= end or piece.end == LIMIT:
            sample_flight(c, motion, Horizontal(0.0, 0.0, 0.0), end - begins, sample)
            return OVER
        run[IMPACTS] += 1.0
        if ends >= run[SINCE]:
            run[IMPACT_SPEED] = max(run[IMPACT_SPEED], piece.v)
    elif piece.kind == CONTACT:
        lasts = c.period - motion.t if piece.end == LIMIT else piece.duration
        run[CONTACT_TIME] += min(lasts, end - begins)
        if ends > run[SINCE]:
            run[PEAK_FORCE] = max(run[PEAK_FORCE], peak_of_step(c, kept, motion, piece, again, run, steps, lane))
        if ends >= end:
            finish_contact(c, kept, motion, piece, again, run, steps, lane, sample)
            return OVER
        run[PLACE] = min(run[PLACE] + 1.0, memory.PLACES - 1)
    # Where the scalar code may give up, it decides.
    return FAILED if 2.0 * run[PIECES] > min(MAX_PIECES, patience(c)) else GOES_ON


@compiled_into_callers
def advance(c, kept, motion, piece, again, run, steps, lane, sample):
    """What a Piece that begins with `motion` leads to, and the Motion at its end."""
    answer = count(c, kept, motion, piece, again, run, steps, lane, sample)
    if answer == GOES_ON:
        motion = arrive(c, motion, piece, BEGIN_OF_CYCLE)
        if not (math.isfinite(motion.w) and math.isfinite(motion.v) and math.isfinite(motion.t)):
            answer = FAILED
    if answer == GOES_ON:
        motion, cycles = next_cycle(c, motion, piece)
        if cycles > 0:
            run[CYCLE] += cycles
            begin_cycle(c, run, steps, lane)
    return answer, motion


@compiled_into_callers
def step_of_lane(c, kept, motion, run, steps, lane, is_stopped):
    """The contact step, kept, that a lane took with the others, or that it has to take alone if it `is_stopped`."""
    if is_stopped:
        fetch(steps, lane, kept.series, FIRST)
        piece = press(c, kept.series, FIRST, motion, steps[LENGTH, lane], c.period - motion.t)
    else:
        w, v, sine, cosine = steps[W, lane], steps[V, lane], steps[SINE, lane], steps[COSINE, lane]
        piece = Piece(CONTACT, steps[LAPSE, lane], steps[LENGTH, lane], NOTHING, w, v, sine, cosine)
    memory.keep(kept, int(run[PLACE]), motion, piece)
    return piece


@functools.cache
def side_by_side(lanes: int):
    """The compiled function for a number of lanes.

    The number is all that it takes from its surroundings; numba could not cache it with a compiled function there.
    """

    @compiled
    def follow(parameters, tolerance, times, samples, results, left, work):
        parameters, times, samples = no_refcount(parameters), no_refcount(times), no_refcount(samples)
        results, left = no_refcount(results), no_refcount(left)
        steps, runs, rows = no_refcount(work[0]), no_refcount(work[1]), no_refcount(work[2])
        series, kept_steps = no_refcount(work[3]), no_refcount(work[4])
        constants = [contact.constants(parameters[0], tolerance)] * lanes
        motions = [motion_at(constants[0], 0.0, 0.0, 0.0, 0.0)] * lanes
        waiting = running = 0
        stopped = 0  # a bit for each lane
        while True:
            for lane in range(lanes):
                i, c, motion, run = rows[lane], constants[lane], motions[lane], runs[lane]
                kept = memory.Memory(series, kept_steps[lane])
                again = False
                piece = NO_PIECE
                if i != NONE:
                    piece = step_of_lane(c, kept, motion, run, steps, lane, (stopped >> lane) & 1)
                while True:
                    answer = OVER
                    if i != NONE:
                        answer, motion = advance(c, kept, motion, piece, again, run, steps, lane, samples[i])
                        if answer == FAILED:
                            left[i] = True
                        elif answer == OVER:
                            results[i, trajectory.CODE] = trajectory.OK
                            results[i, trajectory.IMPACTS], results[i, trajectory.MAX_GAP] = run[IMPACTS], run[MAX_GAP]
                            results[i, trajectory.CONTACT_TIME] = run[CONTACT_TIME]
                            results[i, trajectory.IMPACT_SPEED] = run[IMPACT_SPEED]
                            results[i, trajectory.PEAK_FORCE] = c.mass * run[PEAK_FORCE]
                    if answer != GOES_ON:
                        waiting = first_from(waiting, parameters, tolerance, left)
                        if waiting == len(parameters):
                            rows[lane] = NONE
                            running &= ~(1 << lane)
                            break
                        i = rows[lane] = waiting
                        waiting += 1
                        running |= 1 << lane
                        c = constants[lane] = contact.constants(parameters[i], tolerance)
                        motion = load(c, parameters[i], times[i], run, steps, lane, kept)
                    place = int(run[PLACE])
                    again = motion.touching and memory.repeats(c, kept, place, motion)
                    if again:
                        piece = memory.recall(kept, place)
                    elif not motion.touching:
                        piece = fly(c, motion, run[DURATION] - (run[BASE] + motion.t))
                    elif grazing(c, motion):
                        piece = graze(c, motion)
                    else:
                        return_to_lane(motion, lane, steps)
                        motions[lane] = motion
                        break
            if running == 0:
                return
            stopped = step(lanes, steps) & running

    return follow


def integrate(
    parameters: np.ndarray, times: np.ndarray, *, tolerance: float, lanes: int = LANES
) -> tuple[np.ndarray, np.ndarray]:
    """Follow parts and sample them at the end, without the horizontal motion.

    Parameters and results are those of trajectory.integrate with two `times` each, shape (n, 2), but samples, of the
    shape (n, 6), are of the second time only; numbers of events and steps are not counted (NaN).
    """
    n = len(parameters)
    samples, results = np.empty((n, len(SAMPLES))), np.full((n, trajectory.RESULTS), np.nan)
    left = np.full(n, n < lanes)
    if n >= lanes:
        steps = np.empty((lanes, memory.PLACES, memory.COLUMNS))
        work = (room(lanes), np.empty((lanes, COUNTS)), np.full(lanes, NONE), contact.workspace(), steps)
        side_by_side(lanes)(parameters, tolerance, times, samples, results, left, work)
    if left.any():
        found, results[left] = trajectory.integrate(parameters[left], times[left], tolerance=tolerance, feeding=False)
        samples[left] = found[:, 1]
    return samples, results
