"""Explicit Euler as the paper publishes it, one trajectory in each lane of the processor's vector registers.

A register of 512 bits holds eight numbers, and one instruction works on all of them: eight trajectories cost little
more than one if they take the same instructions. The code has no branches on the state: both outcomes are computed and
one is selected. It computes sine and cosine as well, because a library takes one phase at a time.

Every operation is rounded as IEEE 754 defines it. The compiler may neither fuse nor reorder operations; multiply-adds
are requested explicitly. A result depends neither on its neighbours nor on the lane nor on the number of lanes, and a
single run is the same code in one lane. For the exponents 1 and 1.5 no library function is called, so that every
machine gives the same digits; any other exponent takes the power of the C library, lane after lane.
"""

import functools
import math

import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

from ..solver import model
from ..solver.horizontal import IMPACT, SEPARATED
from ..solver.jit import compiled, compiled_into_callers
from ..solver.trajectory import NOT_FINITE, OK
from ..solver.vectors import BIT, FLOAT, INTEGER, Memory, Vector, anywhere, call, fma, lanes_of_processor, power, where
from .force_law import spring_and_damper

CHECK = 256  # steps between checks that the state is finite

# The columns of a trajectory's results, and the first rows of the memory, which has a column for each lane. In the
# memory CONTACT_TIME is a number of steps, EVALUATIONS the number of the present step, and PEAK_FORCE is per mass.
# IMPACT_SPEED and PEAK_FORCE count since the last sample.
X, VX, Z, VZ, EVENTS, IMPACTS, CONTACT_TIME, MAX_GAP, EVALUATIONS, STATUS, IMPACT_SPEED, PEAK_FORCE = range(12)
RESULTS = 12
# Forces per mass (m/s²) and gap (m) at the present step; 1 if the gap was last seen closed, else 0; the slip velocity
# (m/s) at the last step.
GAP, PUSH, RUB, IN_CONTACT, LAST_SLIP = range(12, 17)
# Constants: Δt (s); ω (rad/s), ψ0 (rad), the amplitudes of z_s, ż_s, ẋ_s, ẍ_s; k_c/m, d_c/m, p, μ, μ_s, gravity normal
# to the track and down along it (m/s²); the least contact force per mass that acts, and the least that rubs; cosine and
# sine of the phase shift.
STEP, OMEGA, PSI0, PLATE_Z, PLATE_VZ, PLATE_VX, PLATE_AX = range(17, 24)
STIFFNESS, DAMPING, EXPONENT, FRICTION, STATIC_FRICTION, GRAVITY, DOWNHILL = range(24, 31)
LEAST_PUSH, LEAST_RUB, COS_SHIFT, SIN_SHIFT = range(31, 35)
ROWS = 35

TWO_OVER_PI = 0.6366197723675814
HALF_PI = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591833e-33)  # their sum is π/2 to 161 bits
# Doubles of this size have no fractional bits: adding ROUNDER rounds to an integer, which is then in the low bits.
ROUNDER = 1.5 * 2.0**52
# Coefficients of r³, r⁵, ..., r¹³ and r⁴, r⁶, ..., r¹⁴ on |r| ≤ π/4, the last one first: k_sin.c and k_cos.c of fdlibm
# (Sun Microsystems 1993).
SINE = (
    1.58969099521155010221e-10,
    -2.50507602534068634195e-08,
    2.75573137070700676789e-06,
    -1.98412698298579493134e-04,
    8.33333333332248946124e-03,
    -1.66666666666666324348e-01,
)
COSINE = (
    -1.13596475577881948265e-11,
    2.08757232129817482790e-09,
    -2.75573143513906633035e-07,
    2.48015872894767294178e-05,
    -1.38888888888741095749e-03,
    4.16666666666666019037e-02,
)


def polynomial(coefficients: tuple[float, ...], x: Vector) -> Vector:
    value = x.like(coefficients[0])
    for coefficient in coefficients[1:]:
        value = fma(value, x, coefficient)
    return value


