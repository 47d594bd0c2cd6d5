"""The horizontal motion along one contact step: segments of slip one way or of stick, and the samples in them.

Nothing is integrated: see friction for the closed forms. A segment is known by its beginning, a Segment.
"""

import math
from collections import namedtuple

from . import contact, friction
from .jit import compiled_inline, compiled_into_callers
from .model import TENSION_CLIP
from .polynomial import LEAVE, value
from .vertical import invert_time

# Columns of a sample.
X, VX, Z, VZ, CONTACT_FORCE, FRICTION_FORCE = range(6)
SAMPLES = ("x", "vx", "z", "vz", "contact_force", "friction_force")

# Kinds of events.
IMPACT, SEPARATED, SLIP_REVERSAL, STICK, SLIP, TENSION_BEGINS, TENSION_ENDS = range(7)
EVENTS = ("impact", "separation", "slip reversal", "stick", "slip", "tension begins", "tension ends")

# Segments in one contact step after which a run is given up.
MAX_SEGMENTS = 10_000

# The horizontal motion at a time: position x (m), velocity vx (m/s) and sign sigma of the slip, 0 for stick.
Horizontal = namedtuple("Horizontal", "x vx sigma")
# A contact step: the workspace with its series and their first row in it, the vertical.Motion at its beginning, the
# vertical.Piece that it is, and the time (s) of its beginning.
Step = namedtuple("Step", "series at motion piece begin")
# What is recorded of one trajectory, arrays to be filled: `samples`, shape (k, 6), at the `times` (s), shape (k,); time
# (s) and kind of the first m events, shape (m,).
Record = namedtuple("Record", "times samples event_times event_kinds")

# The beginning of a segment: sign of the slip (0 for stick) and the friction coefficient that acts; x (m), ẋ (m/s); its
# place s in the step and the time t (s) since the step began; sine and cosine of the phase; z, ż, w and v.
Segment = namedtuple("Segment", "sigma mu x vx s t sine cosine z vz w v")


@compiled_inline
def note(record, events, time, kind):
    """Record an event (s, one of EVENTS) while there is room; the number of events with it."""
    if events < record.event_times.size:
        record.event_times[events] = time
        record.event_kinds[events] = kind
    return events + 1


@compiled_inline
def slip_direction(c, sine, cosine, vx, force, mu):
    """Sign of the slip of a part with the velocity ẋ = vx at a phase, 0 for stick.

    force : F_c/m, m/s²; mu : coefficient of static friction
    """
    slip = c.a_x / c.omega * friction.along(c, sine, cosine)[0] - vx
    if slip == 0.0:
        return friction.direction_at_rest(c, friction.pull(c, sine, cosine), force, mu)
    return math.copysign(1.0, slip)


@compiled_inline
def slide(c, x, vx, tau):
    """x (m) and ẋ (m/s) after the time tau (s) in which gravity alone acts along the track."""
    fall = c.downhill * tau
    return x + vx * tau - 0.5 * fall * tau, vx - fall


@compiled_inline
def moved(c, segment, tau, sine, cosine, z, vz):
    """x (m) and ẋ (m/s) of the part after the time tau (s) of a segment, at which the vertical motion is z, vz."""
    speed = c.a_x / c.omega
    if segment.sigma == 0.0:
        sine_x, cosine_x = friction.along(c, sine, cosine)
        begin = friction.along(c, segment.sine, segment.cosine)[1]
        return segment.x - speed / c.omega * (cosine_x - begin), speed * sine_x
    rub = segment.sigma * segment.mu
    path = z - segment.z - segment.vz * tau + 0.5 * c.gravity * tau * tau
    x, vx = slide(c, segment.x, segment.vx, tau)
    return x + rub * path, vx + rub * (vz - segment.vz + c.gravity * tau)


@compiled_into_callers
def segment_end(c, step, segment, released, fastest, leave):
    """Where in s a segment ends (infinity: not in this step), and whether slip that follows lasts to its end.

    A slip that begins at rest is left behind by the part `leave` of the step.
    """
    if released:
        return math.inf, True
    piece = step.piece
    if segment.sigma == 0.0:
        return friction.stick_end(c, step, segment)
    speed_x, speed_z = c.a_x / c.omega, c.a_z / c.omega
    begin = friction.along(c, segment.sine, segment.cosine)[0]
    slip = speed_x * begin - segment.vx
    turn = piece.sine - segment.sine
    ahead = piece.duration - segment.t
    gain = speed_z * turn - piece.v + segment.v + c.gravity * ahead
    plate = segment.sigma * speed_x * (friction.along(c, piece.sine, piece.cosine)[0] - begin)
    if friction.keeps_slipping(c, segment, piece, segment.sigma * slip, plate, gain, fastest):
        return math.inf, False
    return friction.slip_end(c, step, segment, slip, leave), False


