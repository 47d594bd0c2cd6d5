"""Fixed-step integration of the model: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

The event-driven solver is compared with these methods. They step over impacts and separations. Friction has the sign of
ẋ_s - ẋ_p, with sign(0) = 0, so that they chatter where the part should stick. In contact (q ≤ 0) the force may be
negative, as in Eqs. 7 and 11, unless the model's `tension` excludes it. The published scheme has no stick. Therefore,
where static_friction exceeds friction, a part whose slip has vanished or changed its sign since the last step gets the
plate's velocity while |ẍ_s + g sin α| ≤ μ_s F_c/m.

Time is the step number times the step and does not drift. Trajectories are followed side by side, in plain loops over
lanes that LLVM turns into vector code; a single trajectory is the same code with one lane. Sweeps over
amplitudes would take 5.5 to 7.5 times as long with one lane, sweeps over ψ0 1.6 to 3.4 times. A result depends neither
on its lane nor on its neighbours. For the exponents 1 and 1.5 explicit Euler calls no library function, so that every
machine gives the same digits.
"""

import functools
import math
from collections import namedtuple
from typing import NamedTuple

import numpy as np

from ..arguments import LONGEST, check_array, check_choice, check_time
from ..packing import as_rows
from ..parameters import FIXED_STEP_METHODS as METHODS
from ..parameters import LAST, PARAMETERS
from ..solver import model, plate
from ..solver.contact_lanes import LANES, new_memory, place
from ..solver.contact_law import coefficients_per_mass
from ..solver.jit import compiled, compiled_inline, compiled_into_callers
from ..solver.record import IMPACT, SAMPLES, SEPARATED, name_events
from ..solver.status import NOT_FINITE, OK
from ..solver.status import STATUS as STATUS_NAMES
from .force_law import contact_acceleration, friction_acceleration, least_push, least_rub, power_of_depth, simple_power
from .sine import sine_and_cosine

FIRST_WAVE = len(PARAMETERS)  # place of the first harmonic in packed parameters
EULER, SEMI_IMPLICIT_EULER, RK4 = range(len(METHODS))
# Evaluations of the forces in a step of each method.
EVALUATIONS = (1, 1, 4)
# The factor of a step h on a decay exp(λt), as coefficients of the powers of hλ; None for a step without such a factor.
GROWTH = {"euler": (1.0, 1.0), "semi_implicit_euler": None, "rk4": (1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0)}
LIKELY_EVENTS = 1000  # of a run; a run with more events is repeated, with room for all of them
WHOLE = 1e-9  # relative distance from a whole number of steps that counts as rounding of duration and step
CHECK = 256  # steps between checks that the state is finite

# The columns of a trajectory's results, and the first rows of the memory, which has a column for each lane. In the
# memory CONTACT_TIME is a number of steps, and PEAK_FORCE is per mass. IMPACT_SPEED and PEAK_FORCE count since the last
# sample.
X, VX, Z, VZ, EVENTS, IMPACTS, CONTACT_TIME, MAX_GAP, FORCE_EVALUATIONS, STATUS, IMPACT_SPEED, PEAK_FORCE = range(12)
RESULTS = 12
# At the present step: gap (m), forces per mass (m/s²), whether the gap was last seen closed (1 or 0), the slip velocity
# (m/s) at the last step; only for exponents other than 1 and 1.5, δ^p (m^p) and the plate's Shapes.
GAP, PUSH, RUB, IN_CONTACT, LAST_SLIP, POWER, SHAPES = range(12, 19)
# Constants: ω (rad/s), ψ0 (rad), the amplitudes of z_s, ż_s, ẋ_s, ẍ_s; k_c/m, d_c/m, p, μ, μ_s, gravity normal to the
# track and down along it (m/s²); force_law.least_push and least_rub; cosine and sine of the phase shift.
OMEGA, PSI0, PLATE_Z, PLATE_VZ, PLATE_VX, PLATE_AX = range(22, 28)
STIFFNESS, DAMPING, EXPONENT, FRICTION, STATIC_FRICTION, GRAVITY, DOWNHILL = range(28, 35)
LEAST_PUSH, LEAST_RUB, COS_SHIFT, SIN_SHIFT = range(35, 39)
# The numbers of the plate's harmonics, as many as in the packed parameters.
WAVES = 39