def sine_and_cosine(phase: Vector) -> tuple[Vector, Vector]:
    """Sine and cosine of phases in rad, at most 1.5 units in the last place off for |phase| ≤ 1e12 (measured).

    The whole number of quarter turns n is subtracted as in Cody and Waite's reduction, here without rounding in the
    first term: phase - n HALF_PI[0] is a multiple of 2⁻⁵² below 1. The last two bits of n select polynomial and sign.
    Beyond 2⁵¹ quarter turns, where neighbouring numbers are half a radian apart, the values mean nothing.
    """
    builder = phase.builder
    rounded = fma(phase, TWO_OVER_PI, ROUNDER)
    turns = rounded - ROUNDER
    r = phase
    for part in HALF_PI:
        r = fma(turns, -part, r)
    square = r * r
    sine = fma(r * square, polynomial(SINE, square), r)
    cosine = fma(square, fma(square, polynomial(COSINE, square), -0.5), 1.0)
    bits = rounded.cast(builder.bitcast, INTEGER)
    odd = bits.cast(builder.trunc, BIT)

    def signed(value, sign):
        flipped = value.cast(builder.bitcast, INTEGER) ^ (sign & -(2**63))
        return flipped.cast(builder.bitcast, FLOAT)

    # The sine is negative in the quarters 2 and 3, the cosine in the quarters 1 and 2.
    return signed(where(odd, cosine, sine), bits << 62), signed(where(odd, sine, cosine), (bits << 62) ^ (bits << 63))


def spring_length(depth: Vector, exponent: Vector, flying: Vector) -> Vector:
    """δ^p in m^p from δ (m); arbitrary values in lanes in flight. The slow power function is called only if needed."""
    hertz, hooke = exponent == 1.5, exponent == 1.0
    return power(depth, exponent, ~(flying | hertz | hooke), depth * where(hertz, call("sqrt", depth), 1.0))


@intrinsic(prefer_literal=True)
def forces(typing_context, lanes, general, memory):
    """Evaluate GAP, PUSH and RUB at the present step (Eqs. 7, 11 and 12); True if a gap has opened or closed.

    general : whether there are phase shifts or larger static frictions; a part whose slip has vanished may then stick
    """

    def code(context, builder, signature, arguments):
        at = Memory(context, builder, signature, arguments)
        sine, cosine = sine_and_cosine(at[OMEGA] * (at[EVALUATIONS] * at[STEP]) + at[PSI0])
        gap = at[Z] + at[PLATE_Z] * cosine
        flying = gap > 0.0
        length = spring_length(-gap, at[EXPONENT], flying)
        force = spring_and_damper(at[STIFFNESS], length, at[DAMPING], at[VZ] - at[PLATE_VZ] * sine)
        push = where(~flying, where(at[LEAST_PUSH] > force, at[LEAST_PUSH], force), 0.0)
        bound = at[FRICTION] * where(at[LEAST_RUB] > push, at[LEAST_RUB], push)
        along = sine * at[COS_SHIFT] + cosine * at[SIN_SHIFT] if general.literal_value else sine
        slip = at[PLATE_VX] * along - at[VX]
        rub = where(slip > 0.0, bound, where(slip < 0.0, -bound, 0.0))
        if general.literal_value:
            pull = at[PLATE_AX] * (cosine * at[COS_SHIFT] - sine * at[SIN_SHIFT]) + at[DOWNHILL]
            vanished = ~flying & (at[STATIC_FRICTION] > at[FRICTION]) & (at[LAST_SLIP] * slip <= 0.0)
            sticks = vanished & (abs(pull) <= at[STATIC_FRICTION] * push)
            at[VX] = where(sticks, at[VX] + slip, at[VX])
            at[LAST_SLIP] = where(~sticks, slip, 0.0)
            rub = where(sticks, pull, rub)
        at[GAP], at[PUSH], at[RUB] = gap, push, rub
        return anywhere((gap <= 0.0) ^ (at[IN_CONTACT] > 0.0))

    return types.boolean(lanes, general, memory), code


@intrinsic(prefer_literal=True)
def euler_step(typing_context, lanes, general, memory):
    """Advance by one step with the forces in memory, and update the totals."""

    def code(context, builder, signature, arguments):
        at = Memory(context, builder, signature, arguments)
        step, x, vx, z, vz = (at[row] for row in (STEP, X, VX, Z, VZ))
        at[MAX_GAP] = where(at[GAP] > at[MAX_GAP], at[GAP], at[MAX_GAP])
        at[PEAK_FORCE] = where(at[PUSH] > at[PEAK_FORCE], at[PUSH], at[PEAK_FORCE])
        at[CONTACT_TIME] = where(at[PUSH] == 0.0, at[CONTACT_TIME], at[CONTACT_TIME] + 1.0)
        at[X] = x + step * vx
        at[VX] = vx + step * (at[RUB] - at[DOWNHILL] if general.literal_value else at[RUB])
        at[Z] = z + step * vz
        at[VZ] = vz + step * (at[PUSH] - at[GRAVITY])
        at[EVALUATIONS] = at[EVALUATIONS] + 1.0
        return context.get_dummy_value()

    return types.none(lanes, general, memory), code


