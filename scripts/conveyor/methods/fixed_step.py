"""Fixed-step integration of the model: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

These are the methods that the event-driven solver is compared with. They step over impacts and separations, and
friction is sign(ẋ_s - ẋ_p) with sign(0) = 0, so that they chatter where the part should stick. In contact (q ≤ 0) the
force may be negative, as in Eqs. 7 and 11, unless the model's `tension` says otherwise. Where static_friction exceeds
friction, a part whose slip has vanished or changed its sign since the last step gets the plate's velocity while
|ẍ_s + g sin α| ≤ μ_s F_c/m: the published scheme has no stick.

Each evaluation of the forces takes the plate's sine and cosine directly, as the equations are written. Time is the step
number times the step and does not drift. Explicit Euler is stepped in euler_lanes, the other two here.
"""

import math
from typing import NamedTuple

import numpy as np

from ..parameters import FIXED_STEP_METHODS as METHODS
from ..solver import model
from ..solver.jit import compiled
from . import euler_lanes
from .euler_lanes import (
    CHECK,
    CONTACT_TIME,
    EVENT_KINDS,
    EVENTS,
    IMPACT,
    IMPACT_SPEED,
    IMPACTS,
    MAX_GAP,
    NOT_FINITE,
    OK,
    PEAK_FORCE,
    SEPARATION,
    STATUS,
    STATUSES,
    VX,
    VZ,
    X,
    Z,
)
from .force_law import contact_acceleration, friction_acceleration

EULER, SEMI_IMPLICIT_EULER, RK4 = range(len(METHODS))
# Evaluations of the forces in a step of each.
EVALUATIONS = (1, 1, 4)
# What a step h multiplies a decay exp(λt) by, as coefficients of the powers of hλ; None where a step does not.
GROWTH = {"euler": (1.0, 1.0), "semi_implicit_euler": None, "rk4": (1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0)}
LAST_CODE = len(METHODS) - 1
SAMPLE_COLUMNS = ("x", "vx", "z", "vz", "contact_force", "friction_force")
EVENT_DTYPE = np.dtype([("time", np.float64), ("kind", "U10")])
WHOLE = 1e-9  # relative: a duration this close to a whole number of steps is one, up to the rounding of both


@compiled
def slip_of(vx, sine, cosine, plate):
    """The slip velocity ẋ_s - ẋ_p (m/s)."""
    return plate[2] * (sine * plate[3] + cosine * plate[4]) - vx


@compiled
def accelerations(vx, z, vz, sine, cosine, plate, contact, friction, tension):
    """F_r/m, F_c/m and the gap of a state at the phase with the given sine and cosine.

    `plate` holds the amplitudes of z_s, ż_s, ẋ_s, and cosine and sine of the phase shift; `contact` holds k_c/m, d_c/m
    and the exponent.
    """
    gap = z + plate[0] * cosine
    normal = contact_acceleration(gap, vz - plate[1] * sine, contact[0], contact[1], contact[2], tension)
    return friction_acceleration(normal, slip_of(vx, sine, cosine, plate), friction, tension), normal, gap


@compiled
def rk4_step(state, rub1, push1, step, half_way, end, plate, contact, friction, gravity, downhill, tension):
    """(x, vx, z, vz) one classical Runge-Kutta step later, from the state, its F_r/m and F_c/m.

    `half_way` and `end` hold the sine and cosine of the plate's phase in the middle of the step and at its end.
    """
    x, vx1, z, vz1 = state
    half = 0.5 * step
    sine, cosine = half_way
    vx2 = vx1 + half * (rub1 - downhill)
    vz2 = vz1 + half * (push1 - gravity)
    rub2, push2, _ = accelerations(vx2, z + half * vz1, vz2, sine, cosine, plate, contact, friction, tension)
    vx3 = vx1 + half * (rub2 - downhill)
    vz3 = vz1 + half * (push2 - gravity)
    rub3, push3, _ = accelerations(vx3, z + half * vz2, vz3, sine, cosine, plate, contact, friction, tension)
    vx4 = vx1 + step * (rub3 - downhill)
    vz4 = vz1 + step * (push3 - gravity)
    sine, cosine = end
    rub4, push4, _ = accelerations(vx4, z + step * vz3, vz4, sine, cosine, plate, contact, friction, tension)
    return (
        x + step / 6.0 * (vx1 + 2.0 * (vx2 + vx3) + vx4),
        vx1 + step / 6.0 * (rub1 + 2.0 * (rub2 + rub3) + rub4) - step * downhill,
        z + step / 6.0 * (vz1 + 2.0 * (vz2 + vz3) + vz4),
        vz1 + step * ((push1 + 2.0 * (push2 + push3) + push4) / 6.0 - gravity),
    )


