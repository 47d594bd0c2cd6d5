"""Contact: the vertical motion in the plate, by Taylor series in a variable in which it is analytic.

With the penetration δ = -q = w² and the time dt = w ds (a Sundman transformation) the equations of motion of a Hertz
contact become polynomial,

    w' = v/2,   t' = w,   v' = w (g + a_z cos θ - (d_c/m) v) - (k_c/m) w^(2p+1),   θ' = ω w,

where v = δ̇ is the speed of approach and ' = d/ds. Impact and separation are simple zeros of w with the slope v/2. The
half power of the contact law, which costs every integrator in t its order there, does not appear, and for p = 1 and 3/2
no singularity is left on the real axis. Each step is one Taylor polynomial, so that events and samples within a step
are roots and values of known polynomials.

For any other exponent w^(2p+1) is smooth only where w > 0. The spring is therefore switched off below the penetration
at which its force is `tolerance` times the weight; above it the series follows from the recurrence of a power.
"""

import math
from collections import namedtuple

import numpy as np

from . import model, polynomial, unrolled
from .jit import compiled, compiled_inline, compiled_into_callers
from .polynomial import ORDER, SHIFTED, SIZE
from .unrolled import COSINE, COSINE_W, ROWS, SINE, SPRING, SQUARE, T, V, W

# Events that end a contact step before its full length.
NOTHING, SEPARATION, FORCE_SIGN = range(3)
# A step that begins with an impact has w = 0 there. The search for its separation begins after this part of the step.
LEAVE_IMPACT = 1e-6

# The constants of one conveyor in the equations of motion, SI units, forces per mass. Gravity has the component
# `gravity`, g cos α, normal to the track, and `downhill`, g sin α, against the feeding direction. A part at rest has
# the √penetration scale_w (√m); scale_v (m/s) is the speed of a fall by this penetration.
Constants = namedtuple(
    "Constants",
    "omega period psi0 a_x a_z gravity downhill cos_shift sin_shift stiffness damping exponent friction "
    "static_friction mass tension tolerance scale_w scale_v edge_w rest_speed rest_force",
)

# A workspace is an array of rows of Taylor coefficients, shape (FIRST + steps ROWS, SIZE). The first row belongs to the
# search for roots and SCRATCH is free. Each step has ROWS rows, see unrolled: `at` + W, `at` + T, and so forth.
SCRATCH = SHIFTED + 1
FIRST = SCRATCH + 1


@compiled
def constants(parameters, tolerance):
    """The Constants of a packed parameter vector (see parameters.PARAMETERS) at a relative tolerance per step."""
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    mass = parameters[model.MASS]
    gravity = parameters[model.GRAVITY] * math.cos(parameters[model.INCLINATION])
    exponent = parameters[model.EXPONENT]
    stiffness = parameters[model.STIFFNESS] / mass
    static_penetration = (gravity / stiffness) ** (1.0 / exponent)
    edge_w = 0.0
    if exponent != 1.5 and exponent != 1.0:
        edge_w = (tolerance * gravity / stiffness) ** (0.5 / exponent)
    return Constants(
        omega,
        1.0 / parameters[model.FREQUENCY],
        parameters[model.PSI0],
        parameters[model.ACCELERATION] * math.cos(parameters[model.ANGLE]),
        parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE]),
        gravity,
        parameters[model.GRAVITY] * math.sin(parameters[model.INCLINATION]),
        math.cos(parameters[model.PHASE_SHIFT]),
        math.sin(parameters[model.PHASE_SHIFT]),
        stiffness,
        parameters[model.DAMPING] / mass,
        exponent,
        parameters[model.FRICTION],
        parameters[model.STATIC_FRICTION],
        mass,
        int(parameters[model.TENSION]),
        tolerance,
        math.sqrt(static_penetration),
        math.sqrt(2.0 * gravity * static_penetration),
        edge_w,
        # rest_speed: at this tolerance slower impacts and separations are rest.
        10.0 * tolerance * math.sqrt(2.0 * gravity * static_penetration),
        # rest_force: weaker contact forces, per mass, are none.
        10.0 * tolerance * gravity,
    )


@compiled
def workspace():
    """A workspace for the series of one step."""
    return np.zeros((FIRST + ROWS, SIZE))


@compiled_inline
def force(c, w, v):
    """Contact force per mass, m/s², at w = √penetration and the speed of approach v (Eq. 9)."""
    if c.exponent == 1.5:
        return c.stiffness * w * w * w + c.damping * v
    return c.stiffness * max(w, 0.0) ** (2.0 * c.exponent) + c.damping * v


