"""Fixed-step integration of the model: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

The event-driven solver is compared with these methods. They step over impacts and separations. Friction has the sign of
ẋ_s - ẋ_p, with sign(0) = 0, so that they chatter where the part should stick. In contact (q ≤ 0) the force may be
negative, as in Eqs. 7 and 11, unless the model's `tension` excludes it. The published scheme has no stick. Therefore,
where static_friction exceeds friction, a part whose slip has vanished or changed its sign since the last step gets the
plate's velocity while |ẍ_s + g sin α| ≤ μ_s F_c/m.

Time is the step number times the step and does not drift. Trajectories are followed side by side, in plain loops over
lanes that LLVM turns into vector code. A result depends neither on its lane nor on its neighbours. For the exponents 1
and 1.5 explicit Euler calls no library function, so that every machine gives the same digits.
"""

import functools
import math
from typing import NamedTuple

import numpy as np

from ..arguments import LONGEST, check_array, check_choice, check_time
from ..parameters import FIXED_STEP_METHODS as METHODS
from ..parameters import LAST
from ..solver import model
from ..solver.contact_lanes import LANES, new_memory, place
from ..solver.horizontal import IMPACT, SAMPLES, SEPARATED, name_events
from ..solver.jit import compiled, compiled_inline
from ..solver.trajectory import NOT_FINITE, OK
from ..solver.trajectory import STATUS as STATUS_NAMES
from .force_law import contact_acceleration, friction_acceleration, least_push, least_rub, power_of_depth, simple_power
from .sine import sine_and_cosine

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
# (m/s) at the last step; δ^p (m^p) of exponents other than 1 and 1.5.
GAP, PUSH, RUB, IN_CONTACT, LAST_SLIP, POWER = range(12, 18)
# Constants: ω (rad/s), ψ0 (rad), the amplitudes of z_s, ż_s, ẋ_s, ẍ_s; k_c/m, d_c/m, p, μ, μ_s, gravity normal to the
# track and down along it (m/s²); force_law.least_push and least_rub; cosine and sine of the phase shift.
OMEGA, PSI0, PLATE_Z, PLATE_VZ, PLATE_VX, PLATE_AX = range(18, 24)
STIFFNESS, DAMPING, EXPONENT, FRICTION, STATIC_FRICTION, GRAVITY, DOWNHILL = range(24, 31)
LEAST_PUSH, LEAST_RUB, COS_SHIFT, SIN_SHIFT = range(31, 35)
# Sine and cosine of the plate's phase at the beginning of the step, in its middle and at its end.
SINE, COSINE, MIDDLE_SINE, MIDDLE_COSINE, END_SINE, END_COSINE = range(35, 41)
# ẋ, z, ż and the forces per mass of the second, third and fourth stage of RK4.
VX_2, _, VZ_2, PUSH_2, RUB_2 = range(41, 46)
VX_3, _, VZ_3, PUSH_3, RUB_3 = range(46, 51)
VX_4, _, VZ_4, PUSH_4, RUB_4 = range(51, 56)
ROWS = 56


@compiled_inline
def turn_plate(memory, lane, time):
    """Write sine and cosine of the plate's phase at a time (s)."""
    phase = memory[place(OMEGA, lane)] * time + memory[place(PSI0, lane)]
    memory[place(SINE, lane)], memory[place(COSINE, lane)] = sine_and_cosine(phase)


@compiled_inline
def turn_plates_by_library(lanes, memory, time, lead, sine_row):
    """Write sine and cosine of the plate's phase at a time (s), turned further by `lead` (s), to a row and the next.

    Only explicit Euler computes thousands of trajectories and needs a faster sine than that of the C library. A plate
    that moves like its neighbour shares the values.
    """
    for k in range(lanes):
        here, before = np.uint64(k), np.uint64(max(k - 1, 0))
        omega, psi0 = memory[place(OMEGA, here)], memory[place(PSI0, here)]
        if k > 0 and omega == memory[place(OMEGA, before)] and psi0 == memory[place(PSI0, before)]:
            memory[place(sine_row, here)] = memory[place(sine_row, before)]
            memory[place(sine_row + 1, here)] = memory[place(sine_row + 1, before)]
        else:
            phase = omega * time + psi0 + lead * omega
            memory[place(sine_row, here)], memory[place(sine_row + 1, here)] = math.sin(phase), math.cos(phase)


