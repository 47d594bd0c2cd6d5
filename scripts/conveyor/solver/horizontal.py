"""The horizontal motion along one piece of the vertical motion, and samples in it.

A contact step has segments of slip in one direction or of stick. The module friction has the closed forms; nothing is
integrated. A Segment holds the beginning of a segment.
"""

import math
from collections import namedtuple

from . import contact_law, friction, plate, workspace
from .jit import compiled_inline, compiled_into_callers
from .model import TENSION_CLIP
from .polynomial import LEAVE, value
from .record import (
    CONTACT_FORCE,
    FRICTION_FORCE,
    SLIP,
    SLIP_REVERSAL,
    STICK,
    VX,
    VZ,
    X,
    Z,
    is_sampled,
    next_sample,
    next_time,
    record_event,
)
from .status import OK, TOO_MANY_EVENTS
from .vertical import CONTACT, FLIGHT, invert_time

# Segments in one contact step after which a run ends with "too many events".
MAX_SEGMENTS = 10_000

# The horizontal motion at a time: position x (m), velocity vx (m/s) and sign sigma of the slip, 0 for stick.
Horizontal = namedtuple("Horizontal", "x vx sigma")

# The beginning of a segment: sign of the slip (0 for stick) and the friction coefficient that acts; x (m), ẋ (m/s); its
# place s in the step and the time t (s) since the step began; sine and cosine of the phase; z, ż, w and v.
Segment = namedtuple("Segment", "sigma mu x vx s t sine cosine z vz w v")


@compiled_inline
def slide(c, x, vx, tau):
    """x (m) and ẋ (m/s) after a time tau (s) in which only gravity acts along the track."""
    fall = c.downhill * tau
    return x + vx * tau - 0.5 * fall * tau, vx - fall


@compiled_inline
def state_in_segment(c, segment, tau, sine, cosine, z, vz):
    """x (m) and ẋ (m/s) a time tau (s) after the beginning of a segment, where the vertical motion is z, vz."""
    if segment.sigma == 0.0:
        path = plate.path_between(c, segment.sine, segment.cosine, sine, cosine)
        return segment.x + path, plate.speed(c, sine, cosine)
    rub = segment.sigma * segment.mu
    path = z - segment.z - segment.vz * tau + 0.5 * c.gravity * tau * tau
    x, vx = slide(c, segment.x, segment.vx, tau)
    return x + rub * path, vx + rub * (vz - segment.vz + c.gravity * tau)


@compiled_into_callers
def segment_end(c, step, segment, released, fastest, leave):
    """The s at which a segment ends, and whether the slip that follows lasts beyond the step.

    The s is infinite if the segment itself lasts beyond the step.

    released : whether the slip of this segment is known to last beyond the step
    fastest : m/s, as in contact_law.impulse_of_tension
    leave : as in polynomial.first_root, for a slip that begins at rest
    """
    if released:
        return math.inf, True
    piece = step.piece
    if segment.sigma == 0.0:
        return friction.stick_end(c, step, segment)
    slip = plate.speed(c, segment.sine, segment.cosine) - segment.vx
    rise = plate.rise_between(c, segment.sine, segment.cosine, piece.sine, piece.cosine)
    gain = rise - piece.v + segment.v + c.gravity * (piece.duration - segment.t)
    swing = segment.sigma * plate.speed_between(c, segment.sine, segment.cosine, piece.sine, piece.cosine)
    if friction.keeps_slipping(c, segment, piece, segment.sigma * slip, swing, gain, fastest):
        return math.inf, False
    return friction.slip_end(c, step, segment, slip, leave), False


@compiled_into_callers
def touch_down(c, motion, horizontal):
    """The Horizontal motion of a part that has just come into contact."""
    slip = plate.speed(c, motion.sine, motion.cosine) - horizontal.vx
    sigma = math.copysign(1.0, slip)
    if slip == 0.0:
        pull, force = friction.pull(c, motion.sine, motion.cosine), contact_law.force(c, motion.w, motion.v)
        sigma = friction.direction_at_rest(c, pull, force, c.static_friction)
    return Horizontal(horizontal.x, horizontal.vx, sigma)


@compiled_into_callers
def sample_flight(c, step, horizontal, tau, sample):
    """Fill a `sample`, shape (6,), at a time tau (s) after the beginning of a flight."""
    motion = step.motion
    sample[X], sample[VX] = slide(c, horizontal.x, horizontal.vx, tau)
    sample[Z], sample[VZ] = motion.z + (motion.vz - 0.5 * c.gravity * tau) * tau, motion.vz - c.gravity * tau
    sample[CONTACT_FORCE] = sample[FRICTION_FORCE] = 0.0


