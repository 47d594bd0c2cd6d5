"""The horizontal motion along one contact step: segments of slip one way or of stick, and the samples in them.

Nothing is integrated: see friction for the closed forms. A segment is known by its beginning, a Segment.
"""

import math
from collections import namedtuple

from . import contact, friction
from .jit import inlined, spliced
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

# The beginning of a segment: sign of the slip (0 for stick) and the friction coefficient that acts; x (m), ẋ (m/s); its
# place s in the step and the time t (s) since the step began; sine and cosine of the phase; z, ż, w and v.
Segment = namedtuple("Segment", "sigma mu x vx s t sine cosine z vz w v")


@inlined
def note(event_times, event_kinds, events, time, kind):
    """Record an event (s, one of EVENTS) while there is room; the number of events with it."""
    if events < event_times.size:
        event_times[events] = time
        event_kinds[events] = kind
    return events + 1


@inlined
def slip_direction(c, sine, cosine, vx, force, mu):
    """Sign of the slip of a part with the velocity ẋ = vx at a phase, 0 for stick; `force` is F_c/m (m/s²)."""
    slip = c.a_x / c.omega * sine - vx
    if slip == 0.0:
        return friction.direction_at_rest(c, c.a_x * cosine, force, mu)
    return math.copysign(1.0, slip)


@inlined
def moved(c, segment, tau, sine, cosine, z, vz):
    """x (m) and ẋ (m/s) of the part after the time tau (s) of a segment, at which the vertical motion is z, vz."""
    speed = c.a_x / c.omega
    if segment.sigma == 0.0:
        return segment.x - speed / c.omega * (cosine - segment.cosine), speed * sine
    pull = segment.sigma * segment.mu
    path = z - segment.z - segment.vz * tau + 0.5 * c.gravity * tau * tau
    return segment.x + segment.vx * tau + pull * path, segment.vx + pull * (vz - segment.vz + c.gravity * tau)


@spliced
def segment_end(c, series, at, segment, piece, released, fastest, leave):
    """Where in s a segment ends (infinity: not in this step), and whether slip that follows lasts to its end.

    A slip that begins at rest is left behind by the part `leave` of the step.
    """
    if released:
        return math.inf, True
    if segment.sigma == 0.0:
        return friction.stick_end(c, series, at, segment.s, piece.length, segment.cosine, piece.cosine)
    speed_x, speed_z = c.a_x / c.omega, c.a_z / c.omega
    sigma, ahead = segment.sigma, piece.duration - segment.t
    slip = speed_x * segment.sine - segment.vx
    turn = piece.sine - segment.sine
    gain = speed_z * turn - piece.v + segment.v + c.gravity * ahead
    if friction.keeps_slipping(
        c, sigma * slip, sigma * speed_x * turn, gain, ahead, segment.cosine, piece.cosine, fastest, segment.mu
    ):
        return math.inf, False
    return friction.slip_end(c, series, at, segment.s, piece.length, slip, sigma, segment.mu, leave), False


@spliced
def sample_contact(c, series, at, motion, piece, segment, pressing, tau, samples, n):
    """Fill the row n of `samples` at the time tau (s) since a contact step began, within a segment."""
    speed_z = c.a_z / c.omega
    s = invert_time(series, at, piece.length, tau)
    phase = motion.theta + c.omega * tau
    sine, cosine = math.sin(phase), math.cos(phase)
    w, v = value(series, at + contact.W, s), value(series, at + contact.V, s)
    z, vz = -speed_z / c.omega * cosine - w * w, speed_z * sine - v
    force = contact.force(c, w, v) if pressing else 0.0
    rub = c.a_x * cosine if segment.sigma == 0.0 else segment.sigma * segment.mu * force
    samples[n, X], samples[n, VX] = moved(c, segment, tau - segment.t, sine, cosine, z, vz)
    samples[n, Z], samples[n, VZ] = z, vz
    samples[n, CONTACT_FORCE] = c.mass * force
    samples[n, FRICTION_FORCE] = c.mass * rub


@spliced
def feed(
    c,
    series,
    at,
    motion,
    piece,
    begin,
    x,
    vx,
    sigma,
    feeding,
    times,
    samples,
    sampled,
    event_times,
    event_kinds,
    events,
):
    """Follow the horizontal motion along a contact step, and sample it.

    Parameters
    ----------
    c, series, at, motion, piece : the contact step as in vertical.next_piece
    begin : s, time of its beginning
    x, vx, sigma : position (m), velocity (m/s) and sign of the slip then
    feeding : whether the horizontal motion is wanted at all
    times, samples, sampled : as in trajectory.integrate; rows from `sampled` on are waiting
    event_times, event_kinds, events : the same for events

    Returns
    -------
    x, vx, sigma, sampled, events, segments : at the end of the step; MAX_SEGMENTS segments if it was given up
    """
    speed_x, speed_z = c.a_x / c.omega, c.a_z / c.omega
    pressing = not (motion.pulled and c.tension == TENSION_CLIP)
    mu = 0.0 if motion.pulled else c.friction
    z, vz = -speed_z / c.omega * motion.cosine - motion.w * motion.w, speed_z * motion.sine - motion.v
    segment = Segment(sigma, mu, x, vx, 0.0, 0.0, motion.sine, motion.cosine, z, vz, motion.w, motion.v)
    fastest = max(-motion.v, -piece.v, 0.0)
    released = not feeding
    segments, leave = 0, LEAVE
    while True:
        segments += 1
        change, released = segment_end(c, series, at, segment, piece, released, fastest, leave)
        s, t, w, v, sine, cosine = piece.length, piece.duration, piece.w, piece.v, piece.sine, piece.cosine
        changed = change < piece.length
        if changed:
            s = change
            t = value(series, at + contact.T, s)
            w, v = value(series, at + contact.W, s), value(series, at + contact.V, s)
            phase = motion.theta + c.omega * t
            sine, cosine = math.sin(phase), math.cos(phase)
        while sampled < times.size and begin + t >= times[sampled]:
            sample_contact(c, series, at, motion, piece, segment, pressing, times[sampled] - begin, samples, sampled)
            sampled += 1
        if sampled == times.size or not feeding:
            break
        z, vz = -speed_z / c.omega * cosine - w * w, speed_z * sine - v
        x, vx = moved(c, segment, t - segment.t, sine, cosine, z, vz)
        if not changed or segments == MAX_SEGMENTS:
            break
        if sigma == 0.0:
            sigma = math.copysign(1.0, cosine)
            kind = SLIP
        else:
            sigma = friction.direction_at_rest(c, c.a_x * cosine, contact.force(c, w, v), mu)
            kind = STICK if sigma == 0.0 else SLIP_REVERSAL
        if sigma == segment.sigma:
            # No reversal: the slip cannot be told from zero here, and leaves it further on.
            leave *= 2.0
        else:
            leave = LEAVE
            events = note(event_times, event_kinds, events, begin + t, kind)
        # The part has the velocity of the plate here, exactly.
        vx = speed_x * sine
        segment = Segment(sigma, mu, x, vx, s, t, sine, cosine, z, vz, w, v)
    return x, vx, sigma, sampled, events, segments