@compiled_into_callers
def impulse_of_tension(c, fastest, lapse):
    """Bound on the impulse per mass (m/s) of a force that pulls during a time `lapse` (s).

    fastest : m/s, a bound on the speed of separation without what gravity and the plate add during the time
    """
    return c.damping * (fastest + 2.0 * (c.gravity + c.a_z) * lapse) * lapse


@compiled_inline
def is_hertz(c):
    """Whether the generated code of the module unrolled holds for this contact."""
    return c.exponent == 1.5


expand_hertz = compiled(unrolled.expand_hertz)


@compiled_into_callers
def power_term(series, w, power, exponent, n):
    """Coefficient n ≥ 1 of w^exponent (row `power`) from the lower coefficients, for w_0 > 0."""
    total = 0.0
    for k in range(1, n + 1):
        total += (k * exponent - (n - k)) * series[w, k] * series[power, n - k]
    return total / (n * series[w, 0])


@compiled
def expand_other(w0, v0, sine0, cosine0, gravity, a_z, omega, stiffness, damping, exponent, edge_w, series, at):
    """Fill the rows of a step for any contact exponent. Below `edge_w` (√m), the spring is switched off, see above."""
    w, t, v, sine, cosine = at + W, at + T, at + V, at + SINE, at + COSINE
    square, spring = at + SQUARE, at + SPRING
    hooke = exponent == 1.0
    of_w = 2.0 * exponent + 1.0
    series[w, 0] = w0
    series[t, 0] = 0.0
    series[v, 0] = v0
    series[sine, 0] = sine0
    series[cosine, 0] = cosine0
    series[square, 0] = w0 * w0
    general = not hooke and w0 > edge_w
    series[spring, :] = 0.0
    if general:
        series[spring, 0] = w0**of_w
    for n in range(ORDER):
        inverse = 1.0 / (n + 1)
        series[w, n + 1] = 0.5 * series[v, n] * inverse
        series[t, n + 1] = series[w, n] * inverse
        cosine_w = sine_w = cube = 0.0
        doubled = series[w, n + 1] * w0
        for k in range(n + 1):
            cosine_w += series[cosine, k] * series[w, n - k]
            sine_w += series[sine, k] * series[w, n - k]
            cube += series[square, k] * series[w, n - k]
            doubled += series[w, k] * series[w, n + 1 - k]
        if hooke:
            series[spring, n] = cube
        series[at + COSINE_W, n] = cosine_w
        series[square, n + 1] = doubled
        series[cosine, n + 1] = -omega * sine_w * inverse
        series[sine, n + 1] = omega * cosine_w * inverse
        rate = gravity * series[w, n] + a_z * cosine_w - stiffness * series[spring, n]
        series[v, n + 1] = rate * inverse - damping * doubled
        if general:
            series[spring, n + 1] = power_term(series, w, spring, of_w, n + 1)


@compiled_into_callers
def expand(c, series, at, w0, v0, sine0, cosine0, free):
    """Fill the rows of a step from their values at s = 0; `free` leaves the contact force out."""
    stiffness = 0.0 if free else c.stiffness
    damping = 0.0 if free else c.damping
    if is_hertz(c):
        expand_hertz(w0, v0, sine0, cosine0, c.gravity, c.a_z, c.omega, stiffness, damping, series, at)
    else:
        expand_other(
            w0, v0, sine0, cosine0, c.gravity, c.a_z, c.omega, stiffness, damping, c.exponent, c.edge_w, series, at
        )


@compiled
def expand_power(c, series, at, exponent):
    """Fill the row SCRATCH with the series of w^exponent along a step; it is 0 where the spring is switched off."""
    series[SCRATCH, :] = 0.0
    if series[at + W, 0] > c.edge_w:
        series[SCRATCH, 0] = series[at + W, 0] ** exponent
        for n in range(1, ORDER):
            series[SCRATCH, n] = power_term(series, at + W, SCRATCH, exponent, n)


@compiled_inline
def expand_force(c, series, at, scale, plate, slack):
    """Fill the row SCRATCH with the series of w (scale F_c/m + plate cos(θ + ε) + slack).

    The series has the sign of the expression in brackets. The product of sin θ and w follows from
    (cos θ)' = -ω w sin θ.
    """
    plate, turned = plate * c.cos_shift, plate * c.sin_shift / c.omega
    for n in range(ORDER):
        force = c.stiffness * series[at + SPRING, n] + c.damping * (n + 1) * series[at + SQUARE, n + 1]
        series[SCRATCH, n] = scale * force + plate * series[at + COSINE_W, n] + slack * series[at + W, n]
    if turned != 0.0:
        for n in range(ORDER):
            series[SCRATCH, n] += turned * (n + 1) * series[at + COSINE, n + 1]
    series[SCRATCH, ORDER] = 0.0


