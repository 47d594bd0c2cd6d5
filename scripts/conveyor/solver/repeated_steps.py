"""Contact steps of the last excitation cycle, kept and used again once the vertical motion repeats itself.

A settled vertical motion takes the same steps in every cycle, even while the slip velocity still changes, because
friction does not act on it. A step that begins where a step of the last cycle began, to within a tenth of the error
allowed for a step, is taken to be that step. Only trajectories near an attracting orbit come so close.

Without kept steps, sweeps of runs of 1 s from 20 to 60 m/s² take 2.0 times as long, and runs of 4 s 2.6 times. Chaotic
runs take equally long.
"""

from collections import namedtuple

import numpy as np

from .contact_law import expand
from .jit import compiled_into_callers
from .vertical import CONTACT, Piece
from .workspace import FIRST, STEP

# Steps kept; further steps of a cycle share the last place.
PLACES = 40
# The largest difference between two beginnings of one step, in units of the tolerance.
CLOSE = 0.1

# Columns of a kept step: its beginning, then its end.
BEGIN_T, BEGIN_W, BEGIN_V, BEGIN_SINE, BEGIN_COSINE, PULLED = range(6)
DURATION, LENGTH, END, END_W, END_V, END_SINE, END_COSINE = range(6, 13)
PEAK = 13  # largest contact force per mass (m/s²); NaN until it is computed
COLUMNS = 14


# Kept steps: their series, a workspace (see contact) of PLACES steps, and the columns above, shape (PLACES, COLUMNS).
KeptSteps = namedtuple("KeptSteps", "series steps")


def new_arrays() -> tuple[np.ndarray, np.ndarray]:
    """New arrays for the two fields of KeptSteps."""
    return np.zeros(FIRST + PLACES * STEP), np.full((PLACES, COLUMNS), np.inf)


@compiled_into_callers
def forget(kept):
    """Forget all steps; places are used one after the other."""
    for place in range(PLACES):
        if kept.steps[place, BEGIN_T] == np.inf:
            break
        kept.steps[place, BEGIN_T] = np.inf


@compiled_into_callers
def repeats(c, kept, place, motion):
    """Whether the contact step that begins with a Motion begins where the kept step began."""
    step = kept.steps[place]
    close = CLOSE * c.tolerance
    return (
        abs(step[BEGIN_T] - motion.t) <= close / c.omega
        and abs(step[BEGIN_W] - motion.w) <= close * c.scale_w
        and abs(step[BEGIN_V] - motion.v) <= close * c.scale_v
        and step[PULLED] == motion.pulled
    )


@compiled_into_callers
def keep(kept, place, motion, piece):
    """Keep the contact step `piece` that begins with `motion`."""
    step = kept.steps[place]
    step[BEGIN_T], step[BEGIN_W], step[BEGIN_V], step[PULLED] = motion.t, motion.w, motion.v, motion.pulled
    step[BEGIN_SINE], step[BEGIN_COSINE] = motion.sine, motion.cosine
    step[DURATION], step[LENGTH], step[END] = piece.duration, piece.length, piece.end
    step[END_W], step[END_V], step[END_SINE], step[END_COSINE] = piece.w, piece.v, piece.sine, piece.cosine
    step[PEAK] = np.nan


@compiled_into_callers
def expand_again(c, kept, place, at):
    """Write the series of a kept step into its workspace, from row `at` on."""
    step = kept.steps[place]
    expand(c, kept.series, at, step[BEGIN_W], step[BEGIN_V], step[BEGIN_SINE], step[BEGIN_COSINE], False)


@compiled_into_callers
def recall(kept, place):
    """The Piece of a kept step."""
    step = kept.steps[place]
    end = int(step[END])
    return Piece(CONTACT, step[DURATION], step[LENGTH], end, step[END_W], step[END_V], step[END_SINE], step[END_COSINE])
