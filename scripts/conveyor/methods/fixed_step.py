"""Fixed-step integration of the model: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

These are the methods that the event-driven solver is compared with. They step over impacts and separations, and
friction is sign(ẋ_s - ẋ_p) with sign(0) = 0, so that they chatter where the part should stick. In contact (q ≤ 0) the
force may be negative, as in Eqs. 7 and 11, unless the model's `tension` says otherwise.

Each evaluation of the forces takes the plate's sine and cosine directly, as the equations are written. Time is the step
number times the step and does not drift. Explicit Euler is stepped in euler_lanes, the other two here.
"""

import math
from typing import NamedTuple

import numpy as np

from ..solver import model
from ..solver.jit import kernel
from . import euler_lanes
from .euler_lanes import CHECK, EVENT_KINDS, IMPACT, NOT_FINITE, OK, SEPARATION, STATUSES
from .force_law import contact_acceleration, friction_acceleration

METHODS = ("euler", "semi_implicit_euler", "rk4")
EULER, SEMI_IMPLICIT_EULER, RK4 = range(len(METHODS))
# Evaluations of the forces in a step of each.
EVALUATIONS = (1, 1, 4)
# What a step h multiplies a decay exp(λt) by, as coefficients of the powers of hλ; None where a step does not.
GROWTH = {"euler": (1.0, 1.0), "semi_implicit_euler": None, "rk4": (1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0)}
LAST_CODE = len(METHODS) - 1
SAMPLE_COLUMNS = ("x", "vx", "z", "vz", "contact_force", "friction_force")
EVENT_DTYPE = np.dtype([("time", np.float64), ("kind", "U10")])
WHOLE = 1e-9  # relative: a duration this close to a whole number of steps is one, up to the rounding of both


@kernel
def accelerations(vx, z, vz, sine, cosine, plate, contact, friction, tension):
    """F_r/m, F_c/m and the gap of a state at the phase with the given sine and cosine.

    `plate` holds the amplitudes of z_s, ż_s, ẋ_s; `contact` holds k_c/m, d_c/m and the exponent.
    """
    gap = z + plate[0] * cosine
    normal = contact_acceleration(gap, vz - plate[1] * sine, contact[0], contact[1], contact[2], tension)
    return friction_acceleration(normal, plate[2] * sine - vx, friction, tension), normal, gap


@kernel
def rk4_step(state, rub1, push1, step, phase, turn, plate, contact, friction, gravity, tension):
    """(x, vx, z, vz) one classical Runge-Kutta step later, from the state, its F_r/m and F_c/m, and its phase (rad).

    `turn` is the change of the phase within the step.
    """
    x, vx1, z, vz1 = state
    half = 0.5 * step
    sine, cosine = math.sin(phase + 0.5 * turn), math.cos(phase + 0.5 * turn)
    vx2 = vx1 + half * rub1
    vz2 = vz1 + half * (push1 - gravity)
    rub2, push2, _ = accelerations(vx2, z + half * vz1, vz2, sine, cosine, plate, contact, friction, tension)
    vx3 = vx1 + half * rub2
    vz3 = vz1 + half * (push2 - gravity)
    rub3, push3, _ = accelerations(vx3, z + half * vz2, vz3, sine, cosine, plate, contact, friction, tension)
    vx4 = vx1 + step * rub3
    vz4 = vz1 + step * (push3 - gravity)
    sine, cosine = math.sin(phase + turn), math.cos(phase + turn)
    rub4, push4, _ = accelerations(vx4, z + step * vz3, vz4, sine, cosine, plate, contact, friction, tension)
    return (
        x + step / 6.0 * (vx1 + 2.0 * (vx2 + vx3) + vx4),
        vx1 + step / 6.0 * (rub1 + 2.0 * (rub2 + rub3) + rub4),
        z + step / 6.0 * (vz1 + 2.0 * (vz2 + vz3) + vz4),
        vz1 + step * ((push1 + 2.0 * (push2 + push3) + push4) / 6.0 - gravity),
    )


