"""The contact law F_c = k_c δ^p + d_c δ̇, in every form in which the solver needs it.

A change of the law begins here: `law.spring_and_damper` is the law itself, which the other methods and `impact`
call, too. `next_speed` is its part in the Taylor recurrences of the motion in the plate. The other functions are its
series along a contact step, its rate, its energy and a bound on its tension, its linearisation, and its dimensionless
groups.

With the penetration δ = -q = w² and the time dt = w ds (a Sundman transformation) the equations of motion of a Hertz
contact become polynomial,

    w' = v/2,   t' = w,   v' = w (g + z̈_s - (d_c/m) v) - (k_c/m) w^(2p+1),   θ' = ω w,

where v = δ̇ is the speed of approach and ' = d/ds. Because v w is the derivative of w², the equation for v + (d_c/m) w²
needs no product of v and w. For p = 1 and 3/2 no singularity is left on the real axis. For any other exponent w^(2p+1)
is smooth only where w > 0. The spring is therefore switched off below the √penetration `edge_w`; above it the series
follows from the recurrence of a power.
"""

import numpy as np

from . import law, model, plate
from .jit import compiled, compiled_inline, compiled_into_callers, fma
from .plate import numbers_at, rows_of_wave  # noqa: F401 - for generated code
from .polynomial import ORDER, SIZE, place
from .unrolled import square
from .workspace import COSINE, LIFT_W, SINE, SPARE, SPRING, SQUARE, T, V, W

# The letters of the rows of a step in the generated code.
LETTERS = {W: "w", T: "t", V: "v", SINE: "s", COSINE: "c", SQUARE: "q", SPRING: "p", LIFT_W: "x"}
# Rows of a perturbation's expansion.
ETA, ZETA, RATE = range(3)
# The unit of the damping d_c, made of the mass, ω and the gravity normal to the track, has these powers of the three.
POWERS_IN_DAMPING = (1, 1, 0)


spring_and_damper = compiled_inline(law.spring_and_damper)


@compiled_inline
def coefficients_per_mass(parameters):
    """k_c/m and d_c/m of a packed parameter vector."""
    mass = parameters[model.MASS]
    return parameters[model.STIFFNESS] / mass, parameters[model.DAMPING] / mass


@compiled_inline
def force(c, w, v):
    """Contact force per mass, m/s², at w = √penetration and the speed of approach v (Eq. 9)."""
    if c.exponent == 1.5:
        return spring_and_damper(c.stiffness * w * w * w, c.damping, v)
    return spring_and_damper(c.stiffness * max(w, 0.0) ** (2.0 * c.exponent), c.damping, v)


@compiled_inline
def force_rate(c, w, v, press):
    """Rate of the contact force per mass (m/s³) at w, v and the acceleration g + z̈_s (m/s²)."""
    stiffening = c.stiffness * c.exponent * v
    if c.exponent == 1.5:
        stiffening *= w
    elif c.exponent != 1.0:
        stiffening *= max(w, 0.0) ** (2.0 * c.exponent - 2.0)
    return stiffening + c.damping * (press - force(c, w, v))


@compiled_inline
def smooth_speed(c, delta, v):
    """Y = v + (d_c/m) max(δ, 0): its rate g + z̈_s - (k_c/m) max(δ, 0)^p is continuous across impact and separation.

    c : contact.Constants, or dimensionless_groups.Groups for a scaled state
    """
    return v + c.damping * max(delta, 0.0)


@compiled_inline
def speed_of_approach(c, delta, smooth):
    """The speed of approach v from δ and Y, the inverse of `smooth_speed`."""
    return smooth - c.damping * max(delta, 0.0)


@compiled_inline
def smooth_slope(c, delta):
    """∂Y/∂δ (1/s) at constant v at a penetration δ > 0, h d_c/m for a damper with the force d_c h(δ) δ̇; here h = 1."""
    return c.damping


@compiled_inline
def damper_time(c, series, at, length, duration):
    """∫ h dt (s) of the damper, see `smooth_slope`, over a contact step of a length in s and a duration (s)."""
    return duration


@compiled_inline
def log_contraction(c, damper_time):
    """Logarithm of the factor by which areas of states (δ, v) change, from the sum of `damper_time`."""
    return -c.damping * damper_time


