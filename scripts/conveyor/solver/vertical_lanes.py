"""Vertical motions side by side, one trajectory in each lane of the processor's vector registers.

This twin of trajectory.integrate without the horizontal motion exists because it halves the time of maps. Lanes in
contact take their steps together (see contact_lanes); scalar code handles everything else that a trajectory does: an
event in a step, a flight, a repeated step, the end of a cycle. A trajectory gives the same bits as in
trajectory.integrate, whatever its lane and its neighbours are.
"""

import math

import numpy as np

from . import contact, contact_lanes, repeated_steps, trajectory, vertical
from .contact import NOTHING
from .contact_lanes import COSINE, END, LANES, LAPSE, LENGTH, NONE, ROWS, SINE, STEPS, V, W
from .flight import highest_gap
from .horizontal import SAMPLES, Horizontal, Step, first_segment, sample_contact
from .jit import compiled, compiled_inline, compiled_into_callers, no_refcount
from .model import VZ0, Z0
from .trajectory import BEGIN_OF_CYCLE, MAX_PIECES, next_cycle, peak_of_step, sample_flight, time_into_cycle
from .vertical import CONTACT, FLIGHT, LIMIT, LOST, Piece
from .workspace import FIRST

# The state of a lane's run: when it ends (s); the time at which its present cycle begins (s), and the number of the
# cycle; pieces in the cycle, contact steps among them; time with contact force (s), largest gap (m), impacts; the time
# (s) from which speeds of impacts (m/s) and contact forces per mass (m/s²) count, and the largest of both.
DURATION, BASE, CYCLE, PIECES, PLACE, CONTACT_TIME, MAX_GAP, IMPACTS, SINCE, IMPACT_SPEED, PEAK_FORCE = range(11)
COUNTS = 11
# Steps that end this close to the end of a run, in cycles, are scalar, because the last sample may lie in them.
MARGIN = 1e-6

# The piece of a lane that has had none.
NO_PIECE = Piece(CONTACT, 0.0, 0.0, NOTHING, 0.0, 0.0, 0.0, 0.0)
# What follows a piece.
GOES_ON, OVER, FAILED = range(3)


@compiled_inline
def begin_cycle(c, run, steps, lane):
    """Begin a cycle of a lane: its steps must end with the cycle, or just before the run ends."""
    run[BASE] = run[CYCLE] * c.period - time_into_cycle(c)
    run[PIECES] = run[PLACE] = steps[STEPS, lane] = 0.0
    steps[END, lane] = min(c.period, run[DURATION] - run[BASE] - MARGIN * c.period)


@compiled_into_callers
def begin_run(c, parameters, times, run, steps, lane, kept):
    """The Motion at the initial condition of `parameters`, shape (16,); resets all that is known of the lane."""
    repeated_steps.forget(kept)
    contact_lanes.set_constants(steps, lane, c)
    q, rate = vertical.begin(c, parameters[Z0], parameters[VZ0], c.psi0)
    run[SINCE], run[DURATION] = times
    run[CYCLE] = run[CONTACT_TIME] = run[IMPACTS] = run[IMPACT_SPEED] = run[PEAK_FORCE] = 0.0
    run[MAX_GAP] = max(q, 0.0)
    begin_cycle(c, run, steps, lane)
    return vertical.motion_at(c, q, rate, time_into_cycle(c), c.psi0)


@compiled_into_callers
def count(c, kept, motion, piece, run, sample):
    """Count a Piece as trajectory.follow does. Returns GOES_ON, OVER or FAILED."""
    begins = run[BASE] + motion.t
    ends, end = begins + piece.duration, run[DURATION]
    run[PIECES] += 1.0
    if piece.kind == FLIGHT:
        if piece.end == LOST:
            return FAILED
        run[MAX_GAP] = max(run[MAX_GAP], highest_gap(vertical.flight_from(c, motion), piece.duration))
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
            first, place = run[SINCE] - begins, int(run[PLACE])
            force = peak_of_step(c, kept, place, FIRST, False, motion, piece, first, end - begins)
            run[PEAK_FORCE] = max(run[PEAK_FORCE], force)
        if ends >= end:
            repeated_steps.expand_again(c, kept, int(run[PLACE]), FIRST)
            segment = first_segment(c, motion, Horizontal(0.0, 0.0, 0.0))
            sample_contact(c, Step(kept.series, FIRST, motion, piece, begins), segment, end - begins, sample)
            return OVER
        run[PLACE] = min(run[PLACE] + 1.0, repeated_steps.PLACES - 1)
    # A run that scalar code may give up is left to scalar code.
    return FAILED if run[PIECES] >= MAX_PIECES else GOES_ON


@compiled_into_callers
def advance(c, kept, motion, piece, run, steps, lane, sample):
    """GOES_ON, OVER or FAILED after a Piece that begins with `motion`, and the Motion at its end."""
    answer = count(c, kept, motion, piece, run, sample)
    if answer == GOES_ON:
        motion = vertical.arrive(c, motion, piece, BEGIN_OF_CYCLE)
        if not vertical.is_finite(motion):
            answer = FAILED
    if answer == GOES_ON:
        motion, cycles = next_cycle(c, motion, piece)
        if cycles > 0:
            run[CYCLE] += cycles
            begin_cycle(c, run, steps, lane)
    return answer, motion


@compiled_into_callers
def step_of_lane(c, kept, motion, run, steps, lane, is_stopped):
    """The contact step that a lane took with the others, or takes alone if it `is_stopped`; keeps it."""
    if is_stopped:
        contact_lanes.copy_series(steps, lane, kept.series, FIRST)
        piece = vertical.press(c, kept.series, FIRST, motion, steps[LENGTH, lane], c.period - motion.t)
    else:
        w, v, sine, cosine = steps[W, lane], steps[V, lane], steps[SINE, lane], steps[COSINE, lane]
        piece = Piece(CONTACT, steps[LAPSE, lane], steps[LENGTH, lane], NOTHING, w, v, sine, cosine)
    repeated_steps.keep(kept, int(run[PLACE]), motion, piece)
    return piece


