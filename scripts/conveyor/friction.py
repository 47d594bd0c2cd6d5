"""Coulomb friction: slip and stick while the part touches the plate, without integrating anything.

In contact F_c/m = z̈_p + g. While the slip velocity u = ẋ_s - ẋ_p keeps its sign σ, Eq. 12 therefore integrates to

    ẋ_p = ẋ_p0 + σμ [ż_p - ż_p0 + g τ],   x_p = x_p0 + ẋ_p0 τ + σμ [z_p - z_p0 - ż_p0 τ + g τ²/2],

with τ the time since the segment began. Where u reaches zero, Filippov's condition decides: the part sticks while
F_c > 0 and |ẍ_s| ≤ μ F_c/m, else it slips on with the sign of ẍ_s. Along a Taylor step of the vertical motion u and
the margin of stick are polynomials.
"""

import math

from . import polynomial
from .contact import expand_force
from .jit import kernel


@kernel
def slip_end(c, series, start, length, slip, sigma, mu):
    """Where, in (start, length] of a contact step, the slip velocity reaches zero; infinity if it does not.

    `slip` is the slip velocity at `start` (m/s), `sigma` its sign (±1), `mu` the friction coefficient that acts.
    """
    order = c.order
    out, sine, v, t = series.scratch, series.sine, series.v, series.t
    plate = sigma * c.a_x / c.omega
    lift = mu * c.a_z / c.omega
    fall = mu * c.gravity
    for n in range(1, order + 1):
        out[n] = (plate - lift) * sine[n] + mu * v[n] - fall * t[n]
    out[0] = 0.0
    out[0] = sigma * slip - polynomial.value(out, order, start)
    return polynomial.first_root(out, order, start, length)


@kernel
def stick_end(c, series, start, length):
    """Where, in (start, length] of a contact step, |ẍ_s| outgrows μ F_c/m; infinity if it does not."""
    order = c.order
    expand_force(c, series)
    end = math.inf
    for direction in (-1.0, 1.0):
        for n in range(order + 1):
            series.scratch[n] = c.friction * series.force[n] + direction * c.a_x * series.cosine[n]
        end = min(end, polynomial.first_root(series.scratch, order, start, length))
    return end


@kernel
def direction_at_rest(plate_acceleration, force, mu, sigma):
    """Sign of the slip that follows when the slip velocity is zero, or 0 for stick (Filippov's condition).

    plate_acceleration : ẍ_s, m/s²; force : F_c/m, m/s²; mu : friction coefficient that acts;
    sigma : sign of the slip before, which goes over to its opposite where friction cannot hold the part
    """
    if force > 0.0 and mu > 0.0:
        if abs(plate_acceleration) <= mu * force:
            return 0.0
        return math.copysign(1.0, plate_acceleration)
    if sigma != 0.0:
        return -sigma
    return math.copysign(1.0, plate_acceleration)
