"""Contact: the vertical motion in the plate, by Taylor series in a variable in which it is analytic.

With the penetration δ = -q = w² and the time dt = w ds (a Sundman transformation) the equations of motion of a Hertz
contact become polynomial,

    w' = v/2,   t' = w,   v' = w (g + a_z cos θ - (d_c/m) v) - (k_c/m) w^(2p+1),   θ' = ω w,

where v = δ̇ is the speed of approach and ' = d/ds. Impact and separation are plain zeros of w with the slope v/2: the
half power of the contact law, which costs every integrator in t its order there, is gone, and for p = 1 and 3/2
nothing singular is left on the real axis. Every step is one Taylor polynomial, so events and samples inside a step are
roots and values of polynomials that are already known.

For any other exponent w^(2p+1) is smooth only where w > 0. Below the penetration where the spring weighs less than
`tolerance` times the part it is switched off, and above it the series comes from the recurrence of a power.
"""

import math
from collections import namedtuple

import numpy as np

from . import polynomial
from .jit import kernel
from .model import (
    ACCELERATION,
    ANGLE,
    DAMPING,
    EXPONENT,
    FREQUENCY,
    FRICTION,
    GRAVITY,
    MASS,
    PSI0,
    STIFFNESS,
    TENSION,
)

MAX_ORDER = 30
# What ends a contact step before its full length.
NOTHING, SEPARATION, FORCE_SIGN = range(3)

# Constants of one conveyor in the form in which the equations need them; all per unit mass, SI units.
Constants = namedtuple(
    "Constants",
    "omega period psi0 a_x a_z gravity stiffness damping exponent friction mass tension "
    "order tolerance scale_w scale_v edge_w",
)

# Taylor coefficients of one step, each of shape (MAX_ORDER + 1,); `force` and `scratch` are filled when needed.
Series = namedtuple("Series", "w t v sine cosine square power force scratch")


@kernel
def constants(parameters, tolerance):
    """The Constants of a packed parameter vector (see model.PARAMETERS) at a relative tolerance per step."""
    omega = 2.0 * math.pi * parameters[FREQUENCY]
    mass = parameters[MASS]
    gravity = parameters[GRAVITY]
    exponent = parameters[EXPONENT]
    stiffness = parameters[STIFFNESS] / mass
    # Half the digits of the tolerance, in natural logarithms, is the order at which a digit costs least.
    order = min(max(int(math.ceil(2.0 - 0.55 * math.log(tolerance))), 5), MAX_ORDER)
    static_penetration = (gravity / stiffness) ** (1.0 / exponent)
    edge_w = 0.0
    if exponent != 1.5 and exponent != 1.0:
        edge_w = (tolerance * gravity / stiffness) ** (0.5 / exponent)
    return Constants(
        omega,
        1.0 / parameters[FREQUENCY],
        parameters[PSI0],
        parameters[ACCELERATION] * math.cos(parameters[ANGLE]),
        parameters[ACCELERATION] * math.sin(parameters[ANGLE]),
        gravity,
        stiffness,
        parameters[DAMPING] / mass,
        exponent,
        parameters[FRICTION],
        mass,
        int(parameters[TENSION]),
        order,
        tolerance,
        math.sqrt(static_penetration),
        math.sqrt(2.0 * gravity * static_penetration),
        edge_w,
    )


@kernel
def workspace():
    """Empty Series."""
    size = MAX_ORDER + 1
    return Series(
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
    )


@kernel
def force(c, w, v):
    """Contact force per mass, m/s², at w = √penetration and the speed of approach v (Eq. 9)."""
    if c.exponent == 1.5:
        return c.stiffness * w * w * w + c.damping * v
    return c.stiffness * max(w, 0.0) ** (2.0 * c.exponent) + c.damping * v