@compiled_into_callers
def repeat_steps(c, kept, motion, run):
    """The Motion after all kept steps that repeat one after the other and only need to be counted.

    Without this loop, `advance` would take these steps, and a map would take 8 % longer, settled runs of 4 s 47 %. The
    loop leaves a step to `advance` if an event, the cycle or the run ends in it, or if its peak is not known yet. A
    known peak is already in the run's largest force.
    """
    contact_time = run[CONTACT_TIME]
    first = place = int(run[PLACE])
    while place < repeated_steps.PLACES - 1 and repeated_steps.repeats(c, kept, place, motion):
        piece, peak = repeated_steps.recall(kept, place), kept.steps[place, repeated_steps.PEAK]
        ends = run[BASE] + motion.t + piece.duration
        if piece.end != NOTHING or ends >= run[DURATION] or motion.t + piece.duration >= c.period:
            break
        if ends > run[SINCE] and math.isnan(peak):
            break
        contact_time += piece.duration
        motion = vertical.arrive(c, motion, piece, BEGIN_OF_CYCLE)
        place += 1
    run[PIECES], run[PLACE], run[CONTACT_TIME] = run[PIECES] + (place - first), place, contact_time
    return motion


@compiled_into_callers
def write_result(c, run, result):
    """Fill the `result`, shape (RESULTS,), of a run that has reached its end."""
    result[trajectory.CODE] = trajectory.OK
    result[trajectory.IMPACTS], result[trajectory.MAX_GAP] = run[IMPACTS], run[MAX_GAP]
    result[trajectory.CONTACT_TIME] = run[CONTACT_TIME]
    result[trajectory.IMPACT_SPEED] = run[IMPACT_SPEED]
    result[trajectory.PEAK_FORCE] = c.mass * run[PEAK_FORCE]


@compiled
def follow(parameters, tolerance, times, samples, results, left, work):
    """The compiled part of `integrate`.

    Parameters
    ----------
    left : bool, shape (n,), filled: runs that lanes cannot follow, or not to the end
    work : the memory of contact_lanes, the state of each lane's run, shape (LANES, COUNTS), the row that each lane
        follows, a contact.workspace, and the kept steps of each lane
    """
    parameters, times, samples, results, left = no_refcount((parameters, times, samples, results, left))
    memory, steps, runs, rows, series, kept_steps = no_refcount(work)
    constants = [contact.constants(parameters[0], tolerance)] * LANES
    motions = [vertical.motion_at(constants[0], 0.0, 0.0, 0.0, 0.0)] * LANES
    waiting = running = 0
    stopped = 0  # a bit for each lane
    while True:
        for lane in range(LANES):
            i, c, motion, run = rows[lane], constants[lane], motions[lane], runs[lane]
            kept = repeated_steps.KeptSteps(series, kept_steps[lane])
            piece = NO_PIECE
            if i != NONE:
                piece = step_of_lane(c, kept, motion, run, steps, lane, (stopped >> lane) & 1)
            while True:
                answer = OVER
                if i != NONE:
                    answer, motion = advance(c, kept, motion, piece, run, steps, lane, samples[i])
                    if answer == FAILED:
                        left[i] = True
                    elif answer == OVER:
                        write_result(c, run, results[i])
                while answer != GOES_ON:
                    waiting, running = contact_lanes.refill(lane, rows, waiting, running, len(parameters))
                    i = rows[lane]
                    if i == NONE:
                        break
                    c = constants[lane] = contact.constants(parameters[i], tolerance)
                    if contact_lanes.can_follow(c):
                        motion = begin_run(c, parameters[i], times[i], run, steps, lane, kept)
                        answer = GOES_ON
                    else:
                        left[i] = True
                if i == NONE:
                    break
                if motion.touching:
                    motion = repeat_steps(c, kept, motion, run)
                place = int(run[PLACE])
                if motion.touching and repeated_steps.repeats(c, kept, place, motion):
                    piece = repeated_steps.recall(kept, place)
                elif not motion.touching:
                    piece = vertical.fly(c, motion, run[DURATION] - (run[BASE] + motion.t))
                elif vertical.is_grazing(c, motion):
                    piece = vertical.graze(c, motion)
                else:
                    contact_lanes.set_motion(motion, lane, steps)
                    motions[lane] = motion
                    break
        if running == 0:
            return
        stopped = contact_lanes.step(memory, LANES) & running


def integrate(parameters: np.ndarray, times: np.ndarray, *, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Follow parts without their horizontal motion, and sample them at the end.

    Parameters and results as in trajectory.integrate, with three differences: `times` has the shape (n, 2),
    samples, shape (n, 6), belong to the second time, and the numbers of events and steps are NaN.
    """
    n = len(parameters)
    samples, results = np.empty((n, len(SAMPLES))), np.full((n, trajectory.RESULTS), np.nan)
    left = np.full(n, n < LANES)
    if n >= LANES:
        steps = np.full((LANES, repeated_steps.PLACES, repeated_steps.COLUMNS), np.inf)
        work = (
            *contact_lanes.new_memory(ROWS),
            np.empty((LANES, COUNTS)),
            np.full(LANES, NONE),
            contact.workspace(),
            steps,
        )
        follow(parameters, tolerance, times, samples, results, left, work)
    if left.any():
        found, results[left] = trajectory.integrate(parameters[left], times[left], tolerance=tolerance, feeding=False)
        samples[left] = found[:, 1]
    return samples, results
