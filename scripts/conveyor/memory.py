"""Contact steps of the last excitation cycle, kept to be used again once the vertical motion repeats itself.

A settled vertical motion goes through the same steps in every cycle, while the slip velocity may still change: friction
does not act on the vertical motion. A step that begins where one of the last cycle began, to within a tenth of the
error that a step may make, is that step. Orbits that contract are followed to their limit in this way; others never
come as close.
"""

import numpy as np

from .contact import FIRST, ROWS
from .jit import inlined, kernel
from .polynomial import SIZE

# Steps kept; more in a cycle share the last place.
PLACES = 40
# How close two beginnings of one step are, in units of the tolerance.
CLOSE = 0.1

# Columns of a kept step: its beginning, then what was found.
BEGIN_T, BEGIN_W, BEGIN_V, PULLED, LENGTH, END_W, END_V, LAPSE, EVENT, END_SINE, END_COSINE = range(11)


@kernel
def unused():
    """Room for the series of PLACES steps (see contact), and for what else is kept of them, shape (PLACES, 11)."""
    series = np.empty((FIRST + PLACES * ROWS, SIZE))
    series[:FIRST] = 0.0
    steps = np.empty((PLACES, END_COSINE + 1))
    steps[:, BEGIN_T] = np.inf
    return series, steps


@inlined
def first_row(series, steps, place):
    """The first row of a step's series. Most places are never used, so a place is cleared when it first is."""
    row = FIRST + place * ROWS
    if steps[place, BEGIN_T] == np.inf:
        for k in range(row, row + ROWS):
            for n in range(SIZE):
                series[k, n] = 0.0
    return row


@inlined
def repeats(c, steps, place, t, w, v, pulled):
    """Whether a step at the time `t` in its cycle (s) from w (√m), v (m/s) begins where the kept one began."""
    close = CLOSE * c.tolerance
    return (
        abs(steps[place, BEGIN_T] - t) <= close / c.omega
        and abs(steps[place, BEGIN_W] - w) <= close * c.scale_w
        and abs(steps[place, BEGIN_V] - v) <= close * c.scale_v
        and steps[place, PULLED] == pulled
    )


@inlined
def keep(steps, place, t, w, v, pulled, length, w_end, v_end, lapse, event, sine_end, cosine_end):
    """Keep a step."""
    steps[place, BEGIN_T], steps[place, BEGIN_W], steps[place, BEGIN_V], steps[place, PULLED] = t, w, v, pulled
    steps[place, LENGTH], steps[place, END_W], steps[place, END_V] = length, w_end, v_end
    steps[place, LAPSE], steps[place, EVENT] = lapse, event
    steps[place, END_SINE], steps[place, END_COSINE] = sine_end, cosine_end


@inlined
def recall(steps, place):
    """What was found of a kept step, in the order in which `keep` takes it."""
    return (
        steps[place, LENGTH],
        steps[place, END_W],
        steps[place, END_V],
        steps[place, LAPSE],
        int(steps[place, EVENT]),
        steps[place, END_SINE],
        steps[place, END_COSINE],
    )