@compiled_inline
def raise_depths(lanes, memory, z_row, sine_row):
    """Write δ^p to POWER, in a loop of its own, because powers take one number at a time; rows as in `forces`."""
    for k in range(lanes):
        lane = np.uint64(k)
        gap = memory[place(z_row, lane)] + memory[place(PLATE_Z, lane)] * memory[place(sine_row + 1, lane)]
        memory[place(POWER, lane)] = power_of_depth(-gap, memory[place(EXPONENT, lane)])


@compiled_inline
def forces(memory, lane, general, has_powers, vx_row, z_row, vz_row, sine_row):
    """Gap (m), F_c/m, F_r/m (m/s², Eqs. 7, 11 and 12) and slip velocity (m/s) of a state in a lane.

    general : whether there are phase shifts or larger static frictions
    has_powers : whether there are exponents other than 1 and 1.5
    vx_row, z_row, vz_row : the rows of the state
    sine_row : the row of the sine of the plate's phase; the cosine is in the row behind it
    """
    sine, cosine = memory[place(sine_row, lane)], memory[place(sine_row + 1, lane)]
    gap = memory[place(z_row, lane)] + memory[place(PLATE_Z, lane)] * cosine
    push = contact_acceleration(
        gap,
        memory[place(PLATE_VZ, lane)] * sine - memory[place(vz_row, lane)],
        memory[place(POWER, lane)] if has_powers else simple_power(-gap, memory[place(EXPONENT, lane)]),
        memory[place(STIFFNESS, lane)],
        memory[place(DAMPING, lane)],
        memory[place(LEAST_PUSH, lane)],
    )
    along = sine
    if general:
        along = sine * memory[place(COS_SHIFT, lane)] + cosine * memory[place(SIN_SHIFT, lane)]
    slip = memory[place(PLATE_VX, lane)] * along - memory[place(vx_row, lane)]
    rub = friction_acceleration(push, slip, memory[place(FRICTION, lane)], memory[place(LEAST_RUB, lane)])
    return gap, push, rub, slip


@compiled_inline
def stick(memory, lane, gap, push, rub, slip):
    """F_r/m of a part that sticks if its slip has vanished, or `rub`; a part that sticks gets the plate's velocity."""
    sine, cosine, vx = memory[place(SINE, lane)], memory[place(COSINE, lane)], memory[place(VX, lane)]
    turned = cosine * memory[place(COS_SHIFT, lane)] - sine * memory[place(SIN_SHIFT, lane)]
    pull = memory[place(PLATE_AX, lane)] * turned + memory[place(DOWNHILL, lane)]
    static_friction = memory[place(STATIC_FRICTION, lane)]
    vanished = (static_friction > memory[place(FRICTION, lane)]) & (memory[place(LAST_SLIP, lane)] * slip <= 0.0)
    sticks = (gap <= 0.0) & vanished & (abs(pull) <= static_friction * push)
    memory[place(VX, lane)] = vx + slip if sticks else vx
    memory[place(LAST_SLIP, lane)] = 0.0 if sticks else slip
    return pull if sticks else rub


@compiled_inline
def find_forces(memory, lane, general, has_powers):
    """Write GAP, PUSH and RUB at the present step. Returns whether the gap has opened or closed."""
    gap, push, rub, slip = forces(memory, lane, general, has_powers, VX, Z, VZ, SINE)
    if general:
        rub = stick(memory, lane, gap, push, rub, slip)
    memory[place(GAP, lane)], memory[place(PUSH, lane)], memory[place(RUB, lane)] = gap, push, rub
    return (1.0 if gap <= 0.0 else 0.0) != memory[place(IN_CONTACT, lane)]