@intrinsic
def sincos(typing_context, phase):
    """The sine and the cosine of one phase (rad), as in the lanes."""

    def code(context, builder, signature, arguments):
        pair = sine_and_cosine(Vector(builder, builder.bitcast(arguments[0], ir.VectorType(FLOAT, 1))))
        return context.make_tuple(builder, signature.return_type, [builder.bitcast(v.value, FLOAT) for v in pair])

    return types.UniTuple(types.float64, 2)(types.float64), code


@compiled
def prepare(parameters, step, lane):
    """Set a lane's memory, shape (ROWS,), zero before, to the initial condition of a packed parameter vector."""
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    mass = parameters[model.MASS]
    tension = parameters[model.TENSION]
    sine_angle, cosine_angle = sincos(parameters[model.ANGLE])
    a_z = parameters[model.ACCELERATION] * sine_angle
    a_x = parameters[model.ACCELERATION] * cosine_angle
    lane[STEP] = step
    lane[OMEGA] = omega
    lane[PSI0] = parameters[model.PSI0]
    lane[PLATE_Z] = a_z / (omega * omega)
    lane[PLATE_VZ] = a_z / omega
    lane[PLATE_VX] = a_x / omega
    lane[PLATE_AX] = a_x
    lane[STIFFNESS] = parameters[model.STIFFNESS] / mass
    lane[DAMPING] = parameters[model.DAMPING] / mass
    lane[EXPONENT] = parameters[model.EXPONENT]
    lane[FRICTION] = parameters[model.FRICTION]
    lane[STATIC_FRICTION] = parameters[model.STATIC_FRICTION]
    sine_track, cosine_track = sincos(parameters[model.INCLINATION])
    lane[GRAVITY] = parameters[model.GRAVITY] * cosine_track
    lane[DOWNHILL] = parameters[model.GRAVITY] * sine_track
    lane[SIN_SHIFT], lane[COS_SHIFT] = sincos(parameters[model.PHASE_SHIFT])
    lane[LEAST_PUSH] = 0.0 if tension == model.TENSION_CLIP else -math.inf
    lane[LEAST_RUB] = 0.0 if tension == model.TENSION_FRICTIONLESS else -math.inf

    sine, cosine = sincos(parameters[model.PSI0])
    lane[LAST_SLIP] = lane[PLATE_VX] * (sine * lane[COS_SHIFT] + cosine * lane[SIN_SHIFT])
    plate = -lane[PLATE_Z] * cosine
    lane[Z] = plate if math.isnan(parameters[model.Z0]) else parameters[model.Z0]
    lane[VZ] = parameters[model.VZ0]
    lane[MAX_GAP] = lane[Z] - plate
    lane[IN_CONTACT] = lane[MAX_GAP] <= 0.0


@compiled_into_callers
def record_samples(parameters, first, memory, running, samples, number):
    """Write the sample with a `number` of the trajectories that are `running`, and let the peaks count from here on.

    first : row of the trajectory in the first lane
    """
    for lane in range(memory.shape[1]):
        if running[lane]:
            mass, row = parameters[first + lane, model.MASS], samples[first + lane, number]
            for column in range(4):
                row[column] = memory[column, lane]
            row[4] = mass * memory[PUSH, lane]
            row[5] = mass * memory[RUB, lane] + 0.0  # no negative zero
        memory[IMPACT_SPEED, lane] = memory[PEAK_FORCE, lane] = 0.0


@compiled_into_callers
def record_results(parameters, first, memory, running, results, step, is_end):
    """Write the results of trajectories that end here: all of them, or those whose state is not finite.

    Returns the number of trajectories that are still `running`, shape (lanes,), which is changed.
    """
    left = 0
    for lane in range(memory.shape[1]):
        total = 0.0
        for column in range(4):
            total += memory[column, lane]
        finite = math.isfinite(total)
        if running[lane] and (is_end or not finite):
            running[lane] = False
            row = results[first + lane]
            for column in range(RESULTS):
                row[column] = memory[column, lane]
            row[CONTACT_TIME] *= step
            row[PEAK_FORCE] *= parameters[first + lane, model.MASS]
            row[STATUS] = OK if finite else NOT_FINITE
        left += running[lane]
    return left