@compiled_into_callers
def impulse_of_tension(c, fastest, lapse):
    """Bound on the impulse per mass (m/s) of a force that pulls during a time `lapse` (s).

    fastest : m/s, a bound on the speed of separation without what gravity and the plate add during the time
    """
    return c.damping * (fastest + 2.0 * (c.gravity + c.bounds.lift) * lapse) * lapse


@compiled_inline
def static_penetration(stiffness, exponent, press):
    """The penetration δ (m) at which the spring carries a force per mass (m/s²); stiffness per mass."""
    return (press / stiffness) ** (1.0 / exponent)


@compiled_inline
def edge_of_spring(stiffness, exponent, press):
    """The √penetration edge_w (√m): the spring's force per mass (m/s²) is `press` there; 0 if no edge is needed."""
    return 0.0 if exponent == 1.5 or exponent == 1.0 else (press / stiffness) ** (0.5 / exponent)


@compiled_inline
def twice_elastic_energy(stiffness, exponent, w):
    """Twice the energy per mass (m²/s²) of the spring at w = √penetration."""
    square = w * w
    power = square * square * w if exponent == 1.5 else w ** (2.0 * exponent + 2.0)
    return 2.0 * stiffness * power / (exponent + 1.0)


@compiled_inline
def next_speed(inverse, w, lift_w, spring, square, gravity, a_z, stiffness, damping):
    """Coefficient n + 1 of v from coefficients n of w, w z̈_s/a_z and w^(2p+1), and n + 1 of w²; inverse = 1/(n + 1)."""
    rate = fma(-stiffness, spring, fma(a_z, lift_w, gravity * w))
    return fma(-damping, square, rate * inverse)


def hertz_source(*, harmonics: bool) -> str:
    """Source of `expand_hertz` or, with `harmonics`, `expand_harmonic_hertz`: they fill the rows of a step for p = 3/2.

    Its arguments are w, v, sine and cosine at s = 0; gravity, a_z, omega, stiffness and damping per mass; the array,
    the place of its first coefficient, and the number of lanes, both unsigned; whether the last three rows are wanted.
    `expand_harmonic_hertz` also takes the place of the first harmonic, unsigned, the number of harmonics, and cosine
    and sine of the phase shift. Its first coefficients are those of `plate.begin_waves`.
    """
    arguments = "w0, v0, s0, c0, gravity, a_z, omega, stiffness, damping, series, at, lanes, all_rows"
    lines = [f"def expand_hertz({arguments}):"]
    if harmonics:
        lines = [f"def expand_harmonic_hertz({arguments}, waves, harmonics, cos_shift, sin_shift):"]
    lines += ["t0 = 0.0", "q0 = w0 * w0"]
    for n in range(ORDER):
        inverse = 1.0 / (n + 1)
        lines += [
            f"w{n + 1} = v{n} * {0.5 * inverse!r}",
            f"t{n + 1} = w{n} * {inverse!r}",
            f"q{n + 1} = {square('w', n + 1)}",
            *plate.recurrence(n, harmonics=harmonics),
            f"p{n} = {square('q', n)}",
            f"v{n + 1} = next_speed({inverse!r}, w{n}, x{n}, p{n}, q{n + 1}, gravity, a_z, stiffness, damping)",
        ]
    for row, letter in LETTERS.items():
        if row == SQUARE:
            lines += ["if not all_rows:", "    return"]
        terms = ORDER if row in (SPRING, LIFT_W) else ORDER + 1
        for n in range(SIZE):
            lines += [f"series[at] = {letter}{n}"] if n < terms else []
            lines += ["at += lanes"]
    return "\n    ".join(lines) + "\n"


# Named after this file, so that numba can cache the machine code.
for harmonics in (False, True):
    exec(compile(hertz_source(harmonics=harmonics), __file__, "exec"))
expand_hertz, expand_harmonic_hertz = compiled_inline(expand_hertz), compiled_inline(expand_harmonic_hertz)  # noqa: F821


@compiled
def expand_one_hertz(w0, v0, sine0, cosine0, gravity, a_z, omega, stiffness, damping, series, at):
    """`expand_hertz` for one trajectory."""
    first, lanes = np.uint64(at), np.uint64(1)
    expand_hertz(w0, v0, sine0, cosine0, gravity, a_z, omega, stiffness, damping, series, first, lanes, True)


