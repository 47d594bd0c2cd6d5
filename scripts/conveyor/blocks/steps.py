"""Steps of a block in contact: an embedded Runge-Kutta pair, and the first event in a step.

The pair of the orders 5 and 4 with its interpolant of order 4 is that of Dormand and Prince (J. Comput. Appl. Math. 6,
1980; Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, Sect. II.6).
"""

import math

import numpy as np

from ..solver import model
from ..solver.jit import compiled, compiled_inline, copy
from . import corners
from .corners import ANGLE, CORNERS, FORCE, FORWARD, FREE, GAP, MODE, PULLED, RUB, SLIP, STATE, STICK, WHOLE, X

STAGES = 7
NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
WEIGHTS = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
ERRORS = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
DENSE = np.array(
    [
        -12715105075 / 11282082432,
        0,
        87487479700 / 32700410799,
        -10690763975 / 1880347072,
        701980252875 / 199316789632,
        -1453857185 / 822651844,
        69997945 / 29380423,
    ]
)
# Kinds of events: a corner touches or leaves the plate, begins or ends to slip, or its contact force passes zero.
TOUCH, SLIDE, PULL, NONE = range(4)
MOST_TRIALS = 100
CLOSE = 1e-14  # of a step, to which an event is located


@compiled
def take_step(c, body, theta, state, length, stages, after, now):
    """The state `after` a step of a length (s) from `state`; returns its error in units of the one that is allowed.

    stages : float64, shape (7, 6), the first row filled with the rates at the beginning; the last row gets those at the
        end, for which `now` is then right
    """
    for k in range(1, STAGES):
        copy(after, state)
        for j in range(k):
            weight = length * WEIGHTS[k, j]
            for n in range(STATE):
                after[n] += weight * stages[j, n]
        corners.derive(c, body, theta + c.omega * NODES[k] * length, after, now, stages[k])
    # The scale of velocities is that of a fall by the static penetration, or the velocity itself.
    contact_time = c.scale_w * c.scale_w / c.scale_v
    worst = 0.0
    for place in range(X, STATE, 2):  # each position with its velocity
        scale = c.scale_v / (body.reach if place == ANGLE else 1.0) + abs(after[place + 1])
        for n, allowed in ((place, scale * contact_time), (place + 1, scale)):
            error = 0.0
            for k in range(STAGES):
                error += ERRORS[k] * stages[k, n]
            worst = max(worst, abs(error) / allowed)
    return length * worst / c.tolerance


@compiled
def interpolate(state, length, stages, after, share, between):
    """Fill the state `between`, after a share of a step."""
    rest = 1.0 - share
    for n in range(STATE):
        change = after[n] - state[n]
        bend = length * stages[0, n] - change
        last = 0.0
        for k in range(STAGES):
            last += DENSE[k] * stages[k, n]
        inner = change - length * stages[STAGES - 1, n] - bend + rest * length * last
        between[n] = state[n] + share * (change + rest * (bend + share * inner))


@compiled
def guard(c, now, kind, i):
    """A number that stays positive up to the next event of a kind at corner i."""
    mode = now[MODE, i]
    if kind == TOUCH:
        return now[GAP, i] if mode == FREE else -now[GAP, i]
    if mode == FREE:
        return math.inf
    if kind == SLIDE:
        if mode == STICK:
            return c.static_friction * (now[FORCE, i] + 0.5 * c.rest_force) - abs(now[RUB, i])
        # Without friction it does not matter which way a corner slips.
        if c.friction == 0.0 and c.static_friction == 0.0:
            return math.inf
        return now[SLIP, i] if mode == FORWARD else -now[SLIP, i]
    if c.tension == model.TENSION_ALLOW:
        return math.inf
    return -now[WHOLE, i] if now[PULLED, i] else now[WHOLE, i]


@compiled_inline
def margin_of(margins, now, kind, i):
    """By how much a guard may be negative without an event."""
    if kind == TOUCH:
        return margins.gap
    return margins.slip if kind == SLIDE and now[MODE, i] != STICK else margins.force


@compiled
def first_event(c, body, theta, state, length, stages, after, now, between):
    """Share of a step at which its first event is, the kind of the event and its corner; the share is 1 if none is.

    now : as `take_step` leaves it, and unchanged if there is no event; between : an array of the shape of a state
    """
    share, first_kind, corner = 1.0, NONE, -1
    place = found = 0
    while place < CORNERS * NONE:
        kind, i = place // CORNERS, place % CORNERS
        place += 1
        half = 0.5 * margin_of(body.margins, now, kind, i)
        at_end = guard(c, now, kind, i)
        if (kind == first_kind and i == corner) or at_end >= -2.0 * half:
            continue
        rates = np.empty(STATE)
        # The event is where the guard passes half of its margin, or the whole one if it begins beyond half of it: a
        # corner that has just left the plate may still be that far below it. A regula falsi (Illinois), whose interval
        # shrinks from both ends.
        corners.derive(c, body, theta, state, now, rates)
        at_begin = guard(c, now, kind, i)
        level = half if at_begin > -half else 2.0 * half
        low, high, at_low, at_high, side = 0.0, share, at_begin + level, at_end + level, 0
        for _ in range(MOST_TRIALS):
            middle = (low * at_high - high * at_low) / (at_high - at_low)
            if at_low <= 0.0 or high - low <= CLOSE or not low < middle < high:
                break
            interpolate(state, length, stages, after, middle, between)
            corners.derive(c, body, theta + c.omega * middle * length, between, now, rates)
            value = guard(c, now, kind, i) + level
            if value > 0.0:
                low, at_low = middle, value
                at_high *= 0.5 if side == 1 else 1.0
                side = 1
            else:
                high, at_high = middle, value
                at_low *= 0.5 if side == -1 else 1.0
                side = -1
                if value == 0.0:
                    break
        share, first_kind, corner = 0.0 if at_low <= 0.0 else high, kind, i
        # Does another event come before this one, even one that is over at the end of the step?
        found += 1
        interpolate(state, length, stages, after, share, between)
        corners.derive(c, body, theta + c.omega * share * length, between, now, rates)
        place = 0 if share > 0.0 and found < CORNERS * NONE else CORNERS * NONE
    return share, first_kind, corner
