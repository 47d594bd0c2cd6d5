"""Coulomb friction: slip and stick while the part touches the plate, without integrating anything.

In contact F_c/m = z̈_p + g. While the slip velocity u = ẋ_s - ẋ_p keeps its sign σ, Eq. 12 therefore integrates to

    ẋ_p = ẋ_p0 + σμ [ż_p - ż_p0 + g τ],   x_p = x_p0 + ẋ_p0 τ + σμ [z_p - z_p0 - ż_p0 τ + g τ²/2],

with τ the time since the segment began. Where u reaches zero, Filippov's condition decides: the part sticks while
F_c > 0 and |ẍ_s| ≤ μ F_c/m, else it slips on with the sign of ẍ_s. Along a Taylor step of the vertical motion u and
the margin of stick are polynomials.
"""

import math

from . import polynomial
from .contact import SCRATCH, SINE, T, V, expand_force, impulse_of_tension
from .jit import inlined, spliced
from .polynomial import ORDER


@inlined
def keeps_slipping(c, segment, piece, slip, plate, gain, fastest):
    """Whether bounds alone show that the slip velocity does not vanish until a contact step ends.

    Parameters
    ----------
    segment, piece : the horizontal.Segment, and the vertical.Piece in which it lies
    slip, plate : slip velocity at its beginning and the change of ẋ_s until the end, times the slip's sign, m/s
    gain : ∫ F_c/m dt, m/s
    fastest : m/s, as in contact.impulse_of_tension

    Friction lowers the slip by μ times the impulse of the force, and raises it again where the force pulls. The plate
    changes its velocity one way while cos θ keeps its sign.
    """
    lapse = piece.duration - segment.t
    pull = impulse_of_tension(c, fastest, lapse)
    turn = c.omega * lapse
    rise, fall = max(plate, 0.0), max(-plate, 0.0)
    if segment.cosine * piece.cosine <= 0.0 or turn > 1.0:
        rise = fall = c.a_x * min(max(abs(segment.cosine), abs(piece.cosine)) + turn, 1.0) * lapse
    forward = slip - fall - segment.mu * (gain + pull)
    backward = slip + plate - segment.mu * gain - rise - segment.mu * pull
    return max(forward, backward) > 0.0


@spliced
def slip_end(c, step, segment, slip, leave):
    """Where, in the rest of a contact step, the slip velocity of a segment reaches zero; infinity if it does not.

    `slip` is the slip velocity at the segment's beginning (m/s), `leave` as in polynomial.first_root.
    """
    series, at, mu = step.series, step.at, segment.mu
    plate = segment.sigma * c.a_x / c.omega - mu * c.a_z / c.omega
    fall = mu * c.gravity
    for n in range(ORDER + 1):
        series[SCRATCH, n] = plate * series[at + SINE, n] + mu * series[at + V, n] - fall * series[at + T, n]
    series[SCRATCH, 0] = 0.0
    series[SCRATCH, 0] = segment.sigma * slip - polynomial.value(series, SCRATCH, segment.s)
    return polynomial.first_root(series, SCRATCH, segment.s, step.piece.length, leave)


@spliced
def stick_end(c, step, segment):
    """Where, in the rest of a contact step, |ẍ_s| outgrows μ F_c/m, and whether it stays so until the end.

    |ẍ_s| = a_x |cos θ| has one branch where cos θ has the same sign at both ends. The answer is infinity where the part
    sticks on. While |ẍ_s| > μ F_c/m the slip that begins cannot end.
    """
    series, at, length = step.series, step.at, step.piece.length
    end, lasting = math.inf, False
    for direction in (-1.0, 1.0):
        if direction * segment.cosine <= 0.0 or direction * step.piece.cosine <= 0.0:
            expand_force(c, series, at, c.friction, direction * c.a_x, c.friction * c.rest_force)
            root = polynomial.first_root(series, SCRATCH, segment.s, length, polynomial.LEAVE)
            if root < end:
                for n in range(ORDER):
                    series[SCRATCH, n] *= -1.0
                end = root
                lasting = polynomial.first_root(series, SCRATCH, root, length, polynomial.LEAVE) == math.inf
    return end, lasting


@inlined
def direction_at_rest(c, plate_acceleration, force, mu):
    """Sign of the slip that follows when the slip velocity is zero, or 0 for stick (Filippov's condition).

    plate_acceleration : ẍ_s, m/s²; force : F_c/m, m/s²; mu : friction coefficient that acts
    """
    # The little that the force may lack keeps a part that barely touches from sticking and slipping without end.
    if mu > 0.0 and abs(plate_acceleration) <= mu * (force + c.rest_force):
        return 0.0
    return math.copysign(1.0, plate_acceleration)