@compiled
def expand_one_harmonic_hertz(c, w0, v0, sine0, cosine0, stiffness, damping, series, at):
    """`expand_harmonic_hertz` for one trajectory."""
    plate.begin_series(c, c.waves, series, at, sine0, cosine0)
    first, lanes = np.uint64(at), np.uint64(1)
    constants = c.gravity, c.a_z, c.omega, stiffness, damping
    waves = plate.WAVES, c.waves.count, c.cos_shift, c.sin_shift
    expand_harmonic_hertz(w0, v0, sine0, cosine0, *constants, series, first, lanes, True, *waves)


@compiled_inline
def expand_any_hertz(c, waves, w0, v0, sine0, cosine0, stiffness, damping, series, at):
    """Fill the rows of a step for p = 3/2, for a plate with plate.Waves, or None."""
    if waves is None:
        expand_one_hertz(w0, v0, sine0, cosine0, c.gravity, c.a_z, c.omega, stiffness, damping, series, at)
    else:
        expand_one_harmonic_hertz(c, w0, v0, sine0, cosine0, stiffness, damping, series, at)


@compiled_into_callers
def power_term(series, w, power, exponent, n):
    """Coefficient n ≥ 1 of w^exponent (row `power`) from the lower coefficients, for w_0 > 0."""
    total = 0.0
    for k in range(1, n + 1):
        total += (k * exponent - (n - k)) * series[place(w, k)] * series[place(power, n - k)]
    return total / (n * series[w])


@compiled
def expand_other(c, w0, v0, sine0, cosine0, stiffness, damping, series, at):
    """Fill the rows of a step for any conveyor. Below `edge_w` (√m), the spring is switched off, see above."""
    w, t, v, squared, spring = at + W, at + T, at + V, at + SQUARE, at + SPRING
    hooke = c.exponent == 1.0
    of_w = 2.0 * c.exponent + 1.0
    series[w] = w0
    series[t] = 0.0
    series[v] = v0
    plate.begin_series(c, c.waves, series, at, sine0, cosine0)
    series[squared] = w0 * w0
    general = not hooke and w0 > c.edge_w
    for n in range(SIZE):
        series[spring + n] = 0.0
    if general:
        series[spring] = w0**of_w
    for n in range(ORDER):
        inverse = 1.0 / (n + 1)
        series[w + n + 1] = 0.5 * series[v + n] * inverse
        series[t + n + 1] = series[w + n] * inverse
        plate.extend_series(c, c.waves, series, at, n)
        cube = 0.0
        doubled = series[w + n + 1] * w0
        for k in range(n + 1):
            cube += series[place(squared, k)] * series[place(w, n - k)]
            doubled += series[place(w, k)] * series[place(w, n + 1 - k)]
        if hooke:
            series[spring + n] = cube
        series[squared + n + 1] = doubled
        lift_w = series[at + LIFT_W + n]
        series[v + n + 1] = next_speed(
            inverse, series[w + n], lift_w, series[spring + n], doubled, c.gravity, c.a_z, stiffness, damping
        )
        if general:
            series[spring + n + 1] = power_term(series, w, spring, of_w, n + 1)


@compiled_into_callers
def expand(c, series, at, w0, v0, sine0, cosine0, free):
    """Fill the rows of a step from their values at s = 0; `free` leaves the contact force out."""
    stiffness = 0.0 if free else c.stiffness
    damping = 0.0 if free else c.damping
    if c.exponent == 1.5:
        expand_any_hertz(c, c.waves, w0, v0, sine0, cosine0, stiffness, damping, series, at)
    else:
        expand_other(c, w0, v0, sine0, cosine0, stiffness, damping, series, at)


@compiled_inline
def row_of(series, row):
    """The coefficients of a row of a workspace."""
    return series[row : row + SIZE]


@compiled_inline
def length_of_spring(c, series, at, w0, v0):
    """Length of a step in the variable s up to which the spring's series is accurate, for w0 > edge_w and other p.

    Beyond the radius of convergence of w^(2p+1), v may still be right, but the sign of the force is not.
    """
    last = c.stiffness * abs(series[at + SPRING + ORDER - 1])
    allowed = c.tolerance * (c.stiffness * series[at + SPRING] + w0 * (c.damping * abs(v0) + c.gravity))
    return (allowed / last) ** (1.0 / (ORDER - 1))


