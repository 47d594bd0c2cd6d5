"""The event loop: the vertical motion piece by piece (see vertical), slip and stick beside it (see horizontal).

Time is kept as whole excitation cycles plus a time within the cycle, so that the phase of a run of any length has the
same precision.
"""

import math

import numpy as np

from . import contact, contact_law, peaks, repeated_steps, vertical, workspace
from .contact import FORCE_SIGN, SEPARATION
from .flight import highest_gap
from .horizontal import (
    CONTACT_FORCE,
    FRICTION_FORCE,
    IMPACT,
    MAX_SEGMENTS,
    SAMPLES,
    SEPARATED,
    TENSION_BEGINS,
    TENSION_ENDS,
    VX,
    VZ,
    Horizontal,
    Record,
    Step,
    X,
    Z,
    follow_horizontal,
    record_event,
    slide,
    slip_direction,
)
from .jit import compiled, compiled_inline, compiled_into_callers, no_refcount
from .model import TENSION_CLIP, VZ0, Z0
from .status import IMPACT_LOST, NOT_FINITE, OK, TOO_MANY_EVENTS, TOO_STIFF
from .vertical import CONTACT, FLIGHT, LOST, TIME_LIMIT

# Phase at which a cycle begins, rad: the plate is at its top, where a part that leaves the plate is in the air.
BEGIN_OF_CYCLE = -math.pi


@compiled_into_callers
def time_into_cycle(c):
    """The time (s) in its cycle of the initial phase ψ0."""
    return ((c.psi0 - BEGIN_OF_CYCLE) % (2.0 * math.pi)) / c.omega


@compiled_inline
def time_to_next_cycle(c):
    """The time (s) from the initial phase ψ0 to the next beginning of a cycle; 0 if a cycle begins there."""
    return ((BEGIN_OF_CYCLE - c.psi0) % (2.0 * math.pi)) / c.omega


# On a track, parts move for thousands of cycles. A motion that after a block of cycles differs from itself by no more
# than this part of the plate's largest speed repeats itself. The cycles are whole periods of motions with the periods
# 1 to 6.
BLOCK, SAME = 60, 1e-10
# Pieces in one excitation cycle after which a run ends with "contact too stiff".
MAX_PIECES = 100_000
# Columns of the results of runs: the status code, numbers of events and of impacts, the time with contact force (s),
# the largest gap (m), numbers of computed and of repeated contact steps; the largest speed of approach at an impact
# (m/s) and the largest contact force (N) between the last two times of a run, 0 where there is none.
CODE, EVENTS, IMPACTS, CONTACT_TIME, MAX_GAP, STEPS, REPEATS, IMPACT_SPEED, PEAK_FORCE = range(9)
RESULTS = 9


