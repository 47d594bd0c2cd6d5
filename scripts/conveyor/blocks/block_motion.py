"""The motion of a block: flights in closed form, and steps of the contact from event to event.

In flight the centre follows a parabola and the block turns uniformly. A corner's path is a parabola plus a cosine of
the rotation. Its acceleration relative to the plate is at least -(g cos α + bound on z̈_s + |r| Ω²), with its distance
|r| from the centre and the spin Ω. The parabola with this acceleration reaches the plate before the corner does, so
that a step to its root is safe (see solver.flight for a point).

The functions for what happens in a piece are copied into `follow` as machine code. Called, they make runs take 1.7
times as long.
"""

import math

from ..solver import contact
from ..solver.arrivals import furthest_way, time_of_passage
from ..solver.flight import time_of_fall
from ..solver.jit import compiled, compiled_entry, compiled_inline, copy, no_refcount
from ..solver.model import VZ0, Z0
from ..solver.status import IMPACT_LOST, NOT_FINITE, TOO_MANY_EVENTS, TOO_STIFF
from . import corners
from .corners import ANGLE, CORNERS, FORCE, FREE, GAP, MODE, PULLED, RATE, SLIP, SPIN, STATE, STICK, VX, VZ, X, Z
from .steps import NONE, PULL, STAGES, TOUCH, first_event, interpolate, take_step

SAMPLES = ("x", "vx", "z", "vz", "angle", "spin")
# Columns of the results of runs: the status code; the largest angle (rad); from the time `since` on, the time without
# contact (s), the largest speed of approach of a corner (m/s) and the largest sum of contact forces per mass (m/s²);
# the time (s) at which the centre arrives, NaN if it does not.
CODE, TILT, AIRTIME, IMPACT_SPEED, PEAK_FORCE, ARRIVAL = range(6)
RESULTS = 6

TURN = 2.0 * math.pi
BELOW = 2.0  # margins by which a corner may be below the plate in flight
MAX_SEARCH = 1_000_000  # steps of a search for an impact, see solver.flight
# Steps and events in one excitation cycle, on average, after which a run has failed.
MAX_STEPS, MAX_EVENTS = 1_000_000, 10_000
LONGEST = 0.05  # of an excitation cycle, or of a shorter one of its harmonics: a longer step might miss an event
# On a track, a motion that after a block of cycles differs by this many tolerances from itself repeats itself. A looser
# tolerance than LOOSEST does not count, because a part that still accelerates would keep its velocity.
CYCLES, SAME, LOOSEST = 12, 100.0, 1e-7
SAFETY, LEAST, MOST = 0.9, 0.2, 5.0  # of the change of a step's length
SHORTEST = 1e-15  # of an excitation cycle: a step that needs to be shorter has failed


@compiled
def fly(c, state, tau, after):
    """Fill the state `after` a flight of `tau` (s)."""
    after[X] = state[X] + (state[VX] - 0.5 * c.downhill * tau) * tau
    after[Z] = state[Z] + (state[VZ] - 0.5 * c.gravity * tau) * tau
    after[VX], after[VZ] = state[VX] - c.downhill * tau, state[VZ] - c.gravity * tau
    after[ANGLE], after[SPIN] = state[ANGLE] + state[SPIN] * tau, state[SPIN]


@compiled
def next_impact(c, body, theta, state, limit, after, now):
    """Duration (s) of a flight from a phase (rad) up to the impact of a corner, at most `limit`; NaN if it is lost.

    Fills the state `after` it, and `now` there.
    """
    margin, bound = body.margins.gap, c.gravity + c.bounds.lift + body.reach * state[SPIN] * state[SPIN]
    tau = 0.0
    for _ in range(MAX_SEARCH):
        fly(c, state, tau, after)
        # The whole block lies within its reach around the centre.
        clear = after[Z] - body.reach - c.bounds.height
        if clear > margin and tau < limit:
            advance = time_of_fall(after[VZ], clear, c.gravity)
        else:
            corners.locate(c, body, theta + c.omega * tau, after, now)
            if tau == limit:
                return tau
            advance = math.inf
            for i in range(CORNERS):
                gap, rate = now[GAP, i], now[RATE, i]
                if gap <= 0.0 and rate < 0.0:
                    return tau
                if gap < -BELOW * margin:
                    return math.nan
                # Down to below the plate, so that no step is of no length.
                advance = min(advance, time_of_fall(rate, gap + BELOW * margin, bound))
        tau = min(tau + advance, limit)
    return math.nan