@compiled_inline
def step_length(c, series, at, w0, v0):
    """Length of the step in the variable s up to which the last two terms of the series are below the tolerance.

    The series of v and of the excitation's phase count; w = ∫ v/2 ds follows v. The scale of v is the speed of an
    impact with the present energy, but at least scale_v.
    """
    w2 = w0 * w0
    potential = w2 * w2 * w0 if c.exponent == 1.5 else w0 ** (2.0 * c.exponent + 2.0)
    scale = math.sqrt(v0 * v0 + 2.0 * c.stiffness * potential / (c.exponent + 1.0))
    scale = max(scale, c.scale_v)
    allowed = c.tolerance * scale
    last = max(abs(series[at + V, ORDER]), scale * max(abs(series[at + SINE, ORDER]), abs(series[at + COSINE, ORDER])))
    before = abs(series[at + V, ORDER - 1])
    length = 1e300
    if before > 0.0:
        length = (allowed / before) ** (1.0 / (ORDER - 1))
    if last * length > before:
        length = min(length, (allowed / last) ** (1.0 / ORDER))
    if c.edge_w > 0.0 and series[at + SPRING, 0] > 0.0:
        # Beyond the radius of convergence of w^(2p+1), v may still be right, but the sign of the force is not.
        of_spring = c.stiffness * abs(series[at + SPRING, ORDER - 1])
        allowed = c.tolerance * (c.stiffness * series[at + SPRING, 0] + w0 * (c.damping * abs(v0) + c.gravity))
        length = min(length, (allowed / of_spring) ** (1.0 / (ORDER - 1)))
    return length


@compiled_into_callers
def begin_step(c, series, at, w0, v0, sine0, cosine0, pulled):
    """Expand the motion from w0 ≥ 0, v0: the length in the variable s up to which its series is good.

    c, series, at : Constants, a workspace, and the first row of this step in it
    w0, v0 : √penetration (√m) and speed of approach (m/s)
    sine0, cosine0 : of the excitation's phase
    pulled : whether the contact force is negative; matters for `frictionless` and `clip` only
    """
    expand(c, series, at, w0, v0, sine0, cosine0, pulled and c.tension == model.TENSION_CLIP)
    return step_length(c, series, at, w0, v0)


@compiled_into_callers
def end_step(c, series, at, w0, v0, pulled, length):
    """Find the end of a step whose series is valid up to `length`; the other arguments as in `begin_step`.

    Returns
    -------
    length, w, v, lapse, event : length of the step in the variable s; w, v at its end; its duration (s); the event that
        ends it, NOTHING, SEPARATION or FORCE_SIGN (the contact force passes zero)
    """
    event = NOTHING
    w, v = polynomial.value(series, at + W, length), polynomial.value(series, at + V, length)
    shortened = False
    if c.edge_w > 0.0 and w0 <= c.edge_w and w > c.edge_w:
        for n in range(SIZE):
            series[SCRATCH, n] = -series[at + W, n]
        series[SCRATCH, 0] += c.edge_w * (1.0 + 1e-9)
        length = min(length, polynomial.first_root(series, SCRATCH, 0.0, length, polynomial.LEAVE))
        shortened = True
    elif w <= 0.0:
        # w starts upwards at an impact and falls through zero once: w'' has the sign of w where the plate presses on.
        length = polynomial.root_of_crossing(series, at + W, 0.0 if w0 > 0.0 else LEAVE_IMPACT * length, length)
        event = SEPARATION
        shortened = True
    elif v0 < 0.0 and v > 0.0:
        root = polynomial.first_root(series, at + W, 0.0, length, polynomial.LEAVE)
        if root <= length:
            length = root
            event = SEPARATION
            shortened = True
    if c.tension != model.TENSION_ALLOW and c.damping > 0.0:
        expand_force(c, series, at, -1.0 if pulled else 1.0, 0.0, 0.0)
        # The series has the factor w, and so a root of its own at a separation.
        end = length * (1.0 - LEAVE_IMPACT) if event == SEPARATION else length
        root = polynomial.first_root(series, SCRATCH, 0.0, end, polynomial.LEAVE)
        if root < end:
            length = root
            event = FORCE_SIGN
            shortened = True
    if shortened:
        w, v = polynomial.value(series, at + W, length), polynomial.value(series, at + V, length)
    if event == SEPARATION:
        w = 0.0
    return length, w, v, polynomial.value(series, at + T, length), event
