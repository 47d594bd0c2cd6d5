"""Fixed-step integration of the model: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

The event-driven solver is compared with these methods. They step over impacts and separations. Friction has the sign of
ẋ_s - ẋ_p, with sign(0) = 0, so that they chatter where the part should stick. In contact (q ≤ 0) the force may be
negative, as in Eqs. 7 and 11, unless the model's `tension` excludes it. The published scheme has no stick. Therefore,
where static_friction exceeds friction, a part whose slip has vanished or changed its sign since the last step gets the
plate's velocity while |ẍ_s + g sin α| ≤ μ_s F_c/m.

Each evaluation of the forces takes the plate's sine and cosine directly, as the equations are written. Time is the step
number times the step and does not drift. The figures need explicit Euler for thousands of trajectories. The module
euler_lanes therefore steps it in vector registers, five times faster than scalar code. This module steps the other two
methods, which serve for comparison only.
"""

import math
from typing import NamedTuple

import numpy as np

from ..arguments import LONGEST, check_array, check_choice, check_time
from ..parameters import FIXED_STEP_METHODS as METHODS
from ..parameters import LAST
from ..solver import contact, friction, model
from ..solver.horizontal import IMPACT, SAMPLES, SEPARATED, name_events
from ..solver.jit import compiled, compiled_inline, compiled_into_callers, copy, no_refcount
from ..solver.trajectory import NOT_FINITE, OK, STATUS
from . import euler_lanes as lanes
from .force_law import contact_acceleration, friction_acceleration

EULER, SEMI_IMPLICIT_EULER, RK4 = range(len(METHODS))
# Evaluations of the forces in a step of each method.
EVALUATIONS = (1, 1, 4)
# The factor of a step h on a decay exp(λt), as coefficients of the powers of hλ; None for a step without such a factor.
GROWTH = {"euler": (1.0, 1.0), "semi_implicit_euler": None, "rk4": (1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0)}
LAST_CODE = len(METHODS) - 1
LIKELY_EVENTS = 1000  # of a run; a run with more events is repeated, with room for all of them
WHOLE = 1e-9  # relative distance from a whole number of steps that counts as rounding of duration and step


@compiled_inline
def slip_of(c, vx, sine, cosine):
    """The slip velocity ẋ_s - ẋ_p (m/s) at the phase with the given sine and cosine."""
    return c.a_x / c.omega * friction.along(c, sine, cosine)[0] - vx


@compiled_inline
def accelerations(c, vx, z, vz, sine, cosine):
    """F_r/m, F_c/m (m/s²) and the gap (m) of a state at the phase with the given sine and cosine."""
    gap = z + c.a_z / c.omega**2 * cosine
    normal = contact_acceleration(gap, vz - c.a_z / c.omega * sine, c.stiffness, c.damping, c.exponent, c.tension)
    return friction_acceleration(normal, slip_of(c, vx, sine, cosine), c.friction, c.tension), normal, gap


@compiled_inline
def stick(c, vx, rub, push, gap, sine, cosine, last_slip):
    """ẋ, F_r/m and the slip velocity where static friction exceeds friction: a part whose slip vanishes may stick."""
    slip = slip_of(c, vx, sine, cosine)
    pull = friction.pull(c, sine, cosine)
    if gap <= 0.0 and last_slip * slip <= 0.0 and abs(pull) <= c.static_friction * push:
        return vx + slip, pull, 0.0
    return vx, rub, slip


@compiled_inline
def semi_implicit_euler_step(c, state, rub, push, step):
    """(x, vx, z, vz) one step later: velocities first, then positions with the new velocities."""
    x, vx, z, vz = state
    vx += step * (rub - c.downhill)
    vz += step * (push - c.gravity)
    return x + step * vx, vx, z + step * vz, vz