@compiled_inline
def step_in_contact(c, body, theta, state, limit, length, stages, after, between, now):
    """A step of the contact from a phase (rad), which ends at its first event and takes at most `limit` (s).

    Fills the state `after` it, its stages, and `now` at its end.

    length : s, which is tried first
    stages : the first row is filled

    Returns
    -------
    lapse, kind, corner : duration (s), NaN if the contact is too stiff; the event and its corner, see steps.first_event
    length : of the next step (s)
    """
    while True:
        lapse = min(length, limit)
        error = take_step(c, body, theta, state, lapse, stages, after, now)
        if error <= 1.0:
            break
        length = lapse * max(LEAST, SAFETY * error**-0.2)  # LEAST, too, if the error is NaN
        if length * c.omega < SHORTEST * TURN:
            return math.nan, NONE, -1, length
    # A step that an event or the end cuts short says little of the next one.
    longer = lapse * min(SAFETY * max(error, 1e-10) ** -0.2, MOST)
    length = longer if lapse >= length else max(longer, length)
    share, kind, corner = first_event(c, body, theta, state, lapse, stages, after, now, between)
    if kind != NONE:
        lapse *= share
        take_step(c, body, theta, state, lapse, stages, after, now)
    return lapse, kind, corner, length


@compiled_inline
def move(c, flying, state, lapse, stages, after, tau, between):
    """Fill the state `between`, a time `tau` (s) after the beginning of a flight or of a step of the contact."""
    if flying:
        fly(c, state, tau, between)
    else:
        interpolate(state, lapse, stages, after, min(tau / lapse, 1.0) if lapse > 0.0 else 1.0, between)


@compiled_inline
def largest_tilt(state, after, lapse):
    """The largest size of the angle (rad) in a flight or a step, in which the spin is nearly linear in time."""
    tilt = abs(after[ANGLE])
    if state[SPIN] * after[SPIN] < 0.0:
        top = state[ANGLE] + 0.5 * lapse * state[SPIN] * state[SPIN] / (state[SPIN] - after[SPIN])
        tilt = max(tilt, abs(top))
    return tilt


@compiled
def blocks_to_skip(c, body, before, between, blocks_left, distance_left):
    """The number of blocks of cycles that may be left out, because the motion repeats itself.

    before, between : states at the beginning and at the end of a block
    blocks_left, distance_left : blocks up to the end of the run; m, up to the end of the track
    """
    same = SAME * min(c.tolerance, LOOSEST)
    for place in range(X, STATE, 2):  # each position with its velocity
        lever = body.reach if place == ANGLE else 1.0
        has_moved = abs(between[place] - before[place]) * lever > same * c.scale_w * c.scale_w
        is_faster = abs(between[place + 1] - before[place + 1]) * lever > same * c.scale_v
        if (has_moved and place != X) or is_faster:
            return 0.0
    advance = between[X] - before[X]
    # Up to one block before the end or the arrival.
    return max(math.floor(min(blocks_left, distance_left / advance if advance > 0.0 else math.inf) - 1.0), 0.0)


@compiled_inline
def apply_event(c, body, theta, kind, corner, state, now, rates):
    """Fill the modes of the corners after an event, and the rates; `state` and `now` are those at this moment.

    Returns the largest speed of approach of a new contact (m/s).
    """
    speed, slips = 0.0, -1
    if kind == TOUCH:
        corners.locate(c, body, theta, state, now)
        speed = corners.touch(now, body.margins.gap)
    elif kind == PULL:
        now[PULLED, corner] = 1.0 - now[PULLED, corner]
    elif now[MODE, corner] == STICK:
        slips = corner
    else:
        state[VX] += now[SLIP, corner]  # which is zero but for the margin
    corners.choose_modes(c, body, theta, state, slips, now, rates)
    return speed