def integrate(
    parameters: np.ndarray,
    times: np.ndarray,
    *,
    tolerance: float,
    feeding: bool = True,
    reuse: bool = True,
    event_times: np.ndarray | None = None,
    event_kinds: np.ndarray | None = None,
    distances: np.ndarray | None = None,
    arrivals: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Follow parts until the last of their `times` and sample them there.

    With `distances`, a part is followed no further than the last of them, and blocks of cycles in which its motion
    repeats itself are skipped, also by the counts in the results.

    Parameters
    ----------
    parameters : float64, shape (n, 16), see parameters.PARAMETERS
    times : float64, shape (n, k), s, ascending, ≥ 0; a run ends at its last one
    tolerance : relative error per step of the contact
    feeding : whether the horizontal motion is wanted; without it its columns are NaN
    reuse : whether steps of a settled motion are repeated instead of computed (see repeated_steps)
    event_times, event_kinds : float64 (s) and int8, shape (n, m), filled with the first m events of each
    distances : float64, shape (d,), m along the track, ascending, > 0
    arrivals : float64, shape (n, d), filled with the first times (s) at which a part is at each distance, to a small
        part of a cycle; NaN for distances that it does not reach

    Returns
    -------
    samples, results : float64, shape (n, k, 6), the columns horizontal.SAMPLES (m, m/s, N); shape (n, 9), see above
    """
    times = np.ascontiguousarray(times)  # numba would compile `follow`, for seconds, for each other layout
    n, k = times.shape
    samples, results = np.empty((n, k, len(SAMPLES))), np.empty((n, RESULTS))
    if event_times is None or event_kinds is None:
        event_times, event_kinds = np.empty((n, 0)), np.empty((n, 0), np.int8)
    if distances is None or arrivals is None:
        distances, arrivals = np.empty(0), np.empty((n, 0))
    # Plain tuples, because numba takes several microseconds per call to find the type of a named tuple.
    records = (times, samples, event_times, event_kinds, arrivals)
    follow(parameters, (tolerance, feeding, reuse), records, results, repeated_steps.new_arrays(), distances)
    return samples, results


@compiled_into_callers
def sample_flight(c, motion, horizontal, tau, sample):
    """Fill a `sample`, shape (6,), at a time tau (s) after the beginning of a flight."""
    sample[X], sample[VX] = slide(c, horizontal.x, horizontal.vx, tau)
    sample[Z], sample[VZ] = motion.z + (motion.vz - 0.5 * c.gravity * tau) * tau, motion.vz - c.gravity * tau
    sample[CONTACT_FORCE] = sample[FRICTION_FORCE] = 0.0


@compiled_into_callers
def peak_of_step(c, kept, place, at, has_series, motion, piece, first, last):
    """Largest F_c/m (m/s²) of the contact step in a place, from `first` to `last` (s) after its beginning.

    at, has_series : row in the workspace, and whether the series of the step is there; else it is written there
    """
    is_whole = first <= 0.0 and last >= piece.duration
    found = kept.steps[place, repeated_steps.PEAK] if is_whole else math.nan
    if is_whole and math.isnan(found) and peaks.is_monotonic(c, motion, piece):
        found = max(contact_law.force(c, motion.w, motion.v), contact_law.force(c, piece.w, piece.v))
    if math.isnan(found):
        if not has_series:
            repeated_steps.expand_again(c, kept, place, at)
        found = peaks.largest_force(c, kept.series, at, piece, first, last)
    if is_whole:
        kept.steps[place, repeated_steps.PEAK] = found
    return found


@compiled_into_callers
def next_cycle(c, motion, piece):
    """The same Motion with its time in the cycle in which a Piece ends, and the number of cycles that have begun."""
    if motion.t < c.period and piece.end != TIME_LIMIT:
        return motion, 0
    cycles = 1 if piece.end == TIME_LIMIT else int(motion.t / c.period)
    t = 0.0 if piece.end == TIME_LIMIT else max(motion.t - cycles * c.period, 0.0)
    return vertical.in_cycle(c, motion, t, BEGIN_OF_CYCLE), cycles


@compiled_into_callers
def touch_down(c, motion, horizontal):
    """The Horizontal motion of a part that has just come into contact."""
    force = contact_law.force(c, motion.w, motion.v)
    sigma = slip_direction(c, motion.sine, motion.cosine, horizontal.vx, force, c.static_friction)
    return Horizontal(horizontal.x, horizontal.vx, sigma)


@compiled_into_callers
def blocks_to_skip(c, before, after, left, ahead):
    """How many of the next blocks of cycles repeat the last one, and contain neither a sample nor an arrival.

    before, after : time into the cycle (s), w, v, velocity and position along the track (m/s, m) at both ends of it
    left : time to the next sample, s
    ahead : from the furthest position in the last block to the next distance, m
    """
    speed = max(c.a_x, c.a_z) / c.omega
    deviation = max(
        c.omega * speed * abs(after[0] - before[0]),
        c.omega * abs(after[1] ** 2 - before[1] ** 2),
        abs(after[2] - before[2]),
        abs(after[3] - before[3]),
    )
    if deviation > SAME * speed:
        return 0
    advance = after[4] - before[4]
    blocks = left / (BLOCK * c.period)
    if advance > 0.0:
        blocks = min(blocks, ahead / advance)
    return max(int((1.0 - SAME) * blocks), 0)  # never beyond the sample by a rounding error


@compiled
def follow(parameters, options, records, results, room, distances):
    """The compiled part of `integrate`.

    Parameters
    ----------
    options : tolerance, feeding and reuse, see `integrate`
    records : the fields of a Record and `arrivals`, each with one more axis in front, that of the runs
    results : filled, see `integrate`
    room : repeated_steps.new_arrays
    distances : see `integrate`

    Only Python calls this function, because numba would compile the whole solver again into each compiled caller. The
    loop over the runs is here for the same reason: as a function of its own, it would take 3 s more to compile.
    """
    tolerance, feeding, reuse = options
    times, samples, event_times, event_kinds, arrivals = no_refcount(records)
    series, kept_steps = no_refcount(room)
    kept = repeated_steps.KeptSteps(series, kept_steps)
    for i in range(parameters.shape[0]):
        record = Record(times[i], samples[i], event_times[i], event_kinds[i])
        row, result, arrival = parameters[i], no_refcount(results[i]), no_refcount(arrivals[i])
        repeated_steps.forget(kept)
        c = contact.constants(row, tolerance)
        end, since = record.times[-1], record.times[-2] if record.times.size > 1 else 0.0
        offset = time_into_cycle(c)
        cycle, base = 0, -offset
        q, rate = vertical.begin(c, row[Z0], row[VZ0], c.psi0)
        motion = vertical.motion_at(c, q, rate, offset, c.psi0)
        horizontal = Horizontal(0.0, 0.0, 0.0)
        if motion.touching:
            horizontal = touch_down(c, motion, horizontal)
        sampled = events = impacts = steps = repeats = pieces = place = arrived = block = 0
        compared, furthest = (0.0, 0.0, 0.0, 0.0, 0.0), 0.0
        contact_time = impact_speed = peak_force = 0.0
        max_gap = max(q, 0.0)
        status = OK

        while sampled < record.times.size:
            pieces += 1
            if pieces > MAX_PIECES:
                status = TOO_STIFF
                break
            at = workspace.FIRST + place * workspace.STEP
            begins, x_before = base + motion.t, horizontal.x
            is_kept = reuse and motion.touching and repeated_steps.repeats(c, kept, place, motion)
            if is_kept:
                piece = repeated_steps.recall(kept, place)
            else:
                limit = c.period - motion.t if motion.touching else end - begins
                piece = vertical.next_piece(c, kept.series, at, motion, limit)
                if piece.kind == CONTACT:
                    repeated_steps.keep(kept, place, motion, piece)
            ends = begins + piece.duration
            if piece.kind == FLIGHT:
                if piece.end == LOST:
                    status = IMPACT_LOST
                    break
                max_gap = max(max_gap, highest_gap(vertical.flight_from(c, motion), piece.duration))
                while sampled < record.times.size and (ends >= record.times[sampled] or piece.end == TIME_LIMIT):
                    sample_flight(c, motion, horizontal, record.times[sampled] - begins, record.samples[sampled])
                    sampled += 1
                if sampled == record.times.size:
                    break
                impacts += 1
                if ends >= since:
                    impact_speed = max(impact_speed, piece.v)
                events = record_event(record, events, ends, IMPACT)
            elif piece.kind == CONTACT:
                repeats, steps = repeats + is_kept, steps + (not is_kept)
                if not (motion.pulled and c.tension == TENSION_CLIP):
                    # A repeated step has the duration of the kept one, but counts up to the end of the cycle.
                    lasts = c.period - motion.t if piece.end == TIME_LIMIT else piece.duration
                    contact_time += min(lasts, end - begins)
                    if ends > since:
                        force = peak_of_step(c, kept, place, at, True, motion, piece, since - begins, end - begins)
                        peak_force = max(peak_force, force)
                place = min(place + 1, repeated_steps.PLACES - 1)
                step = Step(kept.series, at, motion, piece, begins)
                horizontal, sampled, events, segments = follow_horizontal(
                    c, step, horizontal, feeding, record, sampled, events
                )
                if sampled == record.times.size:
                    break
                if segments == MAX_SEGMENTS:
                    status = TOO_MANY_EVENTS
                    break
            if piece.kind != CONTACT:
                x, vx = slide(c, horizontal.x, horizontal.vx, piece.duration)
                horizontal = Horizontal(x, vx, horizontal.sigma)
            # A flight is uniform along the track, and a contact step is short.
            while arrived < arrival.size and horizontal.x >= distances[arrived]:
                arrival[arrived] = begins + piece.duration * (distances[arrived] - x_before) / (horizontal.x - x_before)
                arrived += 1
            furthest = max(furthest, horizontal.x)
            if arrived > 0 and arrived == arrival.size:
                break
            pulled = motion.pulled
            motion = vertical.arrive(c, motion, piece, BEGIN_OF_CYCLE)
            if not vertical.is_finite(motion):
                status = NOT_FINITE
                break
            if piece.end == SEPARATION and not motion.touching:
                events = record_event(record, events, ends, SEPARATED)
            elif piece.end == FORCE_SIGN:
                events = record_event(record, events, ends, TENSION_ENDS if pulled else TENSION_BEGINS)
            # Each cycle begins with a step of its own, so that its steps can be compared with the last cycle.
            motion, cycles = next_cycle(c, motion, piece)
            if cycles > 0:
                cycle += cycles
                if arrival.size > 0 and cycle >= block + BLOCK and motion.touching:
                    now = (motion.t, motion.w, motion.v, horizontal.vx, horizontal.x)
                    if cycle == block + BLOCK:
                        left = record.times[sampled] - (cycle * c.period - offset)
                        skipped = blocks_to_skip(c, compared, now, left, distances[arrived] - furthest)
                        cycle += skipped * BLOCK
                        x = horizontal.x + skipped * (horizontal.x - compared[4])
                        horizontal = Horizontal(x, horizontal.vx, horizontal.sigma)
                    block, compared, furthest = cycle, (now[0], now[1], now[2], now[3], horizontal.x), horizontal.x
                base = cycle * c.period - offset
                pieces = place = 0
            if piece.kind == FLIGHT and feeding:
                horizontal = touch_down(c, motion, horizontal)
        if not feeding:
            record.samples[:, X] = record.samples[:, VX] = record.samples[:, FRICTION_FORCE] = np.nan
        record.samples[sampled:] = np.nan
        arrival[arrived:] = np.nan
        result[CODE], result[EVENTS], result[IMPACTS] = status, events, impacts
        result[CONTACT_TIME], result[MAX_GAP] = contact_time, max_gap
        result[STEPS], result[REPEATS] = steps, repeats
        is_known = status == OK
        result[IMPACT_SPEED], result[PEAK_FORCE] = (impact_speed, c.mass * peak_force) if is_known else (np.nan, np.nan)