# z_s, ż_s, ẋ_s and ẍ_s at a moment, divided by the amplitudes of the fundamental (z_s by the negative one).
Shapes = namedtuple("Shapes", "z vz vx ax")


NO_WAVES = 2  # length of Kind.waves without harmonics: the orders 0 and 1


class Kind(NamedTuple):
    """What the steps are compiled for, because steps that need less take less time."""

    method: int  # the code of one of METHODS
    single: bool  # whether there is one trajectory only
    alike: bool  # whether all plates have the same Shapes
    tilted: bool  # whether there are inclinations or phase shifts
    sticks: bool  # whether there are static frictions larger than the friction
    has_powers: bool  # whether there are exponents other than 1 and 1.5
    waves: tuple[int, ...]  # for each order from 0 to the highest, the first row of its harmonic in the memory, or 0


@compiled_inline
def sine_and_cosine_by(method, phase):
    """Sine and cosine of a phase (rad): by the C library, except for explicit Euler, which needs them faster."""
    return sine_and_cosine(phase) if method == EULER else (math.sin(phase), math.cos(phase))


@compiled_inline
def harmonic_at(memory, lane, order, first):
    """The numbers of a harmonic, in the order of plate.K, from their first row."""
    return (
        float(order),
        memory[place(first + 1, lane)],
        memory[place(first + 2, lane)],
        memory[place(first + 3, lane)],
        memory[place(first + 4, lane)],
    )


@compiled_inline
def shapes_at(kind, memory, lane, phase):
    """The Shapes of a plate at a phase (rad)."""
    sine, cosine = sine_and_cosine_by(kind.method, phase)
    along, pull = sine, cosine
    if kind.tilted:
        ahead, straight = memory[place(SIN_SHIFT, lane)], memory[place(COS_SHIFT, lane)]
        along, pull = sine * straight + cosine * ahead, cosine * straight - sine * ahead
    if len(kind.waves) == NO_WAVES:
        return Shapes(cosine, sine, along, pull)
    added, s, c = plate.NO_SUMS, sine, cosine
    # A single loop whose bounds are known: LLVM writes it out. Else the loops over the lanes would not become vector
    # code, and steps with two harmonics would take eight times as long as without.
    for order in range(2, len(kind.waves)):
        s, c = s * cosine + c * sine, c * cosine - s * sine
        if kind.waves[order] > 0:
            added = plate.add_harmonic(added, harmonic_at(memory, lane, order, kind.waves[order]), s, c)
    return Shapes(cosine + added.z, sine + added.vz, along + added.vx, pull + added.ax)


@compiled_inline
def turn_plate(kind, memory, lane, i, step):
    """The plate's Shapes in step number i, of a length (s): at its end, where the next forces act.

    For RK4 also in its middle and, as reckoned from its beginning, at its end; else these are the first again.
    """
    omega, psi0 = memory[place(OMEGA, lane)], memory[place(PSI0, lane)]
    end = shapes_at(kind, memory, lane, omega * ((i + 1) * step) + psi0)
    if kind.method != RK4:
        return end, end, end
    phase, turn = omega * (i * step) + psi0, omega * step
    middle = shapes_at(kind, memory, lane, phase + 0.5 * turn)
    return end, middle, shapes_at(kind, memory, lane, phase + turn)


@compiled_inline
def turn_plates(kind, memory, i, step, shapes):
    """Write the Shapes for CHECK steps of explicit Euler from number i on, for alike plates.

    In this loop, LLVM computes the sines of several steps at once. That halves the time of a single trajectory.
    """
    for n in range(CHECK):
        at = np.uint64(n)
        end, _, _ = turn_plate(kind, memory, np.uint64(0), i + n, step)
        for k in range(4):
            shapes[at + np.uint64(k * CHECK)] = end[k]


@compiled_inline
def written_shapes(shapes, at, stride):
    """The Shapes at a place of an array, whose four numbers have a distance of `stride`."""
    return Shapes(shapes[at], shapes[at + stride], shapes[at + stride + stride], shapes[at + stride + stride + stride])


@compiled_inline
def write_shapes(memory, lane, shapes):
    """Write Shapes into the memory."""
    for k in range(4):
        memory[place(SHAPES + k, lane)] = shapes[k]


@compiled_inline
def shapes_in_memory(memory, lane):
    """The Shapes in the memory."""
    return written_shapes(memory, place(SHAPES, lane), np.uint64(LANES))