@compiled
def fill_phases(phases, first, step, omega, psi0, method):
    """Sine and cosine of the plate's phase at steps from number `first` on, of RK4 also half-way and at their ends.

    phases : float64, shape (steps, 6)
    """
    turn = omega * step
    for k in range(len(phases)):
        phase = omega * ((first + k) * step) + psi0
        phases[k, 0], phases[k, 1] = math.sin(phase), math.cos(phase)
        if method == RK4:
            phases[k, 2], phases[k, 3] = math.sin(phase + 0.5 * turn), math.cos(phase + 0.5 * turn)
            phases[k, 4], phases[k, 5] = math.sin(phase + turn), math.cos(phase + turn)


@compiled
def integrate(parameters, step, n_steps, method, sample_indices, samples, events, results):
    """Follow n trajectories over plates that share their phase; the rest as in `integrate_all`.

    parameters : float64, shape (n, 16), of one frequency and ψ0
    method : the code of one of METHODS, not EULER
    """
    if not EULER < method <= LAST_CODE:
        raise ValueError("method is the code of no other of METHODS than EULER")
    omega = 2.0 * math.pi * parameters[0, model.FREQUENCY]
    psi0 = parameters[0, model.PSI0]
    phases = np.empty((CHECK, 6))
    running = np.ones(len(parameters), np.bool_)
    was_in_contact = np.empty(len(parameters), np.bool_)
    last_slips = np.empty(len(parameters))
    results[:] = 0.0
    n_before = 0  # samples
    for begin in range(0, n_steps + 1, CHECK):
        behind = min(begin + CHECK, n_steps + 1)
        fill_phases(phases[: behind - begin], begin, step, omega, psi0, method)
        for row in range(len(parameters)):
            if not running[row]:
                continue
            a_z = parameters[row, model.ACCELERATION] * math.sin(parameters[row, model.ANGLE])
            a_x = parameters[row, model.ACCELERATION] * math.cos(parameters[row, model.ANGLE])
            shift = parameters[row, model.PHASE_SHIFT]
            plate = (a_z / omega**2, a_z / omega, a_x / omega, math.cos(shift), math.sin(shift))
            mass = parameters[row, model.MASS]
            contact = (
                parameters[row, model.STIFFNESS] / mass,
                parameters[row, model.DAMPING] / mass,
                parameters[row, model.EXPONENT],
            )
            friction = parameters[row, model.FRICTION]
            static_friction = parameters[row, model.STATIC_FRICTION]
            gravity = parameters[row, model.GRAVITY] * math.cos(parameters[row, model.INCLINATION])
            downhill = parameters[row, model.GRAVITY] * math.sin(parameters[row, model.INCLINATION])
            tension = parameters[row, model.TENSION]

            found = results[row]
            if begin == 0:
                start = parameters[row, model.Z0]
                found[Z] = -plate[0] * math.cos(psi0) if math.isnan(start) else start
                found[VZ] = parameters[row, model.VZ0]
                found[MAX_GAP] = found[Z] + plate[0] * math.cos(psi0)
                was_in_contact[row] = found[MAX_GAP] <= 0.0
                last_slips[row] = slip_of(found[VX], math.sin(psi0), math.cos(psi0), plate)
            x, vx, z, vz, max_gap = found[X], found[VX], found[Z], found[VZ], found[MAX_GAP]
            in_contact = was_in_contact[row]
            last_slip = last_slips[row]
            impact_speed, peak_force = found[IMPACT_SPEED], found[PEAK_FORCE]
            contact_steps = 0
            n_impacts = 0
            n_events = int(found[EVENTS])
            n_sampled = n_before

            i = begin
            finite = math.isfinite(x + vx + z + vz)
            while finite and i < behind:
                k = i - begin
                sine, cosine = phases[k, 0], phases[k, 1]
                rub, push, gap = accelerations(vx, z, vz, sine, cosine, plate, contact, friction, tension)
                if static_friction > friction:
                    slip = slip_of(vx, sine, cosine, plate)
                    pull = a_x * (cosine * plate[3] - sine * plate[4]) + downhill
                    if gap <= 0.0 and last_slip * slip <= 0.0 and abs(pull) <= static_friction * push:
                        vx, slip, rub = vx + slip, 0.0, pull
                    last_slip = slip
                while n_sampled < len(sample_indices) and sample_indices[n_sampled] == i:
                    # Adding zero removes the sign of a negative zero.
                    samples[row, n_sampled] = (x, vx, z, vz, mass * push, mass * rub + 0.0)
                    n_sampled += 1
                    impact_speed = peak_force = 0.0
                if i == n_steps:
                    break
                max_gap, peak_force = max(max_gap, gap), max(peak_force, push)
                touching = gap <= 0.0
                contact_steps += push != 0.0
                if touching != in_contact:
                    in_contact = touching
                    n_impacts += touching
                    if touching:
                        impact_speed = max(impact_speed, plate[1] * sine - vz)
                    if n_events < events.shape[1]:
                        events[row, n_events, 0] = i * step
                        events[row, n_events, 1] = IMPACT if touching else SEPARATION
                    n_events += 1
                if method == SEMI_IMPLICIT_EULER:
                    vx += step * (rub - downhill)
                    x += step * vx
                    vz += step * (push - gravity)
                    z += step * vz
                elif method == RK4:
                    state = x, vx, z, vz
                    half_way, end = (phases[k, 2], phases[k, 3]), (phases[k, 4], phases[k, 5])
                    x, vx, z, vz = rk4_step(
                        state, rub, push, step, half_way, end, plate, contact, friction, gravity, downhill, tension
                    )
                else:
                    raise ValueError("a method without a step")
                i += 1

            found[X], found[VX], found[Z], found[VZ], found[MAX_GAP] = x, vx, z, vz, max_gap
            found[IMPACT_SPEED], found[PEAK_FORCE] = impact_speed, peak_force
            last_slips[row] = last_slip
            found[EVENTS] = n_events
            found[IMPACTS] += n_impacts
            found[CONTACT_TIME] += contact_steps
            was_in_contact[row] = in_contact
            if i == n_steps or not finite:
                running[row] = False
                found[CONTACT_TIME] *= step
                found[PEAK_FORCE] *= mass
                found[euler_lanes.EVALUATIONS] = i * EVALUATIONS[method]
                found[STATUS] = OK if math.isfinite(x + vx + z + vz) else NOT_FINITE
        while n_before < len(sample_indices) and sample_indices[n_before] < behind:
            n_before += 1


