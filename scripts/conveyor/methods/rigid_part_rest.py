"""A rigid part that rests on the plate: how it moves, and when stick, slip or the rest itself ends.

The normal force is N/m = g cos α + a_z cos θ at the phase θ. The constants `c` are from `contact.constants`.
"""

import math

from ..solver import friction, plate
from ..solver.horizontal import slide
from ..solver.jit import compiled, compiled_inline

TURN = 2.0 * math.pi


@compiled_inline
def plate_height(c, theta):
    """z_s (m) at the phase `theta` (rad)."""
    return -c.a_z / c.omega**2 * math.cos(theta)


@compiled_inline
def plate_rise(c, theta):
    """ż_s (m/s) at the phase `theta` (rad)."""
    return c.a_z / c.omega * math.sin(theta)


@compiled
def plate_speed(c, theta):
    """ẋ_s (m/s) at the phase `theta` (rad)."""
    return c.a_x / c.omega * plate.ahead(c, math.sin(theta), math.cos(theta))[0]


@compiled
def one_wave(c, normal):
    """The amplitude R (m/s²) and the phase δ (rad) of ẍ_s + normal cos θ = R cos(θ + δ)."""
    cosine, sine = c.a_x * c.cos_shift + normal, c.a_x * c.sin_shift
    return math.hypot(cosine, sine), math.atan2(sine, cosine)


@compiled
def advance_to(angle, entry, centre):
    """Advance (rad) from an angle in [0, 2π) to the `entry` of an interval, whose first half ends at its `centre`."""
    if entry <= angle < centre:
        return 0.0
    return (entry if angle < entry else TURN + entry) - angle


@compiled
def rest_end(c, theta):
    """Advance of the phase (rad) from `theta` until the plate falls away from a resting part, a_z cos θ < -g cos α."""
    if c.a_z <= c.gravity:
        return math.inf
    edge = math.acos(-c.gravity / c.a_z)
    angle = theta % TURN
    if angle <= edge:
        return edge - angle
    if angle < TURN - edge:
        return 0.0
    return TURN + edge - angle


@compiled
def stick_end(c, theta):
    """Advance of the phase (rad) from `theta` until a sticking part begins to slip, |ẍ_s + g sin α| > μ_s N/m."""
    grip, lift = c.static_friction * c.gravity, c.static_friction * c.a_z
    # -(ẍ_s + g sin α) exceeds μ_s N/m where R cos(θ + δ) falls below -needed.
    amplitude, shift = one_wave(c, lift)
    needed = grip + c.downhill
    backward = 0.0 if needed < -amplitude else math.inf
    if abs(needed) < amplitude:
        backward = advance_to((theta + shift) % TURN, math.acos(-needed / amplitude), math.pi)
    # ẍ_s + g sin α exceeds μ_s N/m where R cos(θ + δ) rises above `needed`.
    amplitude, shift = one_wave(c, -lift)
    needed = grip - c.downhill
    forward = 0.0 if needed < -amplitude else math.inf
    if abs(needed) < amplitude:
        forward = advance_to((theta + shift) % TURN, TURN - math.acos(needed / amplitude), TURN)
    return min(backward, forward)


@compiled
def slip_after(c, theta, slip, sigma, advance):
    """Slip velocity ẋ_s - ẋ_p (m/s) of a resting part after an advance of the phase (rad)."""
    swing = (c.a_x * c.cos_shift - sigma * c.friction * c.a_z) / c.omega
    turned = c.a_x * c.sin_shift / c.omega * (math.cos(theta + advance) - math.cos(theta))
    fall = (sigma * c.friction * c.gravity - c.downhill) / c.omega
    return slip + swing * (math.sin(theta + advance) - math.sin(theta)) - fall * advance + turned


@compiled
def slip_end(c, theta, slip, sigma, limit):
    """Advance of the phase (rad), up to `limit`, at which the slip velocity of a resting part is back at zero.

    The advance is infinite if there is no zero. The slip velocity is monotonic between known angles, so that no zero is
    missed.
    """
    swing, shift = one_wave(c, -sigma * c.friction * c.a_z)
    fall = sigma * c.friction * c.gravity - c.downhill
    edge = math.acos(fall / swing) if abs(fall) < swing else 0.5 * math.pi
    low = 0.0
    while low < limit:
        to_first = (edge - shift - theta - low) % TURN
        to_second = (-edge - shift - theta - low) % TURN
        # A part that has just begun to slip starts at such an angle, up to rounding.
        to_first += TURN if to_first < 1e-9 else 0.0
        to_second += TURN if to_second < 1e-9 else 0.0
        high = low + min(to_first, to_second)
        if sigma * slip_after(c, theta, slip, sigma, high) <= 0.0:
            while high - low > 1e-15 * (1.0 + high):
                middle = 0.5 * (low + high)
                if sigma * slip_after(c, theta, slip, sigma, middle) > 0.0:
                    low = middle
                else:
                    high = middle
            return high
        low = high
    return math.inf


@compiled
def slip_direction(c, theta, slip):
    """Sign of the slip of a resting part, 0 for stick (Filippov's condition)."""
    if slip != 0.0:
        return math.copysign(1.0, slip)
    sine, cosine = math.sin(theta), math.cos(theta)
    return friction.direction_at_rest(c, friction.pull(c, sine, cosine), c.gravity + c.a_z * cosine, c.static_friction)


@compiled
def rest_motion(c, theta, x, vx, sigma, tau):
    """x (m) and ẋ (m/s) of a resting part after the time `tau` (s); `sigma` is the sign of the slip, 0 for stick."""
    phase = theta + c.omega * tau
    sine = (math.sin(phase) - math.sin(theta)) / c.omega
    cosine = (math.cos(theta) - math.cos(phase)) / c.omega**2
    if sigma == 0.0:
        _, begin = plate.ahead(c, math.sin(theta), math.cos(theta))
        speed, end = plate.ahead(c, math.sin(phase), math.cos(phase))
        return x + c.a_x * ((begin - end) / c.omega**2), c.a_x / c.omega * speed
    fall = 0.5 * c.gravity * tau * tau
    lift = c.a_z * (cosine - math.sin(theta) / c.omega * tau)
    rub = sigma * c.friction
    x, vx = slide(c, x, vx, tau)
    return x + rub * (fall + lift), vx + rub * (c.gravity * tau + c.a_z * sine)