@compiled_entry
def follow(parameters, harmonics, size, tilts, tolerance, times, since, samples, distance, results, workspace):
    """Follow equal blocks until the last of the times, or until they arrive.

    Parameters
    ----------
    parameters : float64, shape (n, 16), see parameters.PARAMETERS; z0 is the height of the centre above that at rest
    harmonics : as from plate.count_harmonics
    size, tilts : length and height (m), moment of inertia per mass (m²); initial angles (rad), shape (n,)
    tolerance : relative error per step of the contact
    times, since : s, ascending, shape (k,); s from which statistics count, shape (n,)
    samples : shape (n, k, 6), filled with the columns SAMPLES at the times (z above that at rest); on a track, at the
        last time only
    distance : m, at which a centre arrives; infinite without a track
    results : zeros of the shape (n, 6), filled with the columns above
    workspace : arrays to work in, of the shapes (4, 6), (7, 6) and (14, 4); the caller holds them
    """
    parameters, times, samples, results = no_refcount((parameters, times, samples, results))
    states, stages, now = no_refcount(workspace)
    # `before` is the state one block of cycles ago.
    state, after, between, before = no_refcount((states[0], states[1], states[2], states[3]))
    end = times[-1]
    for i in range(len(parameters)):
        c = contact.compute_constants(parameters[i], tolerance, harmonics)
        z0, vz0 = parameters[i, Z0], parameters[i, VZ0]
        body = corners.body_of(c, size, z0, vz0)
        cycles = 1.0 + end * c.omega / TURN
        result, theta, t = results[i], c.psi0 % TURN, 0.0
        corners.begin(c, body, theta, z0, vz0, tilts[i], state, now, stages[0])
        result[TILT], result[ARRIVAL] = abs(tilts[i]), math.nan
        # On a track: the length of a block of cycles, and the time at which it ends; the furthest position; the time
        # without contact before the block.
        before[:] = math.inf
        block, furthest, airtime = CYCLES * TURN / c.omega, 0.0, 0.0
        due = block if distance < math.inf else math.inf
        # The order of harmonics is their mean along the track, weighted with their accelerations.
        longest = LONGEST * TURN / c.omega * c.bounds.pull / c.bounds.pull_rate
        length = 0.01 * LONGEST * TURN / c.omega
        steps = events = sampled = 0
        flying = now[MODE].max() == FREE
        while True:
            kind, corner = TOUCH, -1
            if flying:
                lapse = next_impact(c, body, theta, state, end - t, after, now)
            else:
                # A step ends where statistics begin, so that they include the force there.
                limit = min((since[i] if t < since[i] else end) - t, longest)
                lapse, kind, corner, length = step_in_contact(
                    c, body, theta, state, limit, length, stages, after, between, now
                )
                steps += 1
            if math.isnan(lapse) or steps > cycles * MAX_STEPS:
                result[CODE] = IMPACT_LOST if flying else TOO_STIFF
                break
            course = state[VX], c.downhill if flying else 0.0, lapse, after[X] - state[X]
            furthest = max(furthest, after[X], state[X] + furthest_way(*course))
            tau = time_of_passage(distance - state[X], *course)
            if not math.isnan(tau):
                result[ARRIVAL] = t + tau
                if flying:  # the run ends there
                    lapse = tau
                    fly(c, state, lapse, after)
            if flying:
                result[AIRTIME] += max(min(t + lapse - since[i], lapse), 0.0)
            result[TILT] = max(result[TILT], largest_tilt(state, after, lapse))
            # Samples in this piece; at the end of the run, all that is left.
            while sampled < times.size and (times[sampled] <= t + lapse or lapse >= end - t):
                move(c, flying, state, lapse, stages, after, times[sampled] - t, between)
                copy(samples[i, sampled], between)
                samples[i, sampled, Z] -= body.half_height
                sampled += 1
            if t + lapse > due:
                move(c, flying, state, lapse, stages, after, due - t, between)
                # Airtime repeats itself only where it counts during the whole block.
                blocks_left = (end - due) / block if due - block >= since[i] else 0.0
                skipped = blocks_to_skip(c, body, before, between, blocks_left, distance - furthest)
                if skipped > 0.0:
                    advance = skipped * (between[X] - before[X])
                    result[AIRTIME] += skipped * (result[AIRTIME] - airtime)
                    t += skipped * block
                    furthest += advance
                    after[X] += advance
                    between[X] += advance
                copy(before, between)
                airtime, due = result[AIRTIME], due + (skipped + 1.0) * block
            t = end if lapse >= end - t else t + lapse
            theta = (theta + c.omega * lapse) % TURN
            copy(state, after)
            if not math.isfinite(state.sum()):
                result[CODE] = NOT_FINITE
                break
            # Ctrl-C sets the times to zero.
            if t >= times[-1] or not math.isnan(result[ARRIVAL]):
                break
            if not flying:
                if t >= since[i]:
                    result[PEAK_FORCE] = max(result[PEAK_FORCE], now[FORCE].sum())
                corners.keep_sticking(now, state)
                if kind == NONE:
                    copy(stages[0], stages[STAGES - 1])
                    continue
                events += 1
                if events > cycles * MAX_EVENTS:
                    result[CODE] = TOO_MANY_EVENTS
                    break
            speed = apply_event(c, body, theta, kind, corner, state, now, stages[0])
            flying = now[MODE].max() == FREE
            if t >= since[i]:
                result[IMPACT_SPEED] = max(result[IMPACT_SPEED], speed)
                # A damper pushes most as a corner touches the plate.
                result[PEAK_FORCE] = max(result[PEAK_FORCE], now[FORCE].sum())
        samples[i, sampled:] = math.nan
