"""The event loop: the vertical motion piece by piece (see vertical), slip and stick beside it (see horizontal).

Time is kept as whole excitation cycles plus a time within the cycle, so that the phase of a run of any length has the
same precision.
"""

import math

import numpy as np

from . import contact, memory
from .contact import FORCE_SIGN, NOTHING, SEPARATION
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
    X,
    Z,
    feed,
    note,
    slip_direction,
)
from .jit import borrowed, kernel
from .model import TENSION_CLIP, VZ0, Z0
from .vertical import CONTACT, FLIGHT, LIMIT, LOST, arrive, begin, in_cycle, motion_at, next_piece

# Phase at which a cycle is taken to begin, rad: the plate's top, where a part that leaves the plate is in the air.
BEGIN_OF_CYCLE = -math.pi

# Status of a run.
OK, TOO_MANY_EVENTS, TOO_STIFF, IMPACT_LOST, NOT_FINITE = range(5)
STATUS = ("ok", "too many events", "contact too stiff", "impact not found", "not finite")

# Pieces within one excitation cycle after which a contact is too stiff to be followed.
MAX_PIECES = 100_000
# A contact whose own rates would need this many times as many steps in a cycle is given up after so many steps in a row
# without an event: it would last a fiftieth of the cycle at most.
HOPELESS = 50.0
PATIENCE = 10_000


@kernel
def patience(c):
    """Contact steps in a row without an event after which a contact is too stiff to be followed.

    Its own rates, d_c/m and the frequency at the static penetration, tell how many steps it would need in a cycle.
    """
    rate = max(c.damping, c.scale_v / (c.scale_w * c.scale_w))
    return PATIENCE if rate * c.period > HOPELESS * MAX_PIECES else MAX_PIECES


# Columns of the results of runs: the status code, numbers of events and of impacts, the time with contact force (s),
# the largest gap (m), numbers of contact steps that were computed and repeated.
CODE, EVENTS, IMPACTS, CONTACT_TIME, MAX_GAP, STEPS, REPEATS = range(7)