@kernel
def integrate(parameters, step, n_steps, method, sample_indices, samples, events):
    """Integrate one trajectory from t = 0 over `n_steps` steps; explicit Euler: see `integrate_all`.

    Parameters
    ----------
    parameters : float64, shape (13,), packed as in `model.PARAMETERS`
    step : Δt, s
    n_steps : number of steps
    method : the code of one of METHODS, not EULER
    sample_indices : int64, shape (n,), ascending step numbers in [0, n_steps] to be sampled
    samples : float64, shape (n, 6), filled in the order of SAMPLE_COLUMNS (m, m/s, m, m/s, N, N); rows after a state
        that is not finite keep what they held
    events : float64, shape (k, 2), filled with time (s) and kind of the first k events; an event has the time of the
        first step at which the other side of q = 0 is seen

    Returns
    -------
    tuple
        x (m), vx (m/s), z (m), vz (m/s) at the last step; number of events; impacts; time with contact force (s);
        largest gap (m) at the steps; number of force evaluations; status
    """
    if not EULER < method <= LAST_CODE:
        raise ValueError("method is the code of no other of METHODS than EULER")
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    psi0 = parameters[model.PSI0]
    a_z = parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE])
    a_x = parameters[model.ACCELERATION] * math.cos(parameters[model.ANGLE])
    plate = (a_z / omega**2, a_z / omega, a_x / omega)
    mass = parameters[model.MASS]
    contact = (parameters[model.STIFFNESS] / mass, parameters[model.DAMPING] / mass, parameters[model.EXPONENT])
    friction = parameters[model.FRICTION]
    gravity = parameters[model.GRAVITY]
    tension = parameters[model.TENSION]

    x = 0.0
    vx = 0.0
    z = -plate[0] * math.cos(psi0) if math.isnan(parameters[model.Z0]) else parameters[model.Z0]
    vz = parameters[model.VZ0]
    max_gap = z + plate[0] * math.cos(psi0)
    in_contact = max_gap <= 0.0
    contact_steps = 0
    n_impacts = 0
    n_events = 0
    n_sampled = 0

    i = 0
    while True:
        if i % CHECK == 0 and not math.isfinite(x + vx + z + vz):
            break
        phase = omega * (i * step) + psi0
        sine, cosine = math.sin(phase), math.cos(phase)
        rub, push, gap = accelerations(vx, z, vz, sine, cosine, plate, contact, friction, tension)
        while n_sampled < len(sample_indices) and sample_indices[n_sampled] == i:
            # Adding zero removes the sign of a negative zero.
            samples[n_sampled] = (x, vx, z, vz, mass * push, mass * rub + 0.0)
            n_sampled += 1
        if i == n_steps:
            break
        max_gap = max(max_gap, gap)
        touching = gap <= 0.0
        contact_steps += push != 0.0
        if touching != in_contact:
            in_contact = touching
            n_impacts += touching
            if n_events < len(events):
                events[n_events, 0] = i * step
                events[n_events, 1] = IMPACT if touching else SEPARATION
            n_events += 1
        if method == SEMI_IMPLICIT_EULER:
            vx += step * rub
            x += step * vx
            vz += step * (push - gravity)
            z += step * vz
        elif method == RK4:
            x, vx, z, vz = rk4_step(
                (x, vx, z, vz), rub, push, step, phase, omega * step, plate, contact, friction, gravity, tension
            )
        else:
            raise ValueError("a method without a step")
        i += 1
    evaluations = i * EVALUATIONS[method]
    status = OK if math.isfinite(x + vx + z + vz) else NOT_FINITE
    return x, vx, z, vz, n_events, n_impacts, contact_steps * step, max_gap, evaluations, status


def integrate_all(parameters, step, n_steps, method, sample_indices, samples, events, results):
    """Integrate n trajectories with one of METHODS, given as its number; the rest as in `euler_lanes.integrate`."""
    if method == EULER:
        euler_lanes.integrate(parameters, step, n_steps, sample_indices, samples, events, results)
    else:
        for i in range(len(parameters)):
            results[i] = integrate(parameters[i], step, n_steps, method, sample_indices, samples[i], events[i])


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
    """Follow one trajectory: its results as a list, the samples (NaN where none was reached) and the events."""
    if method not in METHODS:
        raise ValueError(f"method = {method!r} is not one of {', '.join(METHODS)}")
    indices = np.asarray(indices, dtype=np.int64)
    samples = np.full((1, len(indices), len(SAMPLE_COLUMNS)), math.nan)
    events = np.empty((1, n_events, 2))
    results = np.empty((1, euler_lanes.RESULTS))
    integrate_all(
        parameters[np.newaxis], float(step), n_steps, METHODS.index(method), indices, samples, events, results
    )
    return results[0].tolist(), samples[0], events[0]


def run(parameters: np.ndarray, duration: float, step: float, method: str = "euler", last: float = 0.25) -> Summary:
    """Integrate one trajectory from t = 0.

    Parameters
    ----------
    parameters : float64, shape (13,), from `model.pack`
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
    result, samples, _ = _integrate(parameters, step, n_steps, method, [first])
    x, vx, z, vz, _, impacts, contact_time, max_gap, evaluations, status = result
    mean_velocity = (x - float(samples[0, 0])) / ((n_steps - first) * step)
    contact_fraction = contact_time / (n_steps * step)
    return Summary(
        x, vx, z, vz, mean_velocity, int(impacts), contact_fraction, max_gap, int(evaluations), STATUSES[int(status)]
    )


def sample(parameters: np.ndarray, times: np.ndarray, step: float, method: str = "euler") -> dict[str, np.ndarray]:
    """States and forces of one trajectory at the steps nearest to `times`.

    Parameters
    ----------
    parameters : float64, shape (13,), from `model.pack`
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
    _, samples, _ = _integrate(parameters, step, n_steps, method, indices[order])
    values = np.empty_like(samples)
    values[order] = samples
    return {name: values[:, k].reshape(times.shape) for k, name in enumerate(SAMPLE_COLUMNS)}


def events(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> np.ndarray:
    """Impacts and separations of one trajectory, as the fixed steps see them.

    Parameters and errors are those of `run`. The array of EVENT_DTYPE has the fields time (s) and kind ("impact",
    "separation"), in order of time.
    """
    n_steps = step_count(duration, step)
    results, _, _ = _integrate(parameters, step, n_steps, method)
    n_events = int(results[euler_lanes.EVENTS])
    _, _, rows = _integrate(parameters, step, n_steps, method, n_events=n_events)
    found = np.empty(n_events, dtype=EVENT_DTYPE)
    found["time"] = rows[:, 0]
    found["kind"] = np.array(EVENT_KINDS)[rows[:, 1].astype(np.int64)]
    return found