@compiled_inline
def forces(kind, memory, lane, vx, z, vz, shapes, is_raised):
    """Gap (m), F_c/m, F_r/m (m/s², Eqs. 7, 11 and 12) and slip velocity (m/s) of a state.

    is_raised : whether POWER holds δ^p
    """
    gap = z + memory[place(PLATE_Z, lane)] * shapes.z
    exponent = memory[place(EXPONENT, lane)]
    if is_raised:
        power = memory[place(POWER, lane)]
    else:
        power = power_of_depth(-gap, exponent) if kind.has_powers else simple_power(-gap, exponent)
    push = contact_acceleration(
        gap,
        memory[place(PLATE_VZ, lane)] * shapes.vz - vz,
        power,
        memory[place(STIFFNESS, lane)],
        memory[place(DAMPING, lane)],
        memory[place(LEAST_PUSH, lane)],
    )
    slip = memory[place(PLATE_VX, lane)] * shapes.vx - vx
    rub = friction_acceleration(push, slip, memory[place(FRICTION, lane)], memory[place(LEAST_RUB, lane)])
    return gap, push, rub, slip


@compiled_into_callers
def stick(memory, lane, gap, push, rub, slip, shapes):
    """F_r/m of a part that sticks if its slip has vanished, or `rub`; a part that sticks gets the plate's velocity."""
    vx = memory[place(VX, lane)]
    pull = memory[place(PLATE_AX, lane)] * shapes.ax + memory[place(DOWNHILL, lane)]
    static_friction = memory[place(STATIC_FRICTION, lane)]
    vanished = (static_friction > memory[place(FRICTION, lane)]) & (memory[place(LAST_SLIP, lane)] * slip <= 0.0)
    sticks = (gap <= 0.0) & vanished & (abs(pull) <= static_friction * push)
    memory[place(VX, lane)] = vx + slip if sticks else vx
    memory[place(LAST_SLIP, lane)] = 0.0 if sticks else slip
    return pull if sticks else rub


@compiled_inline
def find_forces(kind, memory, lane, shapes):
    """Write GAP, PUSH and RUB of the present state. Returns whether the gap has opened or closed."""
    vx, z, vz = memory[place(VX, lane)], memory[place(Z, lane)], memory[place(VZ, lane)]
    gap, push, rub, slip = forces(kind, memory, lane, vx, z, vz, shapes, kind.has_powers)
    if kind.sticks:
        rub = stick(memory, lane, gap, push, rub, slip, shapes)
    memory[place(GAP, lane)], memory[place(PUSH, lane)], memory[place(RUB, lane)] = gap, push, rub
    return (gap <= 0.0) != (memory[place(IN_CONTACT, lane)] > 0.0)


@compiled_inline
def find_forces_of_all(kind, lanes, memory):
    """`find_forces` of all lanes, with the plate's Shapes in memory. Returns whether a gap has opened or closed."""
    if kind.has_powers:
        # In a loop of its own, because powers take one number at a time.
        for k in range(lanes):
            lane = np.uint64(k)
            gap = memory[place(Z, lane)] + memory[place(PLATE_Z, lane)] * memory[place(SHAPES, lane)]
            memory[place(POWER, lane)] = power_of_depth(-gap, memory[place(EXPONENT, lane)])
    changed = False
    for k in range(lanes):
        lane = np.uint64(k)
        changed |= find_forces(kind, memory, lane, shapes_in_memory(memory, lane))
    return changed


@compiled_into_callers
def count_step(memory, lane):
    """Update the totals over the run before a step is taken."""
    gap, push = memory[place(GAP, lane)], memory[place(PUSH, lane)]
    highest, strongest = memory[place(MAX_GAP, lane)], memory[place(PEAK_FORCE, lane)]
    # Without the zeros LLVM stores only where a number changes, and the next load waits for it.
    memory[place(MAX_GAP, lane)] = (gap if gap > highest else highest) + 0.0
    memory[place(PEAK_FORCE, lane)] = (push if push > strongest else strongest) + 0.0
    memory[place(CONTACT_TIME, lane)] += 0.0 if push == 0.0 else 1.0


