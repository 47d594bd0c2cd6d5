"""The largest contact force: with the speed of the impacts it says how gently the conveyor handles the part.

Force and rate have closed forms at the ends of a contact step. If the rate changes from positive to negative in
between, the largest force is at a root of the rate along the step's series.
"""

import math

from .contact_law import force, force_rate
from .jit import compiled, compiled_inline, compiled_into_callers
from .plate import lift
from .polynomial import value
from .repeated_steps import PEAK, kept_numbers
from .vertical import invert_time
from .workspace import COSINE, SINE, V, W

# Relative accuracy of the place of the largest force; the error of the force is about its square.
CLOSE = 1e-5
MAX_ITERATIONS = 60
# Halvings of a step after an impact, in search of a place where the force rises.
MAX_HALVINGS = 30


@compiled_inline
def force_and_rate(c, series, at, s):
    """F_c/m (m/s²) and its rate (m/s³) at the place `s` of a contact step."""
    w, v = value(series, at + W, s), value(series, at + V, s)
    press = c.gravity + lift(c, value(series, at + SINE, s), value(series, at + COSINE, s))
    return force(c, w, v), force_rate(c, w, v, press)


@compiled_into_callers
def is_monotonic(c, motion, piece):
    """Whether the force of a whole contact step, from `motion` to the end of its `piece`, is largest at an end."""
    if force_rate(c, piece.w, piece.v, c.gravity + lift(c, piece.sine, piece.cosine)) >= 0.0:
        return True
    # After an impact the damper's force may fall before the spring's force rises.
    press = c.gravity + lift(c, motion.sine, motion.cosine)
    return force_rate(c, motion.w, motion.v, press) <= 0.0 and motion.w != 0.0


@compiled
def largest_force(c, series, at, piece, first, last):
    """Largest F_c/m (m/s²) of a contact step between the times `first` and `last` (s) since it began."""
    low = 0.0 if first <= 0.0 else invert_time(series, at, piece.length, first)
    high = piece.length if last >= piece.duration else invert_time(series, at, piece.length, last)
    force_low, rate_low = force_and_rate(c, series, at, low)
    force_high, rate_high = force_and_rate(c, series, at, high)
    largest = max(force_low, force_high)
    if rate_high >= 0.0 or (rate_low <= 0.0 and low > 0.0):
        return largest
    halvings = 0
    while rate_low <= 0.0:
        halvings += 1
        if halvings > MAX_HALVINGS:
            return largest
        middle = 0.5 * high
        _, rate = force_and_rate(c, series, at, middle)
        if rate > 0.0:
            low, rate_low = middle, rate
        else:
            high, rate_high = middle, rate
    # False position with the Illinois modification: the value at an end that stays is halved.
    side, last = 0, low
    for _ in range(MAX_ITERATIONS):
        s = low + (high - low) * rate_low / (rate_low - rate_high)
        force_here, rate = force_and_rate(c, series, at, s)
        largest = max(largest, force_here)
        if abs(s - last) <= CLOSE * s:
            break
        last = s
        if rate > 0.0:
            low, rate_low = s, rate
            rate_high *= 0.5 if side == 1 else 1.0
            side = 1
        else:
            high, rate_high = s, rate
            rate_low *= 0.5 if side == -1 else 1.0
            side = -1
    return largest


@compiled_into_callers
def peak_of_step(c, step, first, last):
    """Largest F_c/m (m/s²) of a contact step, a record.Step, from `first` to `last` (s) after its beginning."""
    motion, piece = step.motion, step.piece
    kept = kept_numbers(step.series, step.at)
    is_whole = first <= 0.0 and last >= piece.duration
    largest = kept[PEAK] if is_whole and piece.repeated else math.nan
    if math.isnan(largest):
        if is_whole and is_monotonic(c, motion, piece):
            largest = max(force(c, motion.w, motion.v), force(c, piece.w, piece.v))
        else:
            largest = largest_force(c, step.series, step.at, piece, first, last)
    if is_whole:
        kept[PEAK] = largest
    return largest