def integrate(
    parameters: np.ndarray,
    times: np.ndarray,
    *,
    tolerance: float,
    feeding: bool = True,
    reuse: bool = True,
    event_times: np.ndarray | None = None,
    event_kinds: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Follow parts until the last of their `times` and sample them there.

    Parameters
    ----------
    parameters : float64, shape (n, 13), see model.PARAMETERS
    times : float64, shape (n, k), s, ascending, ≥ 0; a run ends at its last one
    tolerance : relative error per step of the contact
    feeding : whether the horizontal motion is wanted; without it its columns are NaN
    reuse : whether steps of a settled motion are repeated instead of computed (see memory)
    event_times, event_kinds : float64 (s) and int8, shape (n, m), filled with the first m events of each

    Returns
    -------
    samples, results : float64, shape (n, k, 6), the columns horizontal.SAMPLES (m, m/s, N); shape (n, 7), see above
    """
    times = np.ascontiguousarray(times)  # `follow` would be compiled, for seconds, for every other layout
    n, k = times.shape
    samples, results = np.empty((n, k, len(SAMPLES))), np.empty((n, REPEATS + 1))
    if event_times is None or event_kinds is None:
        event_times, event_kinds = np.empty((n, 0)), np.empty((n, 0), np.int8)
    room = memory.room()
    follow(parameters, tolerance, feeding, reuse, times, samples, event_times, event_kinds, results, *room)
    return samples, results


@kernel
def follow(rows, tolerance, feeding, reuse, moments, values, instants, kinds, results, series, kept):
    """`integrate` with its arrays in order, and the room for contact steps that `memory` gives.

    All that follows runs is this one kernel, which nothing compiled calls: it would be compiled into each caller.
    """
    series, kept = borrowed(series), borrowed(kept)
    for i in range(rows.shape[0]):
        memory.clear(series, kept)
        times, samples = borrowed(moments[i]), borrowed(values[i])
        event_times, event_kinds = borrowed(instants[i]), borrowed(kinds[i])
        c = contact.constants(rows[i], tolerance)
        most = patience(c)
        end = times[-1]
        offset = ((c.psi0 - BEGIN_OF_CYCLE) % (2.0 * math.pi)) / c.omega
        cycle = 0
        base = -offset
        q, rate = begin(c, rows[i, Z0], rows[i, VZ0], c.psi0)
        motion = motion_at(c, q, rate, offset, c.psi0)
        x = vx = sigma = 0.0
        if motion.touching:
            force = contact.force(c, motion.w, motion.v)
            sigma = slip_direction(c, motion.sine, motion.cosine, vx, force, c.friction)
        sampled = 0
        events = impacts = steps = repeats = pieces = lone = place = 0
        contact_time = 0.0
        max_gap = max(q, 0.0)
        status = OK

        while sampled < times.size:
            pieces += 1
            if pieces > MAX_PIECES or lone > most:
                status = TOO_STIFF
                break
            at = memory.first_row(series, kept, place)
            begins = base + motion.t
            if reuse and motion.touching and memory.repeats(c, kept, place, motion):
                piece = memory.recall(kept, place)
                repeats += 1
            else:
                limit = c.period - motion.t if motion.touching else end - begins
                piece = next_piece(c, series, at, motion, limit)
                if piece.kind == CONTACT:
                    memory.keep(kept, place, motion, piece)
                    steps += 1
            lone = lone + 1 if piece.end == NOTHING else 0
            ends = begins + piece.duration
            if piece.kind == FLIGHT:
                if piece.end == LOST:
                    status = IMPACT_LOST
                    break
                highest = highest_gap(motion.z, motion.vz, motion.theta, c.gravity, c.a_z, c.omega, piece.duration)
                max_gap = max(max_gap, highest)
                while sampled < times.size and (ends >= times[sampled] or piece.end == LIMIT):
                    tau = times[sampled] - begins
                    samples[sampled, X] = x + vx * tau
                    samples[sampled, VX] = vx
                    samples[sampled, Z] = motion.z + (motion.vz - 0.5 * c.gravity * tau) * tau
                    samples[sampled, VZ] = motion.vz - c.gravity * tau
                    samples[sampled, CONTACT_FORCE] = samples[sampled, FRICTION_FORCE] = 0.0
                    sampled += 1
                if sampled == times.size:
                    break
                impacts += 1
                events = note(event_times, event_kinds, events, ends, IMPACT)
            elif piece.kind == CONTACT:
                place = min(place + 1, memory.PLACES - 1)
                if not (motion.pulled and c.tension == TENSION_CLIP):
                    # A repeated step has the duration of the one it repeats; what counts is where the cycle ends.
                    lasts = c.period - motion.t if piece.end == LIMIT else piece.duration
                    contact_time += min(lasts, end - begins)
                x, vx, sigma, sampled, events, segments = feed(
                    c,
                    series,
                    at,
                    motion,
                    piece,
                    begins,
                    x,
                    vx,
                    sigma,
                    feeding,
                    times,
                    samples,
                    sampled,
                    event_times,
                    event_kinds,
                    events,
                )
                if sampled == times.size:
                    break
                if segments == MAX_SEGMENTS:
                    status = TOO_MANY_EVENTS
                    break
            if piece.kind != CONTACT:
                x += vx * piece.duration
            pulled = motion.pulled
            motion = arrive(c, motion, piece, BEGIN_OF_CYCLE)
            if not (math.isfinite(motion.w) and math.isfinite(motion.v) and math.isfinite(motion.t)):
                status = NOT_FINITE
                break
            if piece.end == SEPARATION and not motion.touching:
                events = note(event_times, event_kinds, events, ends, SEPARATED)
            elif piece.end == FORCE_SIGN:
                kind = TENSION_ENDS if pulled else TENSION_BEGINS
                events = note(event_times, event_kinds, events, ends, kind)
            if motion.t >= c.period or piece.end == LIMIT:
                # Every cycle begins with a step of its own, so that its steps are comparable with the last one's.
                cycles = 1 if piece.end == LIMIT else int(motion.t / c.period)
                t = 0.0 if piece.end == LIMIT else max(motion.t - cycles * c.period, 0.0)
                motion = in_cycle(c, motion, t, BEGIN_OF_CYCLE)
                cycle += cycles
                base = cycle * c.period - offset
                pieces = place = 0
            if piece.kind == FLIGHT and feeding:
                sigma = slip_direction(c, motion.sine, motion.cosine, vx, c.damping * motion.v, c.friction)
        if not feeding:
            samples[:, X] = np.nan
            samples[:, VX] = np.nan
            samples[:, FRICTION_FORCE] = np.nan
        for n in range(sampled, times.size):
            samples[n, :] = np.nan
        results[i, CODE], results[i, EVENTS], results[i, IMPACTS] = status, events, impacts
        results[i, CONTACT_TIME], results[i, MAX_GAP] = contact_time, max_gap
        results[i, STEPS], results[i, REPEATS] = steps, repeats