@compiled_into_callers
def rk4_step(kind, memory, lane, state, gravity, downhill, shapes, step):
    """(x, vx, z, vz) one classical Runge-Kutta step (s) later; the rest as in `take_step`."""
    x, vx1, z, vz1 = state
    push1, rub1 = memory[place(PUSH, lane)], memory[place(RUB, lane)]
    half = 0.5 * step
    _, middle, end = shapes
    vx2, vz2 = vx1 + half * (rub1 - downhill), vz1 + half * (push1 - gravity)
    _, push2, rub2, _ = forces(kind, memory, lane, vx2, z + half * vz1, vz2, middle, False)
    vx3, vz3 = vx1 + half * (rub2 - downhill), vz1 + half * (push2 - gravity)
    _, push3, rub3, _ = forces(kind, memory, lane, vx3, z + half * vz2, vz3, middle, False)
    vx4, vz4 = vx1 + step * (rub3 - downhill), vz1 + step * (push3 - gravity)
    _, push4, rub4, _ = forces(kind, memory, lane, vx4, z + step * vz3, vz4, end, False)
    return (
        x + step / 6.0 * (vx1 + 2.0 * (vx2 + vx3) + vx4),
        vx1 + step / 6.0 * (rub1 + 2.0 * (rub2 + rub3) + rub4) - step * downhill,
        z + step / 6.0 * (vz1 + 2.0 * (vz2 + vz3) + vz4),
        vz1 + step * ((push1 + 2.0 * (push2 + push3) + push4) / 6.0 - gravity),
    )


@compiled_into_callers
def take_step(kind, memory, lane, shapes, step):
    """Advance a state by one step (s), with the forces in memory; `shapes` are those of `turn_plate`."""
    x, vx, z, vz = memory[place(X, lane)], memory[place(VX, lane)], memory[place(Z, lane)], memory[place(VZ, lane)]
    gravity, downhill = memory[place(GRAVITY, lane)], memory[place(DOWNHILL, lane)] if kind.tilted else 0.0
    if kind.method == RK4:
        x, vx, z, vz = rk4_step(kind, memory, lane, (x, vx, z, vz), gravity, downhill, shapes, step)
    else:
        next_vx = vx + step * (memory[place(RUB, lane)] - downhill)
        next_vz = vz + step * (memory[place(PUSH, lane)] - gravity)
        if kind.method == EULER:
            x, z = x + step * vx, z + step * vz
        else:
            x, z = x + step * next_vx, z + step * next_vz
        vx, vz = next_vx, next_vz
    memory[place(X, lane)], memory[place(VX, lane)], memory[place(Z, lane)], memory[place(VZ, lane)] = x, vx, z, vz


@compiled_inline
def take_steps(kind, lanes, memory, i, stop, step, plates):
    """Take steps from number i on, to `stop` or until a gap opens or closes. Returns the number of the next step.

    plates : from `turn_plates`, for the CHECK steps that hold these ones
    """
    changed = False
    while not changed and i != stop:
        if kind.alike and kind.method == EULER:
            end = written_shapes(plates, np.uint64(i % CHECK), np.uint64(CHECK))
            shapes = end, end, end
        elif kind.alike:
            shapes = turn_plate(kind, memory, np.uint64(0), i, step)
        for k in range(lanes):
            lane = np.uint64(k)
            if not kind.alike:
                shapes = turn_plate(kind, memory, lane, i, step)
            count_step(memory, lane)
            take_step(kind, memory, lane, shapes, step)
            if kind.has_powers:
                write_shapes(memory, lane, shapes[0])
            else:
                # In the same loop, which halves the time.
                changed |= find_forces(kind, memory, lane, shapes[0])
        if kind.has_powers:
            changed = find_forces_of_all(kind, lanes, memory)
        i += 1
    return i


