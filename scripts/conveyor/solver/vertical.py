"""One piece of the vertical motion: a flight, a moment of rest at the plate's surface, or one step of the contact.

`next_piece` finds the piece that begins now, and `arrive` finds the motion at its end. The module pieces joins them.
Time counts from the beginning of an excitation cycle, at which the excitation has the phase `origin`.
"""

import math
from collections import namedtuple

from . import contact, contact_law, plate, polynomial, workspace
from .contact import FORCE_SIGN, NOTHING, SEPARATION
from .flight import Flight, gap_at_phase, next_impact
from .jit import compiled, compiled_inline, compiled_into_callers
from .model import TENSION_ALLOW

# Kinds of pieces.
FLIGHT, GRAZE, CONTACT = range(3)
# What a part at the plate's surface does: it goes on into the plate, is pressed on with no speed, or is left behind.
ENTERS, RESTS, LEAVES = range(3)
# Ends of a piece besides contact.NOTHING, SEPARATION and FORCE_SIGN: a flight's impact, the time at which the caller
# wants the piece to end, and a flight whose impact was not found.
LANDING, TIME_LIMIT, LOST = range(3, 6)

# The motion at a time t (s) of its cycle, at the phase theta (rad) with the given sine and cosine. On the plate: the
# square root w of the penetration (√m), the speed of approach v (m/s), and whether the contact force is negative
# (used only for `frictionless` and `clip`). In the air: height z, velocity vz, gap q and its rate (m, m/s).
Motion = namedtuple("Motion", "t theta sine cosine touching w v pulled z vz q rate")
# A piece: its kind, its duration (s), the length of a contact step in the variable s, its end, and w, v, sine and
# cosine there; whether it is a contact step of the last cycle (see repeated_steps).
Piece = namedtuple("Piece", "kind duration length end w v sine cosine repeated")


@compiled
def begin(c, z0, vz0, theta):
    """Gap (m) and its rate (m/s) of an initial condition; the gap is exactly 0 on the plate (z0 is NaN, Eq. 15)."""
    sine, cosine = plate.sine_and_cosine(theta)
    q = 0.0 if math.isnan(z0) else z0 - plate.height(c, sine, cosine)
    return q, vz0 - plate.rise(c, sine, cosine)


@compiled_inline
def at_surface(c, v, sine, cosine):
    """What a part at the plate's surface with a speed of approach v (m/s) does: ENTERS, RESTS or LEAVES.

    A speed below rest_speed is none at this tolerance, so that the part rests where the plate presses on it.
    """
    if v > c.rest_speed:
        return ENTERS
    if c.gravity + plate.lift(c, sine, cosine) > 0.0:
        return RESTS if v >= -c.rest_speed else LEAVES
    return ENTERS if v > 0.0 else LEAVES


@compiled
def motion_at(c, q, rate, t, theta):
    """The Motion with a gap q (m) and its rate (m/s) at the time t (s) of a cycle and the phase theta (rad)."""
    sine, cosine = plate.sine_and_cosine(theta)
    z, vz = q + plate.height(c, sine, cosine), rate + plate.rise(c, sine, cosine)
    w, v, touching = math.sqrt(max(-q, 0.0)), -rate, q < 0.0
    if q == 0.0:
        outcome = at_surface(c, v, sine, cosine)
        touching, v = outcome != LEAVES, 0.0 if outcome == RESTS else v
    pulled = touching and c.tension != TENSION_ALLOW and contact_law.force(c, w, v) < 0.0
    return Motion(t, theta, sine, cosine, touching, w, v, pulled, z, vz, q, rate)


@compiled
def invert_time(series, at, length, tau):
    """The s in [0, length] that a contact step reaches at the time `tau` (s) after its beginning."""
    low, high = 0.0, length
    total = polynomial.value(series, at + workspace.T, length)
    if tau >= total:  # also for a step too short to take time
        return length
    s = length * max(tau / total, 0.0)
    for _ in range(100):
        error = polynomial.value(series, at + workspace.T, s) - tau
        w = polynomial.value(series, at + workspace.W, s)
        if error > 0.0:
            high = s
        else:
            low = s
        newton = s - error / w if w > 0.0 else low
        s_next = newton if low < newton < high else 0.5 * (low + high)
        if abs(s_next - s) <= 4e-16 * length:
            return s_next
        s = s_next
    return s