@compiled_inline
def evaluate(lanes, memory, method, general, has_powers, time):
    """Write GAP, PUSH and RUB of all lanes at a time (s). Returns the number of gaps that have opened or closed."""
    if method == EULER:
        for k in range(lanes):
            turn_plate(memory, np.uint64(k), time)
    else:
        turn_plates_by_library(lanes, memory, time, 0.0, SINE)
    if has_powers:
        raise_depths(lanes, memory, Z, SINE)
    changed = 0
    for k in range(lanes):
        changed += find_forces(memory, np.uint64(k), general, has_powers)
    return changed


@compiled_inline
def count_step(memory, lane):
    """Update the totals over the run before a step is taken."""
    gap, push = memory[place(GAP, lane)], memory[place(PUSH, lane)]
    highest, strongest = memory[place(MAX_GAP, lane)], memory[place(PEAK_FORCE, lane)]
    # Without the zeros LLVM stores only where a number changes, and the next load waits for it.
    memory[place(MAX_GAP, lane)] = max(highest + 0.0, gap)
    memory[place(PEAK_FORCE, lane)] = max(strongest + 0.0, push)
    memory[place(CONTACT_TIME, lane)] += 0.0 if push == 0.0 else 1.0


@compiled_inline
def euler_step(memory, lane, general, step):
    """One step (s) with the forces in memory."""
    count_step(memory, lane)
    vx, vz = memory[place(VX, lane)], memory[place(VZ, lane)]
    memory[place(X, lane)] += step * vx
    forward = memory[place(RUB, lane)] - (memory[place(DOWNHILL, lane)] if general else 0.0)
    memory[place(VX, lane)] = vx + step * forward
    memory[place(Z, lane)] += step * vz
    memory[place(VZ, lane)] = vz + step * (memory[place(PUSH, lane)] - memory[place(GRAVITY, lane)])


@compiled_inline
def semi_implicit_euler_step(memory, lane, step):
    """One step (s) with the forces in memory: velocities first, then positions with the new velocities."""
    count_step(memory, lane)
    vx = memory[place(VX, lane)] + step * (memory[place(RUB, lane)] - memory[place(DOWNHILL, lane)])
    vz = memory[place(VZ, lane)] + step * (memory[place(PUSH, lane)] - memory[place(GRAVITY, lane)])
    memory[place(X, lane)] += step * vx
    memory[place(VX, lane)] = vx
    memory[place(Z, lane)] += step * vz
    memory[place(VZ, lane)] = vz


@compiled_inline
def rk4_stage(lanes, memory, lapse, vz_row, push_row, stage_row):
    """Write ẋ, z and ż of a stage to the rows from `stage_row` on.

    They are the state after the time `lapse` (s) with the velocity and the forces of the stage before, whose ż is in
    `vz_row`, and whose forces are in `push_row` and the row behind it.
    """
    for k in range(lanes):
        lane = np.uint64(k)
        rub, push = memory[place(push_row + 1, lane)], memory[place(push_row, lane)]
        memory[place(stage_row, lane)] = memory[place(VX, lane)] + lapse * (rub - memory[place(DOWNHILL, lane)])
        memory[place(stage_row + 1, lane)] = memory[place(Z, lane)] + lapse * memory[place(vz_row, lane)]
        memory[place(stage_row + 2, lane)] = memory[place(VZ, lane)] + lapse * (push - memory[place(GRAVITY, lane)])


@compiled_inline
def find_forces_of_stage(lanes, memory, general, has_powers, vx_row, sine_row):
    """Write F_c/m and F_r/m of a stage of RK4 behind its state, which begins in `vx_row`."""
    if has_powers:
        raise_depths(lanes, memory, vx_row + 1, sine_row)
    for k in range(lanes):
        lane = np.uint64(k)
        _, push, rub, _ = forces(memory, lane, general, has_powers, vx_row, vx_row + 1, vx_row + 2, sine_row)
        memory[place(vx_row + 3, lane)], memory[place(vx_row + 4, lane)] = push, rub