@kernel
def expand(c, series, w0, v0, sine0, cosine0, free):
    """Fill w, t, v, sine, cosine of `series` from their values at s = 0; `free` leaves the contact force out."""
    w, t, v, sine, cosine, square, power = (
        series.w,
        series.t,
        series.v,
        series.sine,
        series.cosine,
        series.square,
        series.power,
    )
    stiffness = 0.0 if free else c.stiffness
    damping = 0.0 if free else c.damping
    gravity, a_z, omega = c.gravity, c.a_z, c.omega
    hertz = c.exponent == 1.5
    hooke = c.exponent == 1.0
    exponent = 2.0 * c.exponent + 1.0
    w[0] = w0
    t[0] = 0.0
    v[0] = v0
    sine[0] = sine0
    cosine[0] = cosine0
    square[0] = w0 * w0
    # Without the recurrence for the power (w near zero) the spring does not act: see the head of this file.
    general = not hertz and not hooke and w0 > c.edge_w
    if not hertz and not hooke:
        power[:] = 0.0
        if general:
            power[0] = w0**exponent
    for n in range(c.order):
        inverse = 1.0 / (n + 1)
        w[n + 1] = 0.5 * v[n] * inverse
        t[n + 1] = w[n] * inverse
        # Products of two series; the terms k and n - k are summed together, squares need only half of them.
        cosine_w, cosine_w_mirrored = 0.0, 0.0
        sine_w, sine_w_mirrored = 0.0, 0.0
        spring = 0.0
        doubled = 0.0
        middle = (n + 1) // 2
        for k in range(middle):
            cosine_w += cosine[k] * w[n - k]
            cosine_w_mirrored += cosine[n - k] * w[k]
            sine_w += sine[k] * w[n - k]
            sine_w_mirrored += sine[n - k] * w[k]
            spring += square[k] * square[n - k]
            doubled += w[k] * w[n + 1 - k]
        if n % 2 == 0:
            cosine_w += cosine[middle] * w[middle]
            sine_w += sine[middle] * w[middle]
            spring = 2.0 * spring + square[middle] * square[middle]
            square[n + 1] = 2.0 * (doubled + w[middle] * w[middle + 1])
        else:
            spring = 2.0 * spring
            square[n + 1] = 2.0 * doubled + w[middle] * w[middle]
        cosine_w += cosine_w_mirrored
        sine_w += sine_w_mirrored
        if not hertz:
            spring = power[n]
            if hooke:
                spring = 0.0
                for k in range(n + 1):
                    spring += square[k] * w[n - k]
        cosine[n + 1] = -omega * sine_w * inverse
        sine[n + 1] = omega * cosine_w * inverse
        # d/ds (v + d_c/m w²) needs no product of v and w, since w² has the derivative v w.
        rate = gravity * w[n] + a_z * cosine_w - stiffness * spring
        v[n + 1] = rate * inverse - damping * square[n + 1]
        if general:
            total = 0.0
            for k in range(1, n + 2):
                total += (k * exponent - (n + 1 - k)) * w[k] * power[n + 1 - k]
            power[n + 1] = total * inverse / w0


@kernel
def expand_force(c, series):
    """Fill `force` of `series`: the contact force per mass along a step, from w, v and square."""
    w, v, square, out, scratch = series.w, series.v, series.square, series.force, series.scratch
    if c.exponent == 1.0:
        for n in range(c.order + 1):
            out[n] = c.stiffness * square[n] + c.damping * v[n]
    elif c.exponent == 1.5:
        for n in range(c.order + 1):
            total = 0.0
            for k in range(n + 1):
                total += square[k] * w[n - k]
            out[n] = c.stiffness * total + c.damping * v[n]
    else:
        exponent = 2.0 * c.exponent
        general = w[0] > c.edge_w
        scratch[0] = w[0] ** exponent if general else 0.0
        for n in range(c.order + 1):
            if n > 0:
                total = 0.0
                if general:
                    for k in range(1, n + 1):
                        total += (k * exponent - (n - k)) * w[k] * scratch[n - k]
                    total /= n * w[0]
                scratch[n] = total
            out[n] = c.stiffness * scratch[n] + c.damping * v[n]


@kernel
def step_length(c, series, w0, v0):
    """Length in s at which the last two terms of v's series are below the tolerance; those of w = ∫ v/2 ds then are too.

    The scale is the speed of an impact with the present energy, and never less than that of the part at rest.
    """
    order = c.order
    potential = w0**5 if c.exponent == 1.5 else w0 ** (2.0 * c.exponent + 2.0)
    scale = math.sqrt(v0 * v0 + 2.0 * c.stiffness * potential / (c.exponent + 1.0))
    allowed = c.tolerance * max(scale, c.scale_v)
    last = abs(series.v[order])
    before = abs(series.v[order - 1])
    length = 1e300
    if last > 0.0:
        length = (allowed / last) ** (1.0 / order)
    if before > 0.0:
        length = min(length, (allowed / before) ** (1.0 / (order - 1)))
    return length


@kernel
def step(c, series, w0, v0, sine0, cosine0, pulled):
    """Expand the motion from w0 ≥ 0, v0 and find where its step ends.

    Parameters
    ----------
    c, series : Constants and the Series to fill
    w0, v0 : √penetration (√m) and speed of approach (m/s)
    sine0, cosine0 : of the excitation's phase
    pulled : True while the contact force is negative; looked at for `frictionless` and `clip` only

    Returns
    -------
    length, event : length of the step in s, and NOTHING, SEPARATION or FORCE_SIGN (the contact force passes zero)
    """
    order = c.order
    expand(c, series, w0, v0, sine0, cosine0, pulled and c.tension == 2)
    length = step_length(c, series, w0, v0)
    w = series.w
    event = NOTHING
    if c.edge_w > 0.0 and w0 <= c.edge_w and polynomial.value(w, order, length) > c.edge_w:
        for n in range(order + 1):
            series.scratch[n] = -w[n]
        series.scratch[0] += c.edge_w * (1.0 + 1e-9)
        length = min(length, polynomial.first_root(series.scratch, order, 0.0, length))
    # w is convex or concave between zeros of the acceleration, so only a fall can end on, or dip below, zero.
    if v0 < 0.0 or polynomial.value(series.v, order, length) < 0.0:
        root = polynomial.first_root(w, order, 0.0, length)
        if root <= length:
            length = root
            event = SEPARATION
    if c.tension != 0 and c.damping > 0.0:
        expand_force(c, series)
        sign = -1.0 if pulled else 1.0
        for n in range(order + 1):
            series.scratch[n] = sign * series.force[n]
        root = polynomial.first_root(series.scratch, order, 0.0, length)
        if root < length:
            length = root
            event = FORCE_SIGN
    return length, event