@compiled_inline
def prepare(kind, parameters, flat, memory, lane):
    """Set a lane of the memory, zero before, to the initial condition of a packed parameter vector."""
    method = kind.method
    sine_angle, cosine_angle = sine_and_cosine_by(method, parameters[model.ANGLE])
    sine_track, cosine_track = sine_and_cosine_by(method, parameters[model.INCLINATION])
    ahead, straight = sine_and_cosine_by(method, parameters[model.PHASE_SHIFT])
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    a_z, a_x = parameters[model.ACCELERATION] * sine_angle, parameters[model.ACCELERATION] * cosine_angle
    memory[OMEGA, lane], memory[PSI0, lane] = omega, parameters[model.PSI0]
    memory[PLATE_Z, lane], memory[PLATE_VZ, lane] = a_z / (omega * omega), a_z / omega
    memory[PLATE_VX, lane], memory[PLATE_AX, lane] = a_x / omega, a_x
    memory[STIFFNESS, lane], memory[DAMPING, lane] = coefficients_per_mass(parameters)
    memory[EXPONENT, lane] = parameters[model.EXPONENT]
    memory[FRICTION, lane] = parameters[model.FRICTION]
    memory[STATIC_FRICTION, lane] = parameters[model.STATIC_FRICTION]
    memory[GRAVITY, lane] = parameters[model.GRAVITY] * cosine_track
    memory[DOWNHILL, lane] = parameters[model.GRAVITY] * sine_track
    memory[SIN_SHIFT, lane], memory[COS_SHIFT, lane] = ahead, straight
    memory[LEAST_PUSH, lane] = least_push(parameters[model.TENSION])
    memory[LEAST_RUB, lane] = least_rub(parameters[model.TENSION])
    for k in range(len(parameters) - FIRST_WAVE):
        memory[WAVES + k, lane] = parameters[FIRST_WAVE + k]
    shapes = shapes_at(kind, flat, np.uint64(lane), parameters[model.PSI0])
    write_shapes(flat, np.uint64(lane), shapes)
    memory[LAST_SLIP, lane] = memory[PLATE_VX, lane] * shapes.vx
    surface = -memory[PLATE_Z, lane] * shapes.z
    memory[Z, lane] = surface if math.isnan(parameters[model.Z0]) else parameters[model.Z0]
    memory[VZ, lane] = parameters[model.VZ0]
    memory[MAX_GAP, lane] = memory[Z, lane] - surface
    memory[IN_CONTACT, lane] = memory[MAX_GAP, lane] <= 0.0


@compiled_inline
def record_samples(parameters, first, memory, running, samples, number):
    """Write the sample with a `number` of the trajectories that are `running`, and let the peaks count from here on.

    first : row of the trajectory in the first lane
    """
    for lane in range(len(running)):
        if running[lane]:
            mass, row = parameters[first + lane, model.MASS], samples[first + lane, number]
            for column in range(4):
                row[column] = memory[column, lane]
            row[4] = mass * memory[PUSH, lane]
            row[5] = mass * memory[RUB, lane] + 0.0  # no negative zero
        memory[IMPACT_SPEED, lane] = memory[PEAK_FORCE, lane] = 0.0


@compiled_inline
def record_results(parameters, first, memory, running, results, step, evaluations, is_end):
    """Write the results of trajectories that end here: all of them, or those whose state is not finite.

    Returns the number of trajectories that are still `running`, shape (lanes,), which is changed.
    """
    left = 0
    for lane in range(len(running)):
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
            row[FORCE_EVALUATIONS] = evaluations
            row[STATUS] = OK if finite else NOT_FINITE
        left += running[lane]
    return left


@compiled_inline
def record_events(kind, first, flat, memory, running, events, time):
    """Count the gaps that have opened or closed, and write the time (s) and kind of the first events."""
    for lane in range(len(running)):
        touching = memory[GAP, lane] <= 0.0
        if touching != memory[IN_CONTACT, lane]:
            n_events = int(memory[EVENTS, lane])
            if running[lane] and n_events < events.shape[1]:
                events[first + lane, n_events, 0] = time
                events[first + lane, n_events, 1] = IMPACT if touching else SEPARATED
            memory[EVENTS, lane] += 1.0
            memory[IMPACTS, lane] += touching
            if touching:
                shapes = shapes_at(kind, flat, np.uint64(lane), memory[OMEGA, lane] * time + memory[PSI0, lane])
                speed = memory[PLATE_VZ, lane] * shapes.vz - memory[VZ, lane]
                memory[IMPACT_SPEED, lane] = max(memory[IMPACT_SPEED, lane], speed)
            memory[IN_CONTACT, lane] = touching


