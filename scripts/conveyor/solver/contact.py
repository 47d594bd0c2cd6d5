"""Contact: the vertical motion in the plate, in steps of Taylor series.

Each step is one Taylor polynomial in the variable s of contact_law, in which the motion is analytic. Impact and
separation are simple zeros of w with the slope v/2. The half power of the contact law, which costs every integrator in
t its order there, does not appear. Events and samples within a step are roots and values of known polynomials.
"""

import math
from collections import namedtuple

import numpy as np

from . import contact_law, model, plate, polynomial
from .contact_law import expand, expand_sign, twice_elastic_energy
from .jit import compiled, compiled_inline, compiled_into_callers
from .polynomial import ORDER, SIZE
from .workspace import COSINE, FIRST, SINE, SPARE, SPRING, STEP, T, V, W

# Events that end a contact step before its full length.
NOTHING, SEPARATION, FORCE_SIGN = range(3)
# A step that begins with an impact has w = 0 there. The search for its separation begins after this part of the step.
LEAVE_IMPACT = 1e-6
BEFORE_LAST = ORDER - 1

# The constants of one conveyor in the equations of motion, SI units, forces per mass. Gravity has the component
# `gravity`, g cos α, normal to the track, and `downhill`, g sin α, against the feeding direction. A part at rest has
# the √penetration scale_w (√m); scale_v (m/s) is the speed of a fall by this penetration. The last three belong to
# the plate: Bounds, and plate.Waves or None.
Constants = namedtuple(
    "Constants",
    "omega period psi0 a_x a_z gravity downhill cos_shift sin_shift stiffness damping exponent friction "
    "static_friction mass tension tolerance scale_w scale_v edge_w rest_speed rest_force bounds waves",
)


def constants(parameters: np.ndarray, tolerance: float) -> Constants:
    """The Constants of a packed parameter vector (see parameters.PARAMETERS) at a relative tolerance per step."""
    return compute_constants(parameters, tolerance, plate.count_harmonics(parameters))


@compiled
def compute_constants(parameters, tolerance, harmonics):
    """`constants` for compiled callers; `harmonics` as from plate.count_harmonics, which decides on their type."""
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    gravity = model.normal_gravity(parameters)
    exponent = parameters[model.EXPONENT]
    stiffness, damping = contact_law.coefficients_per_mass(parameters)
    static_penetration = contact_law.static_penetration(stiffness, exponent, gravity)
    # cos(π/2) is not zero in floating point.
    along = math.cos(parameters[model.ANGLE]) if parameters[model.ANGLE] < 0.5 * math.pi else 0.0
    a_z = parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE])
    waves = plate.waves_of(parameters, harmonics)
    return Constants(
        omega,
        1.0 / parameters[model.FREQUENCY],
        parameters[model.PSI0],
        parameters[model.ACCELERATION] * along,
        a_z,
        gravity,
        parameters[model.GRAVITY] * math.sin(parameters[model.INCLINATION]),
        math.cos(parameters[model.PHASE_SHIFT]),
        math.sin(parameters[model.PHASE_SHIFT]),
        stiffness,
        damping,
        exponent,
        parameters[model.FRICTION],
        parameters[model.STATIC_FRICTION],
        parameters[model.MASS],
        int(parameters[model.TENSION]),
        tolerance,
        math.sqrt(static_penetration),
        math.sqrt(2.0 * gravity * static_penetration),
        contact_law.edge_of_spring(stiffness, exponent, tolerance * gravity),
        # rest_speed: at this tolerance slower impacts and separations are rest.
        10.0 * tolerance * math.sqrt(2.0 * gravity * static_penetration),
        # rest_force: weaker contact forces, per mass, are none.
        10.0 * tolerance * gravity,
        plate.bounds(waves, a_z, omega),
        waves,
    )


@compiled
def workspace(steps=1):
    """A workspace for the series of one step, or of some steps."""
    return np.zeros(FIRST + steps * STEP)


@compiled_inline
def limiting_term(series, at, lanes, tolerance, scale_v, stiffness, exponent, w0, v0):
    """What limits a step: the error that it allows divided by a term of its series at s = 1, and 1/n for order n.

    The first number to the power of the second is the length in the variable s up to which this term is below that
    error. The last two terms count, of the series of v and of the excitation's phase; w = ∫ v/2 ds follows v. The scale
    of v is the speed of an impact with the present energy, but at least scale_v (m/s). `at` and `lanes` as in
    contact_law.hertz_source.
    """
    v = series[at + np.uint64(V + ORDER) * lanes]
    turn = max(abs(series[at + np.uint64(SINE + ORDER) * lanes]), abs(series[at + np.uint64(COSINE + ORDER) * lanes]))
    scale = max(math.sqrt(v0 * v0 + twice_elastic_energy(stiffness, exponent, w0)), scale_v)
    allowed = tolerance * scale
    last, before = max(abs(v), scale * turn), abs(series[at + np.uint64(V + ORDER - 1) * lanes])
    # Whether the last term is the larger one where the one before reaches the error.
    is_last = (last / before) ** BEFORE_LAST * allowed > before
    return allowed / (last if is_last else before), 1.0 / ORDER if is_last else 1.0 / BEFORE_LAST


@compiled_into_callers
def begin_step(c, series, at, w0, v0, sine0, cosine0, pulled):
    """Expand the motion from w0 ≥ 0, v0: the length in the variable s up to which its series is good.

    c, series, at : Constants, a workspace, and the first row of this step in it
    w0, v0 : √penetration (√m) and speed of approach (m/s)
    sine0, cosine0 : of the excitation's phase
    pulled : whether the contact force is negative; matters for `frictionless` and `clip` only
    """
    expand(c, series, at, w0, v0, sine0, cosine0, pulled and c.tension == model.TENSION_CLIP)
    first, lanes = np.uint64(at), np.uint64(1)
    ratio, root = limiting_term(series, first, lanes, c.tolerance, c.scale_v, c.stiffness, c.exponent, w0, v0)
    length = ratio**root
    if c.edge_w > 0.0 and series[at + SPRING] > 0.0:
        length = min(length, contact_law.length_of_spring(c, series, at, w0, v0))
    return min(length, plate.series_length(c.waves, series, first, lanes, c.tolerance))


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
            series[SPARE + n] = -series[at + W + n]
        series[SPARE] += c.edge_w * (1.0 + 1e-9)
        length = min(length, polynomial.first_root(series, SPARE, 0.0, length, polynomial.LEAVE))
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
    if c.tension != model.TENSION_ALLOW and expand_sign(c, series, at, SPARE, -1.0 if pulled else 1.0):
        # The series may have a root of its own at a separation.
        end = length * (1.0 - LEAVE_IMPACT) if event == SEPARATION else length
        root = polynomial.first_root(series, SPARE, 0.0, end, polynomial.LEAVE)
        if root < end:
            length = root
            event = FORCE_SIGN
            shortened = True
    if shortened:
        w, v = polynomial.value(series, at + W, length), polynomial.value(series, at + V, length)
    if event == SEPARATION:
        w = 0.0
    return length, w, v, polynomial.value(series, at + T, length), event