@compiled_inline
def rk4_step(c, state, rub1, push1, step, half_way, end):
    """(x, vx, z, vz) one classical Runge-Kutta step later, from the state, its F_r/m and F_c/m.

    half_way, end : sine and cosine of the plate's phase in the middle of the step and at its end
    """
    x, vx1, z, vz1 = state
    half = 0.5 * step
    sine, cosine = half_way
    vx2 = vx1 + half * (rub1 - c.downhill)
    vz2 = vz1 + half * (push1 - c.gravity)
    rub2, push2, _ = accelerations(c, vx2, z + half * vz1, vz2, sine, cosine)
    vx3 = vx1 + half * (rub2 - c.downhill)
    vz3 = vz1 + half * (push2 - c.gravity)
    rub3, push3, _ = accelerations(c, vx3, z + half * vz2, vz3, sine, cosine)
    vx4 = vx1 + step * (rub3 - c.downhill)
    vz4 = vz1 + step * (push3 - c.gravity)
    sine, cosine = end
    rub4, push4, _ = accelerations(c, vx4, z + step * vz3, vz4, sine, cosine)
    return (
        x + step / 6.0 * (vx1 + 2.0 * (vx2 + vx3) + vx4),
        vx1 + step / 6.0 * (rub1 + 2.0 * (rub2 + rub3) + rub4) - step * c.downhill,
        z + step / 6.0 * (vz1 + 2.0 * (vz2 + vz3) + vz4),
        vz1 + step * ((push1 + 2.0 * (push2 + push3) + push4) / 6.0 - c.gravity),
    )


@compiled_into_callers
def begin_run(c, k, z0, vz0, in_contact, last_slip, results):
    """Set the state of trajectory number k to its initial condition (m, m/s)."""
    plate = -c.a_z / c.omega**2 * math.cos(c.psi0)
    results[k, lanes.Z], results[k, lanes.VZ] = plate if math.isnan(z0) else z0, vz0
    results[k, lanes.MAX_GAP] = results[k, lanes.Z] - plate
    in_contact[k] = results[k, lanes.MAX_GAP] <= 0.0
    last_slip[k] = slip_of(c, 0.0, math.sin(c.psi0), math.cos(c.psi0))


@compiled_into_callers
def count_step(c, k, time, sine, vz, gap, push, in_contact, events, results):
    """Count a step of trajectory number k that begins at a time (s): its gap, its force, an impact or a separation."""
    results[k, lanes.MAX_GAP] = max(results[k, lanes.MAX_GAP], gap)
    results[k, lanes.PEAK_FORCE] = max(results[k, lanes.PEAK_FORCE], push)
    results[k, lanes.CONTACT_TIME] += push != 0.0
    touching = gap <= 0.0
    if touching == in_contact[k]:
        return
    in_contact[k] = touching
    n_events = int(results[k, lanes.EVENTS])
    if n_events < events.shape[1]:
        events[k, n_events, 0] = time
        events[k, n_events, 1] = IMPACT if touching else SEPARATED
    results[k, lanes.EVENTS] += 1
    results[k, lanes.IMPACTS] += touching
    if touching:
        results[k, lanes.IMPACT_SPEED] = max(results[k, lanes.IMPACT_SPEED], c.a_z / c.omega * sine - vz)