@functools.cache
def compiled_for(kind):
    """The compiled part of `follow` for a Kind."""
    method = kind.method

    @compiled
    def integrate(parameters, step, n_steps, sample_indices, samples, events, results, work):
        flat, memory = work
        # LLVM makes faster code for a known number of lanes: sweeps take 0.79 to 0.99 of the time. Not so for
        # semi-implicit Euler (1.15 if plates are alike) and for powers (up to twice the time).
        is_known = method != SEMI_IMPLICIT_EULER and not kind.has_powers
        lanes = 1 if kind.single else LANES if is_known else memory.shape[1]
        running = np.empty(lanes, np.bool_)
        plates = np.empty(4 * CHECK)
        for first in range(0, len(parameters), lanes):
            # A lane without a trajectory hangs in the air, without gravity.
            for k in range(len(flat)):
                flat[k] = 0.0
            for lane in range(lanes):
                memory[Z, lane] = 1.0
                running[lane] = first + lane < len(parameters)
                if running[lane]:
                    prepare(kind, parameters[first + lane], flat, memory, lane)
            find_forces_of_all(kind, lanes, flat)
            i = n_sampled = 0
            while True:
                while n_sampled < len(sample_indices) and sample_indices[n_sampled] <= i:
                    record_samples(parameters, first, memory, running, samples, n_sampled)
                    n_sampled += 1
                if i % CHECK == 0 or i == n_steps:
                    evaluations = i * EVALUATIONS[method]
                    is_end = i == n_steps
                    if record_results(parameters, first, memory, running, results, step, evaluations, is_end) == 0:
                        break
                    if kind.alike and method == EULER:
                        turn_plates(kind, flat, i, step, plates)
                record_events(kind, first, flat, memory, running, events, i * step)
                stop = min(n_steps, i - i % CHECK + CHECK)
                if n_sampled < len(sample_indices):
                    stop = min(stop, sample_indices[n_sampled])
                i = take_steps(kind, lanes, flat, i, stop, step, plates)

    return integrate


def kind_of(method: int, parameters: np.ndarray) -> Kind:
    """The Kind of steps with the code of a method that trajectories need, for packed `parameters`, shape (n, 16)."""
    waves = parameters[:, FIRST_WAVE:]
    orders = waves[0, plate.K :: plate.NUMBERS].astype(np.int64)
    if (waves[:, plate.K :: plate.NUMBERS] != orders).any():
        raise ValueError("harmonics of conveyors that are followed together must have the same orders")
    rows = np.zeros(orders.max(initial=1) + 1, np.int64)
    rows[orders] = WAVES + plate.NUMBERS * np.arange(len(orders))
    plates = np.hstack([parameters[:, [model.FREQUENCY, model.PSI0, model.PHASE_SHIFT]], waves])
    return Kind(
        method,
        single=len(parameters) == 1,
        alike=bool((plates == plates[:1]).all()),
        tilted=bool((parameters[:, [model.INCLINATION, model.PHASE_SHIFT]] != 0.0).any()),
        sticks=bool((parameters[:, model.STATIC_FRICTION] > parameters[:, model.FRICTION]).any()),
        has_powers=bool((~np.isin(parameters[:, model.EXPONENT], (1.0, 1.5))).any()),
        waves=tuple(rows.tolist()),
    )


class Summary(NamedTuple):
    """The result of a run: its last state, and totals over the run."""

    x: float  # m
    vx: float  # m/s
    z: float  # m
    vz: float  # m/s
    mean_velocity: float  # m/s, over the last part of the run
    impacts: int
    contact_fraction: float  # share of the run with a contact force
    max_gap: float  # m
    impact_speed: float  # m/s, largest speed of approach over the last part of the run
    peak_force: float  # N, largest contact force over the last part of the run
    evaluations: int  # of the force
    status: str  # one of status.STATUS


def step_count(duration: float, step: float) -> int:
    """The number of steps (s) in `duration` (s).

    ValueError if either is not a time in (0, LONGEST], or if the duration is no whole number of steps.
    """
    duration, step = check_time("duration", duration), check_time("step", step)
    count = round(duration / step)
    if abs(duration / step - count) > WHOLE * max(count, 1) or count == 0:
        nearest = max(count, 1)
        raise ValueError(
            f"duration = {duration!r} s is no whole number of steps of {step!r} s; "
            f"take step = {duration / nearest!r} or duration = {nearest * step!r}"
        )
    return count