@compiled_into_callers
def record_events(first, memory, running, events, time):
    """Count the gaps that have opened or closed, and write the time (s) and kind of the first events."""
    for lane in range(memory.shape[1]):
        touching = memory[GAP, lane] <= 0.0
        if touching != memory[IN_CONTACT, lane]:
            n_events = int(memory[EVENTS, lane])
            if running[lane] and n_events < events.shape[1]:
                events[first + lane, n_events, 0] = time
                events[first + lane, n_events, 1] = IMPACT if touching else SEPARATED
            memory[EVENTS, lane] += 1.0
            memory[IMPACTS, lane] += touching
            if touching:
                sine, _ = sincos(memory[OMEGA, lane] * time + memory[PSI0, lane])
                speed = memory[PLATE_VZ, lane] * sine - memory[VZ, lane]
                memory[IMPACT_SPEED, lane] = max(memory[IMPACT_SPEED, lane], speed)
            memory[IN_CONTACT, lane] = touching


@functools.cache
def in_lanes(lanes: int, general: int = 1):
    """`integrate` with a given number of lanes, a power of two. Each number gives the same bits.

    general : 0 for the paper's friction on a level track only, which takes less time
    """

    @compiled
    def integrate(parameters, step, n_steps, sample_indices, samples, events, results):
        memory = np.empty((ROWS, lanes))
        running = np.empty(lanes, np.bool_)
        for first in range(0, len(parameters), lanes):
            # A lane without a trajectory hangs in the air, without gravity.
            memory[:] = 0.0
            memory[Z] = 1.0
            for lane in range(lanes):
                running[lane] = first + lane < len(parameters)
                if running[lane]:
                    prepare(parameters[first + lane], step, memory[:, lane])
            i = stop = n_sampled = 0
            while True:
                while not (forces(lanes, general, memory) or i == stop):
                    euler_step(lanes, general, memory)
                    i += 1
                while n_sampled < len(sample_indices) and sample_indices[n_sampled] <= i:
                    record_samples(parameters, first, memory, running, samples, n_sampled)
                    n_sampled += 1
                if i % CHECK == 0 or i == n_steps:
                    left = record_results(parameters, first, memory, running, results, step, i == n_steps)
                    if left == 0:
                        break
                record_events(first, memory, running, events, i * step)
                stop = min(n_steps, i - i % CHECK + CHECK)
                if n_sampled < len(sample_indices):
                    stop = min(stop, sample_indices[n_sampled])

    return integrate


def is_general(parameters: np.ndarray) -> bool:
    """Whether any conveyor has an inclination, a phase shift or a static friction larger than its friction."""
    tilted = (parameters[:, [model.INCLINATION, model.PHASE_SHIFT]] != 0.0).any()
    return bool(tilted or (parameters[:, model.STATIC_FRICTION] > parameters[:, model.FRICTION]).any())


def integrate(parameters, step, n_steps, sample_indices, samples, events, results):
    """Follow n trajectories from t = 0 over `n_steps` steps.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows packed as in `model.PARAMETERS`
    step : Δt, s
    n_steps : number of steps
    sample_indices : int64, shape (k,), ascending step numbers in [0, n_steps] to be sampled
    samples : float64, shape (n, k, 6), filled with x, vx, z, vz (m, m/s), contact and friction force (N); rows behind
        the check that finds a state not finite are left unchanged
    events : float64, shape (n, m, 2), filled with time (s) and kind of the first m events of each trajectory; an event
        has the time of the first step at which the other side of q = 0 is seen
    results : float64, shape (n, RESULTS), filled with x (m), vx (m/s), z (m), vz (m/s) at the last step; number of
        events; impacts; time with contact force (s); largest gap (m) at the steps; number of force evaluations; status;
        largest speed of approach at an impact (m/s) and largest contact force (N) since the last sample
    """
    follow = in_lanes(1 if len(parameters) == 1 else lanes_of_processor(), int(is_general(parameters)))
    follow(parameters, step, n_steps, sample_indices, samples, events, results)