@compiled_inline
def sum_of_stages(memory, lane, first, second, third, fourth):
    """Six times the weighted mean of a quantity, from its rows in the four stages."""
    middle = memory[place(second, lane)] + memory[place(third, lane)]
    return memory[place(first, lane)] + 2.0 * middle + memory[place(fourth, lane)]


@compiled_inline
def rk4_step(lanes, memory, general, has_powers, time, step):
    """One classical Runge-Kutta step (s) from a time (s), with the forces in memory."""
    half = 0.5 * step
    turn_plates_by_library(lanes, memory, time, half, MIDDLE_SINE)
    turn_plates_by_library(lanes, memory, time, step, END_SINE)
    rk4_stage(lanes, memory, half, VZ, PUSH, VX_2)
    find_forces_of_stage(lanes, memory, general, has_powers, VX_2, MIDDLE_SINE)
    rk4_stage(lanes, memory, half, VZ_2, PUSH_2, VX_3)
    find_forces_of_stage(lanes, memory, general, has_powers, VX_3, MIDDLE_SINE)
    rk4_stage(lanes, memory, step, VZ_3, PUSH_3, VX_4)
    find_forces_of_stage(lanes, memory, general, has_powers, VX_4, END_SINE)
    for k in range(lanes):
        lane = np.uint64(k)
        count_step(memory, lane)
        vx, vz = memory[place(VX, lane)], memory[place(VZ, lane)]
        rub, push = (
            sum_of_stages(memory, lane, RUB, RUB_2, RUB_3, RUB_4),
            sum_of_stages(memory, lane, PUSH, PUSH_2, PUSH_3, PUSH_4),
        )
        memory[place(X, lane)] += step / 6.0 * sum_of_stages(memory, lane, VX, VX_2, VX_3, VX_4)
        memory[place(VX, lane)] = vx + step / 6.0 * rub - step * memory[place(DOWNHILL, lane)]
        memory[place(Z, lane)] += step / 6.0 * sum_of_stages(memory, lane, VZ, VZ_2, VZ_3, VZ_4)
        memory[place(VZ, lane)] = vz + step * (push / 6.0 - memory[place(GRAVITY, lane)])


@compiled_inline
def advance(lanes, memory, method, general, has_powers, i, step):
    """Take step number i, of a length (s), and evaluate the forces behind it. Returns the same as `evaluate`."""
    if method == EULER and not has_powers:
        # One loop for all of it takes half the time.
        changed = 0
        for k in range(lanes):
            lane = np.uint64(k)
            turn_plate(memory, lane, (i + 1) * step)
            euler_step(memory, lane, general, step)
            changed += find_forces(memory, lane, general, False)
        return changed
    if method == RK4:
        rk4_step(lanes, memory, general, has_powers, i * step, step)
    else:
        for k in range(lanes):
            if method == EULER:
                euler_step(memory, np.uint64(k), general, step)
            else:
                semi_implicit_euler_step(memory, np.uint64(k), step)
    return evaluate(lanes, memory, method, general, has_powers, (i + 1) * step)


@compiled
def sine_and_cosine_by(own, phase):
    """Sine and cosine of a phase (rad), `own` as in `prepare`."""
    return sine_and_cosine(phase) if own else (math.sin(phase), math.cos(phase))