@compiled
def integrate(parameters, step, n_steps, method, sample_indices, samples, events, results):
    """Follow n trajectories over plates that share their phase, step by step; the rest as in `integrate_all`.

    parameters : float64, shape (n, 16), of one frequency and ψ0, so that all need the same sines and cosines
    method : the code of one of METHODS, not EULER
    """
    if not EULER < method <= LAST_CODE:
        raise ValueError("method must be the code of SEMI_IMPLICIT_EULER or RK4")
    n, n_sampled = len(parameters), 0
    constants = [contact.constants(parameters[0], 0.0)] * n
    running, contacts, last_slip = np.ones(n, np.bool_), np.empty(n, np.bool_), np.empty(n)
    results[:] = 0.0
    in_contact, events, results = no_refcount(contacts), no_refcount(events), no_refcount(results)
    for k in range(n):
        c = constants[k] = contact.constants(parameters[k], 0.0)
        begin_run(c, k, parameters[k, model.Z0], parameters[k, model.VZ0], in_contact, last_slip, results)
    omega, psi0 = constants[0].omega, constants[0].psi0
    turn = omega * step
    half_way = end = (0.0, 0.0)
    for i in range(n_steps + 1):
        phase = omega * (i * step) + psi0
        sine, cosine = math.sin(phase), math.cos(phase)
        if method == RK4:
            half_way = math.sin(phase + 0.5 * turn), math.cos(phase + 0.5 * turn)
            end = math.sin(phase + turn), math.cos(phase + turn)
        first = n_sampled
        while n_sampled < len(sample_indices) and sample_indices[n_sampled] == i:
            n_sampled += 1
        for k in range(n):
            x, vx, z, vz = results[k, lanes.X], results[k, lanes.VX], results[k, lanes.Z], results[k, lanes.VZ]
            if i % lanes.CHECK == 0:
                running[k] = math.isfinite(x + vx + z + vz)
            if not running[k]:
                continue
            c = constants[k]
            rub, push, gap = accelerations(c, vx, z, vz, sine, cosine)
            if c.static_friction > c.friction:
                vx, rub, last_slip[k] = stick(c, vx, rub, push, gap, sine, cosine, last_slip[k])
            for number in range(first, n_sampled):
                copy(samples[k, number], (x, vx, z, vz, c.mass * push, c.mass * rub + 0.0))  # no negative zero
                results[k, lanes.IMPACT_SPEED] = results[k, lanes.PEAK_FORCE] = 0.0
            if i < n_steps:
                count_step(c, k, i * step, sine, vz, gap, push, in_contact, events, results)
                if method == SEMI_IMPLICIT_EULER:
                    x, vx, z, vz = semi_implicit_euler_step(c, (x, vx, z, vz), rub, push, step)
                else:
                    x, vx, z, vz = rk4_step(c, (x, vx, z, vz), rub, push, step, half_way, end)
                results[k, lanes.EVALUATIONS] += EVALUATIONS[method]
            results[k, lanes.X], results[k, lanes.VX], results[k, lanes.Z], results[k, lanes.VZ] = x, vx, z, vz
    for k in range(n):
        finite = math.isfinite(results[k, lanes.X] + results[k, lanes.VX] + results[k, lanes.Z] + results[k, lanes.VZ])
        results[k, lanes.STATUS] = OK if finite else NOT_FINITE
        results[k, lanes.CONTACT_TIME] *= step
        results[k, lanes.PEAK_FORCE] *= constants[k].mass


def integrate_all(parameters, step, n_steps, method, sample_indices, samples, events, results):
    """Integrate n trajectories with one of METHODS, given as its number; the rest as in `euler_lanes.integrate`."""
    if method == EULER:
        lanes.integrate(parameters, step, n_steps, sample_indices, samples, events, results)
        return
    phase = parameters[:, [model.FREQUENCY, model.PSI0]]
    ends = [*np.flatnonzero((phase[1:] != phase[:-1]).any(axis=1)) + 1, len(parameters)]
    for begin, end in zip([0, *ends], ends, strict=False):
        rows = slice(begin, end)
        integrate(parameters[rows], step, n_steps, method, sample_indices, samples[rows], events[rows], results[rows])


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
    results = np.empty((n, lanes.RESULTS))
    integrate_all(parameters, float(step), n_steps, METHODS.index(method), indices, samples, events, results)
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
        found.append(Summary(x, vx, z, vz, mean_velocity, *counts, STATUS[int(status)]))
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
    n_events = int(results[lanes.EVENTS])
    if n_events > LIKELY_EVENTS:
        _, _, (rows,) = follow(parameters[np.newaxis], step, n_steps, method, n_events=n_events)
    return name_events(rows[:n_events, 0], rows[:n_events, 1].astype(np.int64))
