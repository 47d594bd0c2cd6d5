"""Contact steps of the last excitation cycle, kept to be used again once the vertical motion repeats itself.

A settled vertical motion goes through the same steps in every cycle, while the slip velocity may still change: friction
does not act on the vertical motion. A step that begins where one of the last cycle began, to within a tenth of the
error that a step may make, is that step. Orbits that contract are followed to their limit in this way; others never
come as close.
"""

import numpy as np

from .contact import FIRST, ROWS
from .jit import inlined
from .polynomial import SIZE
from .vertical import CONTACT, Piece

# Steps kept; more in a cycle share the last place.
PLACES = 40
# How close two beginnings of one step are, in units of the tolerance.
CLOSE = 0.1

# Columns of a kept step: its beginning, then what was found.
BEGIN_T, BEGIN_W, BEGIN_V, PULLED, DURATION, LENGTH, END, END_W, END_V, END_SINE, END_COSINE = range(11)


def room() -> tuple[np.ndarray, np.ndarray]:
    """Room for the series of PLACES steps (see contact), and for what else is kept of them, shape (PLACES, 11)."""
    return np.empty((FIRST + PLACES * ROWS, SIZE)), np.empty((PLACES, END_COSINE + 1))


@inlined
def clear(series, kept):
    """Forget all steps."""
    for row in range(FIRST):
        for n in range(SIZE):
            series[row, n] = 0.0
    for place in range(PLACES):
        kept[place, BEGIN_T] = np.inf


@inlined
def first_row(series, kept, place):
    """The first row of a step's series. Most places are never used, so a place is cleared when it first is."""
    row = FIRST + place * ROWS
    if kept[place, BEGIN_T] == np.inf:
        for k in range(row, row + ROWS):
            for n in range(SIZE):
                series[k, n] = 0.0
    return row


@inlined
def repeats(c, kept, place, motion):
    """Whether the contact step that begins with a Motion begins where the kept one began."""
    close = CLOSE * c.tolerance
    return (
        abs(kept[place, BEGIN_T] - motion.t) <= close / c.omega
        and abs(kept[place, BEGIN_W] - motion.w) <= close * c.scale_w
        and abs(kept[place, BEGIN_V] - motion.v) <= close * c.scale_v
        and kept[place, PULLED] == motion.pulled
    )


@inlined
def keep(kept, place, motion, piece):
    """Keep the contact step `piece` that begins with `motion`."""
    kept[place, BEGIN_T], kept[place, BEGIN_W] = motion.t, motion.w
    kept[place, BEGIN_V], kept[place, PULLED] = motion.v, motion.pulled
    kept[place, DURATION], kept[place, LENGTH], kept[place, END] = piece.duration, piece.length, piece.end
    kept[place, END_W], kept[place, END_V] = piece.w, piece.v
    kept[place, END_SINE], kept[place, END_COSINE] = piece.sine, piece.cosine


@inlined
def recall(kept, place):
    """The Piece that is kept."""
    return Piece(
        CONTACT,
        kept[place, DURATION],
        kept[place, LENGTH],
        int(kept[place, END]),
        kept[place, END_W],
        kept[place, END_V],
        kept[place, END_SINE],
        kept[place, END_COSINE],
    )