@compiled_inline
def prepare(parameters, own, memory, lane):
    """Set a lane of the memory, zero before, to the initial condition of a packed parameter vector.

    own : whether sine_and_cosine computes sines and cosines, or the C library
    """
    sine_angle, cosine_angle = sine_and_cosine_by(own, parameters[model.ANGLE])
    sine_track, cosine_track = sine_and_cosine_by(own, parameters[model.INCLINATION])
    ahead, straight = sine_and_cosine_by(own, parameters[model.PHASE_SHIFT])
    sine, cosine = sine_and_cosine_by(own, parameters[model.PSI0])
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    mass = parameters[model.MASS]
    a_z, a_x = parameters[model.ACCELERATION] * sine_angle, parameters[model.ACCELERATION] * cosine_angle
    memory[OMEGA, lane], memory[PSI0, lane] = omega, parameters[model.PSI0]
    memory[PLATE_Z, lane], memory[PLATE_VZ, lane] = a_z / (omega * omega), a_z / omega
    memory[PLATE_VX, lane], memory[PLATE_AX, lane] = a_x / omega, a_x
    memory[STIFFNESS, lane], memory[DAMPING, lane] = (
        parameters[model.STIFFNESS] / mass,
        parameters[model.DAMPING] / mass,
    )
    memory[EXPONENT, lane] = parameters[model.EXPONENT]
    memory[FRICTION, lane] = parameters[model.FRICTION]
    memory[STATIC_FRICTION, lane] = parameters[model.STATIC_FRICTION]
    memory[GRAVITY, lane] = parameters[model.GRAVITY] * cosine_track
    memory[DOWNHILL, lane] = parameters[model.GRAVITY] * sine_track
    memory[SIN_SHIFT, lane], memory[COS_SHIFT, lane] = ahead, straight
    memory[LEAST_PUSH, lane] = least_push(parameters[model.TENSION])
    memory[LEAST_RUB, lane] = least_rub(parameters[model.TENSION])
    memory[LAST_SLIP, lane] = memory[PLATE_VX, lane] * (sine * straight + cosine * ahead)
    plate = -memory[PLATE_Z, lane] * cosine
    memory[Z, lane] = plate if math.isnan(parameters[model.Z0]) else parameters[model.Z0]
    memory[VZ, lane] = parameters[model.VZ0]
    memory[MAX_GAP, lane] = memory[Z, lane] - plate
    memory[IN_CONTACT, lane] = memory[MAX_GAP, lane] <= 0.0