@compiled_inline
def cut_step(series, at, length, duration, end):
    """The Piece of a contact step that is cut at `length` in s, after `duration` (s)."""
    return Piece(
        CONTACT,
        duration,
        length,
        end,
        polynomial.value(series, at + workspace.W, length),
        polynomial.value(series, at + workspace.V, length),
        polynomial.value(series, at + workspace.SINE, length),
        polynomial.value(series, at + workspace.COSINE, length),
        False,
    )


@compiled_inline
def flight_from(c, motion):
    """The Flight that begins with a Motion."""
    return Flight(motion.z, motion.vz, motion.theta, c)


@compiled_into_callers
def fly(c, motion, limit):
    """The Piece that is a flight from `motion`, of at most `limit` (s)."""
    tau, speed = next_impact(flight_from(c, motion), motion.q, motion.rate, limit)
    end = LANDING
    if not tau < math.inf:
        end, tau = (TIME_LIMIT, limit) if tau == math.inf else (LOST, tau)
    sine, cosine = plate.sine_and_cosine(motion.theta + c.omega * tau)
    return Piece(FLIGHT, tau, 0.0, end, 0.0, speed, sine, cosine, False)


@compiled_inline
def is_grazing(c, motion):
    """Whether a part in contact only touches: no contact step begins, because the part rests or leaves the plate."""
    return motion.w == 0.0 and at_surface(c, motion.v, motion.sine, motion.cosine) != ENTERS


@compiled_into_callers
def graze(c, motion):
    """The Piece of a part for which `is_grazing` holds.

    The equations in s have a fixed point at w = v = 0. A part that is pressed on leaves it as δ = a τ²/2 with
    a = g + z̈_s. The plate does not turn in this time, so that slip velocities are off by its product with ẍ_s:
    below 1e-9 m/s for the paper's contact, more for contacts that are softer by far.
    """
    if at_surface(c, motion.v, motion.sine, motion.cosine) == RESTS:
        acceleration = c.gravity + plate.lift(c, motion.sine, motion.cosine)
        w = 1e-9 * c.scale_w
        v = math.sqrt(2.0 * acceleration) * w
        return Piece(GRAZE, v / acceleration, 0.0, NOTHING, w, v, motion.sine, motion.cosine, False)
    return Piece(GRAZE, 0.0, 0.0, SEPARATION, 0.0, 0.0, motion.sine, motion.cosine, False)


@compiled_into_callers
def press(c, series, at, motion, length, limit):
    """The Piece that is a contact step from `motion`, of at most `limit` (s); its series is good up to `length`."""
    length, w, v, lapse, end = contact.end_step(c, series, at, motion.w, motion.v, motion.pulled, length)
    if lapse > limit:
        return cut_step(series, at, invert_time(series, at, length, limit), limit, TIME_LIMIT)
    sine = polynomial.value(series, at + workspace.SINE, length)
    cosine = polynomial.value(series, at + workspace.COSINE, length)
    return Piece(CONTACT, lapse, length, end, w, v, sine, cosine, False)


@compiled_into_callers
def next_piece(c, series, at, motion, limit):
    """The Piece that begins with a Motion and takes at most `limit` (s).

    c, series, at : contact.Constants, a workspace, and the row in it at which a contact step begins
    """
    if not motion.touching:
        return fly(c, motion, limit)
    if is_grazing(c, motion):
        return graze(c, motion)
    length = contact.begin_step(c, series, at, motion.w, motion.v, motion.sine, motion.cosine, motion.pulled)
    return press(c, series, at, motion, length, limit)


@compiled_inline
def arrive(c, motion, piece, origin):
    """The Motion at the end of a Piece that began with `motion`; `origin` is the phase (rad) at the time 0."""
    t = motion.t + piece.duration
    theta = origin + c.omega * t
    sine, cosine, v = piece.sine, piece.cosine, piece.v
    if piece.kind == FLIGHT:
        if piece.end == LANDING:
            return Motion(t, theta, sine, cosine, True, 0.0, v, False, 0.0, 0.0, 0.0, 0.0)
        q, rate = gap_at_phase(flight_from(c, motion), piece.duration, sine, cosine)
        z, vz = q + plate.height(c, sine, cosine), rate + plate.rise(c, sine, cosine)
        return Motion(t, theta, sine, cosine, False, 0.0, 0.0, False, z, vz, q, rate)
    touching = True
    if piece.end == SEPARATION:
        touching = at_surface(c, v, sine, cosine) == RESTS
        v = 0.0 if touching else v
    pulled = motion.pulled != (piece.end == FORCE_SIGN)
    z, vz = plate.height(c, sine, cosine), plate.rise(c, sine, cosine) - v
    return Motion(t, theta, sine, cosine, touching, piece.w, v, pulled, z, vz, 0.0, -v)