def integrate_all(parameters, step, n_steps, method, sample_indices, samples, events, results):
    """Integrate n trajectories with one of METHODS, given as its number; the rest as in `euler_lanes.integrate`."""
    if method == EULER:
        euler_lanes.integrate(parameters, step, n_steps, sample_indices, samples, events, results)
        return
    phase = parameters[:, [model.FREQUENCY, model.PSI0]]
    ends = [*np.flatnonzero((phase[1:] != phase[:-1]).any(axis=1)) + 1, len(parameters)]
    for begin, end in zip([0, *ends], ends, strict=False):
        rows = slice(begin, end)
        integrate(parameters[rows], step, n_steps, method, sample_indices, samples[rows], events[rows], results[rows])


class Summary(NamedTuple):
    """What one run comes to: the last state and totals over the run."""

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
    status: str  # one of STATUSES


def check_positive(name: str, value: float) -> None:
    """ValueError that names a time (s) which is not positive and finite."""
    if not 0.0 < value < math.inf:
        raise ValueError(f"{name} = {value!r} s is not positive and finite")


def step_count(duration: float, step: float) -> int:
    """The number of steps (s) in `duration` (s).

    Raises
    ------
    ValueError
        if either is not positive and finite, or if the duration is no whole number of steps: a run would end elsewhere
    """
    check_positive("duration", duration)
    check_positive("step", step)
    count = round(duration / step)
    if abs(duration / step - count) > WHOLE * max(count, 1) or count == 0:
        nearest = max(count, 1)
        raise ValueError(
            f"duration = {duration!r} s is no whole number of steps of {step!r} s; "
            f"take step = {duration / nearest!r} or duration = {nearest * step!r}"
        )
    return count