@compiled_inline
def record_samples(parameters, first, memory, running, samples, number):
    """Write the sample with a `number` of the trajectories that are `running`, and let the peaks count from here on.

    first : row of the trajectory in the first lane
    """
    for lane in range(LANES):
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

    Returns the number of trajectories that are still `running`, shape (LANES,), which is changed.
    """
    left = 0
    for lane in range(LANES):
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
def record_events(first, memory, running, events, time):
    """Count the gaps that have opened or closed, and write the time (s) and kind of the first events."""
    for lane in range(LANES):
        touching = memory[GAP, lane] <= 0.0
        if touching != memory[IN_CONTACT, lane]:
            n_events = int(memory[EVENTS, lane])
            if running[lane] and n_events < events.shape[1]:
                events[first + lane, n_events, 0] = time
                events[first + lane, n_events, 1] = IMPACT if touching else SEPARATED
            memory[EVENTS, lane] += 1.0
            memory[IMPACTS, lane] += touching
            if touching:
                speed = memory[PLATE_VZ, lane] * memory[SINE, lane] - memory[VZ, lane]
                memory[IMPACT_SPEED, lane] = max(memory[IMPACT_SPEED, lane], speed)
            memory[IN_CONTACT, lane] = touching


@functools.cache
def compiled_method(method, general):
    """The compiled part of `integrate` for the code of one of METHODS.

    general : see `is_general`; steps that need not be general take less time
    """
    own = method == EULER

    @compiled
    def integrate(parameters, step, n_steps, has_powers, sample_indices, samples, events, results, work):
        flat, memory = work
        lanes = memory.shape[1]
        running = np.empty(LANES, np.bool_)
        for first in range(0, len(parameters), LANES):
            # A lane without a trajectory hangs in the air, without gravity.
            for k in range(len(flat)):
                flat[k] = 0.0
            for lane in range(LANES):
                memory[Z, lane] = 1.0
                running[lane] = first + lane < len(parameters)
                if running[lane]:
                    prepare(parameters[first + lane], own, memory, lane)
            i = n_sampled = 0
            evaluate(lanes, flat, method, general, has_powers, 0.0)
            while True:
                while n_sampled < len(sample_indices) and sample_indices[n_sampled] <= i:
                    record_samples(parameters, first, memory, running, samples, n_sampled)
                    n_sampled += 1
                if i % CHECK == 0 or i == n_steps:
                    evaluations = i * EVALUATIONS[method]
                    is_end = i == n_steps
                    if record_results(parameters, first, memory, running, results, step, evaluations, is_end) == 0:
                        break
                record_events(first, memory, running, events, i * step)
                stop = min(n_steps, i - i % CHECK + CHECK)
                if n_sampled < len(sample_indices):
                    stop = min(stop, sample_indices[n_sampled])
                changed = 0
                while changed == 0 and i != stop:
                    changed = advance(lanes, flat, method, general, has_powers, i, step)
                    i += 1

    return integrate


def is_general(parameters: np.ndarray) -> bool:
    """Whether any conveyor has an inclination, a phase shift or a static friction larger than its friction."""
    tilted = (parameters[:, [model.INCLINATION, model.PHASE_SHIFT]] != 0.0).any()
    return bool(tilted or (parameters[:, model.STATIC_FRICTION] > parameters[:, model.FRICTION]).any())


def integrate(parameters, step, n_steps, method, sample_indices, samples, events, results):
    """Follow n trajectories from t = 0 over `n_steps` steps.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows packed as in `model.PARAMETERS`
    step : Δt, s
    n_steps : number of steps
    method : the code of one of METHODS
    sample_indices : int64, shape (k,), ascending step numbers in [0, n_steps] to be sampled
    samples : float64, shape (n, k, 6), filled with x, vx, z, vz (m, m/s), contact and friction force (N); rows behind
        the check that finds a state not finite are left unchanged
    events : float64, shape (n, m, 2), filled with time (s) and kind of the first m events of each trajectory; an event
        has the time of the first step at which the other side of q = 0 is seen
    results : float64, shape (n, RESULTS), filled with x (m), vx (m/s), z (m), vz (m/s) at the last step; number of
        events; impacts; time with contact force (s); largest gap (m) at the steps; number of force evaluations; status;
        largest speed of approach at an impact (m/s) and largest contact force (N) since the last sample
    """
    if method not in range(len(METHODS)):
        raise ValueError(f"method: there is no code {method!r}")
    has_powers = bool((~np.isin(parameters[:, model.EXPONENT], (1.0, 1.5))).any())
    follow = compiled_method(method, is_general(parameters))
    memory = new_memory(ROWS)
    follow(parameters, step, n_steps, has_powers, sample_indices, samples, events, results, memory)


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
    status: str  # one of trajectory.STATUS


def step_count(duration: float, step: float) -> int:
    """The number of steps (s) in `duration` (s).

    Raises
    ------
    ValueError
        if either is not a time in (0, LONGEST], or if the duration is no whole number of steps
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
    """Follow trajectories, shape (n, 16). Returns results as lists, samples (NaN where not reached) and events."""
    check_choice("method", method, METHODS)
    indices = np.asarray(indices, dtype=np.int64)
    n = len(parameters)
    samples = np.full((n, len(indices), len(SAMPLES)), math.nan)
    events = np.empty((n, n_events, 2))
    results = np.empty((n, RESULTS))
    integrate(parameters, float(step), n_steps, METHODS.index(method), indices, samples, events, results)
    return results.tolist(), samples, events


def run(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> Summary:
    """Integrate one trajectory from t = 0, packed as by `model.pack`, shape (16,); the rest as in `run_all`."""
    return run_all(parameters[np.newaxis], duration, step, method)[0]


def run_all(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> list[Summary]:
    """Integrate trajectories from t = 0; together they take less time than one by one, with the same bits.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows from `model.pack`
    duration : s, a whole number of steps
    step : Δt, s
    method : one of METHODS

    Raises
    ------
    ValueError
        for a duration or step that is not positive, or an unknown method
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
    """States and forces of one trajectory at the steps nearest to `times`.

    Parameters
    ----------
    parameters : float64, shape (16,), from `model.pack`
    times : s, not negative, any shape and order
    step : Δt, s
    method : one of METHODS

    Returns
    -------
    dict
        x, z (m), vx, vz (m/s), contact_force, friction_force (N), float64, shape of `times`; NaN after a state that is
        not finite

    Raises
    ------
    ValueError
        for a negative time, a step that is not positive or an unknown method
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