@compiled_into_callers
def sample_contact(c, step, segment, tau, sample):
    """Fill a `sample`, shape (6,), at the time tau (s) since a contact step began, within a segment."""
    series, at, motion = step.series, step.at, step.motion
    speed_z = c.a_z / c.omega
    s = invert_time(series, at, step.piece.length, tau)
    phase = motion.theta + c.omega * tau
    sine, cosine = math.sin(phase), math.cos(phase)
    w, v = value(series, at + contact.W, s), value(series, at + contact.V, s)
    z, vz = -speed_z / c.omega * cosine - w * w, speed_z * sine - v
    force = 0.0 if motion.pulled and c.tension == TENSION_CLIP else contact.force(c, w, v)
    rub = friction.pull(c, sine, cosine) if segment.sigma == 0.0 else segment.sigma * segment.mu * force
    sample[X], sample[VX] = moved(c, segment, tau - segment.t, sine, cosine, z, vz)
    sample[Z], sample[VZ] = z, vz
    sample[CONTACT_FORCE] = c.mass * force
    sample[FRICTION_FORCE] = c.mass * rub


@compiled_inline
def first_segment(c, motion, horizontal):
    """The Segment that begins with a contact step."""
    speed_z = c.a_z / c.omega
    mu = 0.0 if motion.pulled else c.friction
    z, vz = -speed_z / c.omega * motion.cosine - motion.w * motion.w, speed_z * motion.sine - motion.v
    x, vx, sigma = horizontal
    return Segment(sigma, mu, x, vx, 0.0, 0.0, motion.sine, motion.cosine, z, vz, motion.w, motion.v)


@compiled_into_callers
def feed(c, step, horizontal, feeding, record, sampled, events):
    """Follow the horizontal motion along a contact Step, and sample it.

    Parameters
    ----------
    horizontal : the Horizontal motion at its beginning
    feeding : whether the horizontal motion is wanted at all
    record, sampled, events : the Record, and numbers of samples and events in it so far

    Returns
    -------
    horizontal, sampled, events, segments : at the end of the step; MAX_SEGMENTS segments if it was given up
    """
    series, at, motion, piece, begin = step
    speed_x, speed_z = c.a_x / c.omega, c.a_z / c.omega
    segment = first_segment(c, motion, horizontal)
    x, vx, sigma = horizontal
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
            t = value(series, at + contact.T, s)
            w, v = value(series, at + contact.W, s), value(series, at + contact.V, s)
            phase = motion.theta + c.omega * t
            sine, cosine = math.sin(phase), math.cos(phase)
        while sampled < record.times.size and begin + t >= record.times[sampled]:
            sample_contact(c, step, segment, record.times[sampled] - begin, record.samples[sampled])
            sampled += 1
        if sampled == record.times.size or not feeding:
            break
        z, vz = -speed_z / c.omega * cosine - w * w, speed_z * sine - v
        x, vx = moved(c, segment, t - segment.t, sine, cosine, z, vz)
        if not changed or segments == MAX_SEGMENTS:
            break
        if sigma == 0.0:
            sigma = math.copysign(1.0, friction.pull(c, sine, cosine))
            kind = SLIP
        else:
            mu = 0.0 if motion.pulled else c.static_friction
            sigma = friction.direction_at_rest(c, friction.pull(c, sine, cosine), contact.force(c, w, v), mu)
            kind = STICK if sigma == 0.0 else SLIP_REVERSAL
        if sigma == segment.sigma:
            # No reversal: the slip cannot be told from zero here, and leaves it further on.
            leave *= 2.0
        else:
            leave = LEAVE
            events = note(record, events, begin + t, kind)
        # The part has the velocity of the plate here, exactly.
        vx = speed_x * friction.along(c, sine, cosine)[0]
        segment = Segment(sigma, segment.mu, x, vx, s, t, sine, cosine, z, vz, w, v)
    return Horizontal(x, vx, sigma), sampled, events, segments