def _integrate(parameters, step, n_steps, method, indices=(), n_events=0):
    """Follow trajectories, shape (n, 16): their results as lists, samples (NaN where none was reached) and events."""
    if method not in METHODS:
        raise ValueError(f"method = {method!r} is not one of {', '.join(METHODS)}")
    indices = np.asarray(indices, dtype=np.int64)
    n = len(parameters)
    samples = np.full((n, len(indices), len(SAMPLE_COLUMNS)), math.nan)
    events = np.empty((n, n_events, 2))
    results = np.empty((n, euler_lanes.RESULTS))
    integrate_all(parameters, float(step), n_steps, METHODS.index(method), indices, samples, events, results)
    return results.tolist(), samples, events


def run(parameters: np.ndarray, duration: float, step: float, method: str = "euler", last: float = 0.25) -> Summary:
    """Integrate one trajectory from t = 0, packed as by `model.pack`, shape (16,); the rest as in `run_all`."""
    return run_all(parameters[np.newaxis], duration, step, method, last)[0]


def run_all(
    parameters: np.ndarray, duration: float, step: float, method: str = "euler", last: float = 0.25
) -> list[Summary]:
    """Integrate trajectories from t = 0; side by side they take less time, and end in the same bits.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows from `model.pack`
    duration : s, a whole number of steps
    step : Δt, s
    method : one of METHODS
    last : share of the run, in (0, 1], over which the mean velocity (x(T) - x((1 - last) T)) / (last T) is taken

    Raises
    ------
    ValueError
        for a duration or step that is not positive, a share outside (0, 1] or an unknown method
    """
    if not 0.0 < last <= 1.0:
        raise ValueError(f"last = {last!r} is outside (0, 1]")
    n_steps = step_count(duration, step)
    first = min(round((1.0 - last) * n_steps), n_steps - 1)
    results, samples, _ = _integrate(parameters, step, n_steps, method, [first])
    found = []
    for result, (sample_of_last,) in zip(results, samples.tolist(), strict=True):
        x, vx, z, vz, _, impacts, contact_time, max_gap, evaluations, status, *peaks = result
        mean_velocity = (x - sample_of_last[0]) / ((n_steps - first) * step)
        contact_fraction = contact_time / (n_steps * step)
        peaks = peaks if status == OK else (math.nan, math.nan)
        counts = int(impacts), contact_fraction, max_gap, *peaks, int(evaluations)
        found.append(Summary(x, vx, z, vz, mean_velocity, *counts, STATUSES[int(status)]))
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
    times = np.asarray(times, dtype=np.float64)
    if not (np.isfinite(times) & (times >= 0.0)).all():
        raise ValueError("times must be finite and not negative")
    check_positive("step", step)
    indices = np.rint(times.ravel() / step).astype(np.int64)
    n_steps = int(indices.max(initial=1))
    order = np.argsort(indices, kind="stable")
    _, (samples,), _ = _integrate(parameters[np.newaxis], step, n_steps, method, indices[order])
    values = np.empty_like(samples)
    values[order] = samples
    return {name: values[:, k].reshape(times.shape) for k, name in enumerate(SAMPLE_COLUMNS)}


def events(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> np.ndarray:
    """Impacts and separations of one trajectory, as the fixed steps see them.

    Parameters and errors are those of `run`. The array of EVENT_DTYPE has the fields time (s) and kind ("impact",
    "separation"), in order of time.
    """
    n_steps = step_count(duration, step)
    (results,), _, _ = _integrate(parameters[np.newaxis], step, n_steps, method)
    n_events = int(results[EVENTS])
    _, _, (rows,) = _integrate(parameters[np.newaxis], step, n_steps, method, n_events=n_events)
    found = np.empty(n_events, dtype=EVENT_DTYPE)
    found["time"] = rows[:, 0]
    found["kind"] = np.array(EVENT_KINDS)[rows[:, 1].astype(np.int64)]
    return found
