"""Coulomb friction: slip and stick while the part touches the plate, in closed form.

In contact, F_c/m = z̈_p + g cos α. While the part slips, the slip velocity u = ẋ_s - ẋ_p keeps its sign σ. Eq. 12 then
integrates to

    ẋ_p = ẋ_p0 + σμ [ż_p - ż_p0 + g cos α τ] - g sin α τ,
    x_p = x_p0 + ẋ_p0 τ + σμ [z_p - z_p0 - ż_p0 τ + g cos α τ²/2] - g sin α τ²/2,

with the time τ since the slip began. A part that moves with the plate needs the force m (ẍ_s + g sin α) along the
track; per mass, this is the pull. When u reaches zero, Filippov's condition decides: the part sticks while F_c > 0 and
|ẍ_s + g sin α| ≤ μ_s F_c/m. Otherwise it slips in the direction of ẍ_s + g sin α. Along a Taylor step of the vertical
motion, u is a polynomial, and so is w [μ_s F_c/m ∓ (ẍ_s + g sin α)]. Their first roots end slip and stick.
"""

import math

from . import plate, polynomial
from .contact_law import expand_force, impulse_of_tension
from .jit import compiled_inline, compiled_into_callers
from .polynomial import ORDER, place
from .workspace import SPARE


@compiled_inline
def pull(c, sine, cosine):
    """The pull ẍ_s + g sin α (m/s²) at a phase θ, given by its sine and cosine."""
    acceleration = c.a_x * plate.pull_share(c, sine, cosine)
    # On a level track the sign of a negative zero must survive: it decides the direction of a slip that begins.
    return acceleration + c.downhill if c.downhill != 0.0 else acceleration


@compiled_into_callers
def keeps_slipping(c, segment, piece, slip, swing, gain, fastest):
    """Whether bounds show that a part slips until the contact step ends, so that no root need be searched for.

    Friction reduces the slip velocity by μ times the impulse of the contact force, and increases it where the force
    pulls. The velocity of the plate is monotonic while its acceleration keeps its sign.

    Parameters
    ----------
    segment, piece : the horizontal.Segment, and the vertical.Piece in which it lies
    slip : slip velocity at the beginning of the segment times σ, m/s
    swing : change of ẋ_s from there to the end of the step times σ, m/s
    gain : impulse of the contact force per mass from there to the end of the step, ∫ F_c/m dt, m/s
    fastest : m/s, as in contact_law.impulse_of_tension
    """
    lapse = piece.duration - segment.t
    tension = impulse_of_tension(c, fastest, lapse)
    turn = c.omega * lapse
    slip += min(segment.sigma * c.downhill * lapse, 0.0)
    rise, fall = max(swing, 0.0), max(-swing, 0.0)
    begin = plate.pull_share(c, segment.sine, segment.cosine)
    end = plate.pull_share(c, piece.sine, piece.cosine)
    if turn > 1.0 or not plate.keeps_direction(c, begin, end, turn):
        largest = max(abs(begin), abs(end)) + c.bounds.pull_rate * turn
        rise = fall = c.a_x * min(largest, c.bounds.pull) * lapse
    forward = slip - fall - segment.mu * (gain + tension)
    backward = slip + swing - segment.mu * gain - rise - segment.mu * tension
    return max(forward, backward) > 0.0


@compiled_into_callers
def slip_end(c, step, segment, slip, leave):
    """Where slip ends: the first s behind the segment's beginning at which the slip velocity is zero.

    Infinite if the part slips to the end of the contact step.

    slip : slip velocity at the beginning of the segment, m/s
    leave : as in polynomial.first_root
    """
    series, mu = step.series, segment.mu
    fall = mu * c.gravity - segment.sigma * c.downhill
    plate.expand_velocities(c, c.waves, series, step.at, SPARE, segment.sigma, -mu, mu, -fall)
    series[SPARE] = 0.0
    series[SPARE] = segment.sigma * slip - polynomial.value(series, SPARE, segment.s)
    return polynomial.first_root(series, SPARE, segment.s, step.piece.length, leave)


@compiled_into_callers
def stick_end(c, step, segment):
    """Where stick ends: the first s behind the segment's beginning at which |ẍ_s + g sin α| exceeds μ_s F_c/m.

    On a level track, μ_s F_c/m + ẍ_s stays positive if ẍ_s does, and μ_s F_c/m - ẍ_s if -ẍ_s does.

    Returns
    -------
    end : the s; infinite if the part sticks to the end of the contact step
    lasting : whether |ẍ_s + g sin α| stays above μ_s F_c/m to the end of the step, so that the slip lasts as long
    """
    series, at, length = step.series, step.at, step.piece.length
    end, lasting = math.inf, False
    if c.a_x == 0.0 and c.downhill == 0.0:
        return end, lasting
    first = plate.pull_share(c, segment.sine, segment.cosine)
    last = plate.pull_share(c, step.piece.sine, step.piece.cosine)
    pushed = plate.keeps_direction(c, first, last, c.omega * (step.piece.duration - segment.t))
    for direction in (-1.0, 1.0):
        if c.downhill != 0.0 or direction * first <= 0.0 or not pushed:
            slack = c.static_friction * c.rest_force + direction * c.downhill
            expand_force(c, series, at, SPARE, c.static_friction)
            plate.add_pull(c, c.waves, series, at, SPARE, direction, slack)
            root = polynomial.first_root(series, SPARE, segment.s, length, polynomial.LEAVE)
            if root < end:
                for n in range(ORDER):
                    series[place(SPARE, n)] *= -1.0
                end = root
                lasting = polynomial.first_root(series, SPARE, root, length, polynomial.LEAVE) == math.inf
    return end, lasting


@compiled_inline
def direction_at_rest(c, pull, force, mu):
    """Sign of the slip that follows when the slip velocity is zero, or 0 for stick (Filippov's condition).

    pull : ẍ_s + g sin α, m/s²; force : F_c/m, m/s²; mu : coefficient of static friction that acts
    """
    # The tolerance rest_force keeps a part that barely touches from alternating between stick and slip without end.
    # Where nothing drives a part along the track it stays, also if the contact pulls: in Eq. 12, sign(0) is 0.
    if (c.a_x == 0.0 and pull == 0.0) or (mu > 0.0 and abs(pull) <= mu * (force + c.rest_force)):
        return 0.0
    return math.copysign(1.0, pull)
