"""Contact steps of the last excitation cycle, kept and used again once the vertical motion repeats itself.

A settled vertical motion takes the same steps in every cycle, even while the slip velocity still changes, because
friction does not act on it. A step that begins where a step of the last cycle began, to within a tenth of the error
allowed for a step, is taken to be that step. Only trajectories near an attracting orbit come so close. The workspace
has a place for each step of a cycle, with the series of the step and a row for the numbers below.

Without kept steps, sweeps of runs of 1 s from 20 to 60 m/s² take 2.0 times as long, and runs of 4 s 2.6 times. Chaotic
runs take equally long.
"""

import math

from .contact_law import row_of
from .jit import compiled_into_callers
from .vertical import CONTACT, Piece
from .workspace import BEGIN_AND_END, FIRST, STEP

# Steps kept; further steps of a cycle share the last place.
PLACES = 40
# The largest difference between two beginnings of one step, in units of the tolerance.
CLOSE = 0.1

# Numbers of a kept step: its beginning, then its end.
BEGIN_T, BEGIN_W, BEGIN_V, PULLED = range(4)
DURATION, LENGTH, END, END_W, END_V, END_SINE, END_COSINE = range(4, 11)
PEAK = 11  # largest contact force per mass (m/s²); NaN until it is computed


@compiled_into_callers
def kept_numbers(series, at):
    """The numbers of the step whose series begins at row `at` of a workspace, float64, shape (SIZE,)."""
    return row_of(series, at + BEGIN_AND_END)


@compiled_into_callers
def forget(series):
    """Forget all steps in a workspace."""
    for at in range(FIRST, series.size, STEP):
        kept_numbers(series, at)[BEGIN_T] = math.inf


@compiled_into_callers
def repeats(c, series, at, motion):
    """Whether the contact step that begins with a Motion begins where the kept step began."""
    step = kept_numbers(series, at)
    close = CLOSE * c.tolerance
    return (
        abs(step[BEGIN_T] - motion.t) <= close / c.omega
        and abs(step[BEGIN_W] - motion.w) <= close * c.scale_w
        and abs(step[BEGIN_V] - motion.v) <= close * c.scale_v
        and step[PULLED] == motion.pulled
    )


@compiled_into_callers
def keep(series, at, motion, piece):
    """Keep the contact step `piece` that begins with `motion`."""
    step = kept_numbers(series, at)
    step[BEGIN_T], step[BEGIN_W], step[BEGIN_V], step[PULLED] = motion.t, motion.w, motion.v, motion.pulled
    step[DURATION], step[LENGTH], step[END] = piece.duration, piece.length, piece.end
    step[END_W], step[END_V], step[END_SINE], step[END_COSINE] = piece.w, piece.v, piece.sine, piece.cosine
    step[PEAK] = math.nan


@compiled_into_callers
def recall(series, at):
    """The Piece of a kept step."""
    step = kept_numbers(series, at)
    end = int(step[END])
    return Piece(
        CONTACT, step[DURATION], step[LENGTH], end, step[END_W], step[END_V], step[END_SINE], step[END_COSINE], True
    )