def follow(parameters, step, n_steps, method, indices=(), n_events=0):
    """Follow n trajectories, shape (n, 16), from t = 0 over `n_steps` steps (s) by one of METHODS.

    Parameters
    ----------
    indices : ascending step numbers in [0, n_steps] to be sampled, shape (k,)
    n_events : number m of events of each trajectory that are wanted

    Returns
    -------
    results : n lists of RESULTS numbers: x (m), vx (m/s), z (m), vz (m/s) at the last step; number of events; impacts;
        time with contact force (s); largest gap (m) at the steps; number of force evaluations; status; largest speed of
        approach at an impact (m/s) and largest contact force (N) since the last sample
    samples : float64, shape (n, k, 6), x, vx, z, vz (m, m/s), contact and friction force (N); NaN behind the check that
        finds a state not finite
    events : float64, shape (n, m, 2), time (s) and kind of the first m events, or NaN; an event has the time of the
        first step at which the other side of q = 0 is seen
    """
    check_choice("method", method, METHODS)
    parameters, indices = as_rows(parameters), np.asarray(indices, dtype=np.int64)
    n = len(parameters)
    samples, results = np.full((n, len(indices), len(SAMPLES)), math.nan), np.empty((n, RESULTS))
    events = np.full((n, n_events, 2), math.nan)
    integrate = compiled_for(kind_of(METHODS.index(method), parameters))
    memory = new_memory(WAVES + parameters.shape[1] - FIRST_WAVE)
    integrate(parameters, float(step), n_steps, indices, samples, events, results, memory)
    return results.tolist(), samples, events


def run(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> Summary:
    """Integrate one trajectory from t = 0, packed as by `model.pack`, shape (16,); the rest as in `run_all`."""
    return run_all(parameters[np.newaxis], duration, step, method)[0]


def run_all(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> list[Summary]:
    """Integrate trajectories from t = 0; together they take less time than one by one, with the same bits.

    ValueError for a duration or step outside (0, LONGEST], a duration that is no whole number of steps, or an unknown
    method.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows from `model.pack`
    duration : s, a whole number of steps
    step : Δt, s
    method : one of METHODS
    """
    n_steps = step_count(duration, step)
    first = min(round((1.0 - LAST) * n_steps), n_steps - 1)
    results, samples, _ = follow(parameters, step, n_steps, method, [first])
    found = []
    for result, (sample_of_last,) in zip(results, samples.tolist(), strict=True):
        x, vx, z, vz, _, impacts, contact_time, max_gap, evaluations, status, *peaks = result
        mean_velocity = (x - sample_of_last[0]) / ((n_steps - first) * step)
        contact_fraction = contact_time / (n_steps * step)
        peaks = peaks if status == OK else (math.nan, math.nan)
        counts = int(impacts), contact_fraction, max_gap, *peaks, int(evaluations)
        found.append(Summary(x, vx, z, vz, mean_velocity, *counts, STATUS_NAMES[int(status)]))
    return found


def sample(parameters: np.ndarray, times: np.ndarray, step: float, method: str = "euler") -> dict[str, np.ndarray]:
    """States and forces of one trajectory at the steps nearest to `times` (s, not negative, any shape and order).

    Returns x, z (m), vx, vz (m/s), contact_force, friction_force (N), float64, shape of `times`; NaN after a state that
    is not finite. The other parameters are as in `run`. ValueError for a negative time, a step that is not positive or
    an unknown method.
    """
    times, step = check_array("times", times, 0.0, LONGEST, "s", least=0), check_time("step", step)
    indices, place = np.unique(np.rint(times / step).astype(np.int64), return_inverse=True)
    _, (samples,), _ = follow(parameters[np.newaxis], step, int(indices.max(initial=1)), method, indices)
    return {name: samples[place, k].reshape(times.shape) for k, name in enumerate(SAMPLES)}


def events(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> np.ndarray:
    """Impacts and separations of one trajectory, as the fixed steps see them.

    Parameters and errors as in `run`. The array has the fields time (s) and kind ("impact", "separation"), in order of
    time.
    """
    n_steps = step_count(duration, step)
    (results,), _, (rows,) = follow(parameters[np.newaxis], step, n_steps, method, n_events=LIKELY_EVENTS)
    n_events = int(results[EVENTS])
    if n_events > LIKELY_EVENTS:
        _, _, (rows,) = follow(parameters[np.newaxis], step, n_steps, method, n_events=n_events)
    return name_events(rows[:n_events, 0], rows[:n_events, 1].astype(np.int64))