@compiled_into_callers
def sample_contact(c, step, segment, tau, sample):
    """Fill a `sample`, shape (6,), at a time tau (s) after the beginning of a contact step, within a segment."""
    series, at, motion = step.series, step.at, step.motion
    s = invert_time(series, at, step.piece.length, tau)
    sine, cosine = plate.sine_and_cosine(motion.theta + c.omega * tau)
    w, v = value(series, at + workspace.W, s), value(series, at + workspace.V, s)
    z, vz = plate.surface(c, sine, cosine)
    z, vz = z - w * w, vz - v
    force = 0.0 if motion.pulled and c.tension == TENSION_CLIP else contact_law.force(c, w, v)
    rub = friction.pull(c, sine, cosine) if segment.sigma == 0.0 else segment.sigma * segment.mu * force
    sample[X], sample[VX] = state_in_segment(c, segment, tau - segment.t, sine, cosine, z, vz)
    sample[Z], sample[VZ] = z, vz
    sample[CONTACT_FORCE] = c.mass * force
    sample[FRICTION_FORCE] = c.mass * rub


@compiled_into_callers
def follow_contact(c, step, horizontal, feeding, record):
    """`follow_horizontal` for a contact step."""
    series, at, motion, piece, begin = step
    x, vx, sigma = horizontal
    mu = 0.0 if motion.pulled else c.friction
    z, vz = plate.surface(c, motion.sine, motion.cosine)
    z, vz = z - motion.w * motion.w, vz - motion.v
    segment = Segment(sigma, mu, x, vx, 0.0, 0.0, motion.sine, motion.cosine, z, vz, motion.w, motion.v)
    fastest = max(-motion.v, -piece.v, 0.0)
    released = not feeding
    segments, leave = 0, LEAVE
    while True:
        segments += 1
        change, released = segment_end(c, step, segment, released, fastest, leave)
        s, t, w, v, sine, cosine = piece.length, piece.duration, piece.w, piece.v, piece.sine, piece.cosine
        changed = change < piece.length
        if changed:
            s = change
            t = value(series, at + workspace.T, s)
            w, v = value(series, at + workspace.W, s), value(series, at + workspace.V, s)
            sine, cosine = plate.sine_and_cosine(motion.theta + c.omega * t)
        while begin + t >= next_time(record):
            tau = next_time(record) - begin
            sample_contact(c, step, segment, tau, next_sample(record))
        if is_sampled(record) or not feeding:
            break
        z, vz = plate.surface(c, sine, cosine)
        z, vz = z - w * w, vz - v
        x, vx = state_in_segment(c, segment, t - segment.t, sine, cosine, z, vz)
        if not changed or segments == MAX_SEGMENTS:
            break
        if sigma == 0.0:
            sigma = math.copysign(1.0, friction.pull(c, sine, cosine))
            kind = SLIP
        else:
            mu = 0.0 if motion.pulled else c.static_friction
            sigma = friction.direction_at_rest(c, friction.pull(c, sine, cosine), contact_law.force(c, w, v), mu)
            kind = STICK if sigma == 0.0 else SLIP_REVERSAL
        if sigma == segment.sigma:
            # No reversal, because the slip is zero to rounding here. The next search starts further on.
            leave *= 2.0
        else:
            leave = LEAVE
            record_event(record, begin + t, kind)
        # The part has the velocity of the plate here, exactly.
        vx = plate.speed(c, sine, cosine)
        segment = Segment(sigma, segment.mu, x, vx, s, t, sine, cosine, z, vz, w, v)
    if feeding and c.static_friction == 0.0:
        # Without friction the part does not take over the error of the moment at which the slip vanishes.
        x, vx = slide(c, horizontal.x, horizontal.vx, piece.duration)
    status = TOO_MANY_EVENTS if segments == MAX_SEGMENTS and not is_sampled(record) else OK
    return Horizontal(x, vx, sigma), status


@compiled_into_callers
def follow_horizontal(c, step, horizontal, feeding, record):
    """Follow the horizontal motion along a piece of the vertical motion, and sample it.

    Parameters
    ----------
    step, record : record.Step and record.Record
    horizontal : the Horizontal motion at the beginning of the piece
    feeding : whether the horizontal motion is wanted

    Returns
    -------
    horizontal, status : the Horizontal motion at the end of the piece, unless the last sample is in it; a code of
        status.STATUS
    """
    if step.piece.kind == CONTACT:
        return follow_contact(c, step, horizontal, feeding, record)
    if step.piece.kind == FLIGHT:
        while step.begin + step.piece.duration >= next_time(record):
            tau = next_time(record) - step.begin
            sample_flight(c, step, horizontal, tau, next_sample(record))
    x, vx = slide(c, horizontal.x, horizontal.vx, step.piece.duration)
    return Horizontal(x, vx, horizontal.sigma), OK
