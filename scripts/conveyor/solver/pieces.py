"""One piece of the vertical motion after another: the only place that knows what follows a piece.

`advance` finds the next piece and the motion at its end. Whatever else happens in a piece follows in the loops that
call it: trajectory adds slip, stick, samples and statistics, and stroboscopic_map adds perturbations.
"""

import math
from collections import namedtuple

from . import plate, repeated_steps, vertical
from .jit import compiled_inline, compiled_into_callers
from .status import IMPACT_LOST, NOT_FINITE, OK, TOO_STIFF
from .vertical import CONTACT, LOST, TIME_LIMIT
from .workspace import FIRST, STEP

# Phase at which a cycle begins, rad: the plate is at its top, where a part that leaves the plate is in the air.
BEGIN_OF_CYCLE = -math.pi
# Pieces in one excitation cycle after which a run ends with "contact too stiff".
MAX_PIECES = 100_000

# Time is kept as whole excitation cycles plus a time within the cycle (Motion.t), so that the phase of a run of any
# length has the same precision. The phase (rad) at which each cycle begins; when the cycle with the number 0 began (s);
# the number of the present cycle, and when it began (s); the pieces in it so far; the row of its next contact step.
Clock = namedtuple("Clock", "origin first cycle begin pieces at")


@compiled_inline
def time_to_next_cycle(c):
    """The time (s) from the initial phase ψ0 to the next beginning of a cycle; 0 if a cycle begins there."""
    return ((BEGIN_OF_CYCLE - c.psi0) % (2.0 * math.pi)) / c.omega


@compiled_into_callers
def clock_at(c, origin, first, cycle):
    """The Clock at the beginning of a cycle."""
    return Clock(origin, first, cycle, cycle * c.period + first, 0, FIRST)


@compiled_into_callers
def clock_of(origin, count):
    """The Clock of a motion through a single cycle that begins at the phase `origin` (rad), after `count` pieces."""
    return Clock(origin, 0.0, 0, 0.0, count, FIRST)


@compiled_into_callers
def begin(c, z0, vz0):
    """The Motion and the Clock at the initial conditions z0 (m; NaN on the plate) and vz0 (m/s)."""
    since_cycle = ((c.psi0 - BEGIN_OF_CYCLE) % (2.0 * math.pi)) / c.omega
    q, rate = vertical.begin(c, z0, vz0, c.psi0)
    return vertical.motion_at(c, q, rate, since_cycle, c.psi0), clock_at(c, BEGIN_OF_CYCLE, -since_cycle, 0)


@compiled_into_callers
def end_piece(c, series, clock, motion, piece):
    """The Motion at the end of a Piece that began with `motion`, the Clock there, and a code of status.STATUS."""
    after = vertical.arrive(c, motion, piece, clock.origin)
    finite = math.isfinite(after.w) and math.isfinite(after.v) and math.isfinite(after.q)
    status = OK if finite else NOT_FINITE
    if piece.end == LOST:
        status = IMPACT_LOST
    if clock.pieces >= MAX_PIECES:
        status = TOO_STIFF
    # The last place in the workspace is for all further steps of a cycle.
    has_place = piece.kind == CONTACT and clock.at + 2 * STEP <= series.size
    at = clock.at + STEP if has_place else clock.at
    return after, Clock(clock.origin, clock.first, clock.cycle, clock.begin, clock.pieces + 1, at), status


@compiled_into_callers
def advance(c, series, clock, motion, limit, reuse):
    """Follow the vertical motion by one piece.

    Parameters
    ----------
    c, series : contact.Constants and a workspace
    clock, motion : at the beginning of the piece
    limit : s, after which the piece ends at the latest
    reuse : whether a contact step is repeated instead of computed where the last cycle had the same one

    Returns
    -------
    piece, motion, clock, status : the Piece, the Motion and Clock at its end, and a code of status.STATUS
    """
    if reuse and motion.touching and repeated_steps.repeats(c, series, clock.at, motion):
        piece = repeated_steps.recall(series, clock.at)
    else:
        piece = vertical.next_piece(c, series, clock.at, motion, limit)
        if reuse and piece.kind == CONTACT:
            repeated_steps.keep(series, clock.at, motion, piece)
    after, clock, status = end_piece(c, series, clock, motion, piece)
    return piece, after, clock, status


@compiled_into_callers
def next_cycle(c, clock, motion, piece):
    """The same Motion and its Clock in the cycle in which a Piece has ended.

    A contact step ends with its cycle, so that each cycle begins with a step of its own, which can be compared with the
    last cycle. A flight goes on, also through several cycles.
    """
    if motion.t < c.period and piece.end != TIME_LIMIT:
        return motion, clock
    cycles = 1 if piece.end == TIME_LIMIT else int(motion.t / c.period)
    t = 0.0 if piece.end == TIME_LIMIT else max(motion.t - cycles * c.period, 0.0)
    theta = clock.origin + c.omega * t
    _, _, _, _, touching, w, v, pulled, z, vz, q, rate = motion
    motion = vertical.Motion(t, theta, *plate.sine_and_cosine(theta), touching, w, v, pulled, z, vz, q, rate)
    return motion, clock_at(c, clock.origin, clock.first, clock.cycle + cycles)