@compiled_inline
def expand_stiffness(c, series, at, row):
    """The rate -∂Ẏ/∂δ of a closed contact in the variable s, as a factor and the coefficients that it multiplies.

    The coefficients are in a row of the step or, for most exponents, in the given row.
    """
    factor = c.exponent * c.stiffness
    power = row_of(series, row)
    if c.exponent == 1.5:
        power = row_of(series, at + SQUARE)
    elif c.exponent == 1.0:
        power = row_of(series, at + W)
    else:  # w^(2p-1), but 0 where the spring is switched off
        exponent = 2.0 * c.exponent - 1.0
        for n in range(SIZE):
            series[row + n] = 0.0
        if series[at + W] > c.edge_w:
            series[row] = series[at + W] ** exponent
            for n in range(1, ORDER):
                series[row + n] = power_term(series, at + W, row, exponent, n)
    return factor, power


@compiled
def expand_tangents(c, series, at, expansions, free):
    """Fill the Taylor coefficients of two perturbations along a contact step from η and ζ at s = 0.

    With the derivative in s, η' = w (ζ - (d_c/m) η) and ζ' = -p (k_c/m) w^(2p-1) η.

    Parameters
    ----------
    c, series, at : contact.Constants, the workspace with the step's series, and the step's first row
    expansions : float64, shape (2, 3, SIZE), for each perturbation the rows ETA, ZETA, and RATE, ζ - (d_c/m) η
    free : whether the contact force is left out
    """
    w = row_of(series, at + W)
    stiffness, stiff = expand_stiffness(c, series, at, SPARE)
    slope = c.damping
    if free:
        stiffness = slope = 0.0
    w_0, stiff_0 = w[0], stiff[0]
    eta_1, eta_2 = expansions[0, ETA, 0], expansions[1, ETA, 0]
    zeta_1, zeta_2 = expansions[0, ZETA, 0], expansions[1, ZETA, 0]
    for n in range(ORDER):
        rate_1, rate_2 = zeta_1 - slope * eta_1, zeta_2 - slope * eta_2
        expansions[0, RATE, n], expansions[1, RATE, n] = rate_1, rate_2
        # The newest coefficients are still in registers, and the processor computes both perturbations at a time.
        drift_1, drift_2 = w_0 * rate_1, w_0 * rate_2
        pull_1, pull_2 = stiff_0 * eta_1, stiff_0 * eta_2
        for k in range(1, n + 1):
            drift_1 += w[k] * expansions[0, RATE, n - k]
            drift_2 += w[k] * expansions[1, RATE, n - k]
            pull_1 += stiff[k] * expansions[0, ETA, n - k]
            pull_2 += stiff[k] * expansions[1, ETA, n - k]
        eta_1, eta_2 = drift_1 / (n + 1), drift_2 / (n + 1)
        zeta_1, zeta_2 = -stiffness * pull_1 / (n + 1), -stiffness * pull_2 / (n + 1)
        expansions[0, ETA, n + 1], expansions[1, ETA, n + 1] = eta_1, eta_2
        expansions[0, ZETA, n + 1], expansions[1, ZETA, n + 1] = zeta_1, zeta_2


@compiled_inline
def expand_force(c, series, at, row, scale):
    """Fill a row with the series of w scale F_c/m along a step."""
    for n in range(ORDER):
        damper = c.damping * (n + 1) * series[place(at + SQUARE, n + 1)]
        force = c.stiffness * series[place(at + SPRING, n)] + damper
        series[place(row, n)] = scale * force
    series[row + ORDER] = 0.0


@compiled_inline
def expand_sign(c, series, at, row, sign):
    """Fill a row with a series that has the sign of the contact force along a step, times `sign`.

    Returns whether the force can change its sign. The series may have a simple zero at w = 0, as that of w F_c/m has.
    Next to a multiple zero, its sign would depend on rounding errors.
    """
    if c.damping > 0.0:
        expand_force(c, series, at, row, sign)
    return c.damping > 0.0


def unit_of_damping(mass, omega, gravity):
    """The damping d_c with which the group D is 1 (see analysis.dimensionless_groups), from numbers or arrays."""
    by_mass, by_omega, by_gravity = POWERS_IN_DAMPING
    return mass**by_mass * omega**by_omega * gravity**by_gravity


def loss_power(exponent):
    """The power n with which a contact takes about the share D K^n of the speed in an impact at the speed g/ω."""
    return -1.0 / (exponent + 1.0)
