"""A simpler model: a rigid part that bounces off the plate with a coefficient of restitution.

An impact takes no time. The part leaves with e times its speed of approach u, and friction changes its horizontal
velocity towards the plate's velocity, by at most μ (1 + e) u. When the bounces have shrunk to nothing, the part rests
on the plate with the normal force N/m = g cos α + a_z cos θ, and slips or sticks until the plate falls away faster
than g cos α. Between impacts everything has a closed form. The coefficient is a number, or a table over u, for example
the one of the compliant contact (`restitution.restitution_coefficients`).
"""

import math
from collections import namedtuple
from typing import NamedTuple

import numpy as np

from ..arguments import LONGEST, check_array, check_time
from ..packing import as_rows, refuse_harmonics
from ..parameters import LAST
from ..solver import contact, friction, model
from ..solver.flight import Flight, gap, highest_gap, next_impact
from ..solver.horizontal import slide
from ..solver.jit import compiled, compiled_into_callers, copy
from ..solver.status import IMPACT_LOST, OK, STATUS, TOO_MANY_EVENTS
from . import rigid_part_rest
from .restitution import restitution_at

SAMPLE_COLUMNS = ("x", "vx", "z", "vz")
# Time (s) and speed of approach (m/s) of an impact, and the duration (s) of the flight that it ends.
IMPACT_DTYPE = np.dtype([("time", np.float64), ("speed", np.float64), ("flight", np.float64)])

COLLAPSE = 1e-6  # rad; a bounce shorter than this is the last one
MAX_EVENTS = 100_000  # within one excitation cycle
IMPACTS_OF_CYCLE = 100  # on average, for which there is room at first; one jump ends in some dozens of bounces

# How a part moves.
FLYING, ARRIVING, RESTING = range(3)
# The motion at a time: x (m), ẋ (m/s); sign of the slip, 0 for stick. Of a part that flies or arrives: z (m) and ż
# (m/s); gap (m) and its rate (m/s); time (s) in which the plate, which has just left the part, cannot catch it.
Motion = namedtuple("Motion", "kind x vx sigma z vz q rate skip")


@compiled
def safe_flight(theta, omega):
    """Time (s) in which the plate cannot catch a part that it has left at `theta`.

    With q ≥ 0, q̇ ≥ 0 and q̈ ≥ 0 at θ the gap is at least a_z ω sin θ τ³/6 - a_z ω² τ⁴/24, positive for ωτ < 4 sin θ.
    Half of that time is skipped, because a search that begins at q = 0 begins with rounding errors.
    """
    return max(2.0 * math.sin(theta), 0.0) / omega


@compiled_into_callers
def first_motion(c, z0, vz0, theta):
    """The Motion at an initial condition (m, m/s, rad)."""
    z = rigid_part_rest.plate_height(c, theta)
    q = max(z0 - z, 0.0) if z0 == z0 else 0.0  # z0 is NaN for a part that starts on the plate
    rate = vz0 - rigid_part_rest.plate_rise(c, theta)
    kind = ARRIVING if q == 0.0 and rate <= 0.0 else FLYING
    return Motion(kind, 0.0, 0.0, 0.0, z + q, vz0, q, rate, 0.0)


@compiled_into_callers
def rest(x, vx, sigma):
    """The Motion of a part that begins to rest."""
    return Motion(RESTING, x, vx, sigma, 0.0, 0.0, 0.0, 0.0, 0.0)


@compiled_into_callers
def bounce(c, motion, theta, coefficient):
    """The Motion just after an impact."""
    speed = -motion.rate
    rate = coefficient * speed
    vx = motion.vx
    bound = c.friction * (1.0 + coefficient) * speed
    slip = rigid_part_rest.plate_speed(c, theta) - vx
    if abs(slip) <= bound:
        vx += slip
        slip = 0.0
    else:
        vx += math.copysign(bound, slip)
    pressure = c.gravity + c.a_z * math.cos(theta)
    sigma = rigid_part_rest.slip_direction(c, theta, slip)
    if pressure > 0.0 and 2.0 * c.omega * rate <= COLLAPSE * pressure:
        return rest(motion.x, vx, sigma)
    skip = 0.0 if pressure > 0.0 else safe_flight(theta, c.omega)
    z, vz = rigid_part_rest.plate_height(c, theta), rigid_part_rest.plate_rise(c, theta) + rate
    return Motion(FLYING, motion.x, vx, sigma, z, vz, 0.0, rate, skip)


@compiled_into_callers
def rest_duration(c, motion, theta, left):
    """How long (s) a part rests and slips one way or sticks, and whether the plate leaves it then.

    left : remaining time of the run (s)
    """
    leave = rigid_part_rest.rest_end(c, theta) / c.omega
    if motion.sigma == 0.0:
        change = rigid_part_rest.stick_end(c, theta) / c.omega
    else:
        slip = rigid_part_rest.plate_speed(c, theta) - motion.vx
        change = rigid_part_rest.slip_end(c, theta, slip, motion.sigma, c.omega * min(leave, left)) / c.omega
    return min(leave, change), leave <= change


@compiled_into_callers
def end_rest(c, motion, theta, tau, leaves):
    """The Motion after a rest of `tau` (s), which the plate ends if it `leaves` the part."""
    x, vx = rigid_part_rest.rest_motion(c, theta, motion.x, motion.vx, motion.sigma, tau)
    theta += c.omega * tau
    if leaves:
        z, vz = rigid_part_rest.plate_height(c, theta), rigid_part_rest.plate_rise(c, theta)
        return Motion(FLYING, x, vx, motion.sigma, z, vz, 0.0, 0.0, safe_flight(theta, c.omega))
    if motion.sigma == 0.0:
        return rest(x, vx, math.copysign(1.0, friction.pull(c, math.sin(theta), math.cos(theta))))
    return rest(x, rigid_part_rest.plate_speed(c, theta), rigid_part_rest.slip_direction(c, theta, 0.0))


@compiled_into_callers
def sample_motion(c, motion, theta, base, t, tau, times, samples, sampled):
    """Sample a part that rests or flies for `tau` (s), from `base` + `t` on. Returns the number of samples so far."""
    while sampled < len(times) and base + t + tau >= times[sampled]:
        ahead = times[sampled] - base - t
        if motion.kind == RESTING:
            phase = theta + c.omega * ahead
            x, vx = rigid_part_rest.rest_motion(c, theta, motion.x, motion.vx, motion.sigma, ahead)
            copy(
                samples[sampled], (x, vx, rigid_part_rest.plate_height(c, phase), rigid_part_rest.plate_rise(c, phase))
            )
        else:
            x, vx = slide(c, motion.x, motion.vx, ahead)
            z = motion.z + (motion.vz - 0.5 * c.gravity * ahead) * ahead
            copy(samples[sampled], (x, vx, z, motion.vz - c.gravity * ahead))
        sampled += 1
    return sampled


@compiled
def follow(parameters, speeds, coefficients, times, samples, impacts):
    """Follow one part until the last of `times`: number of impacts, largest gap (m), code of STATUS.

    Parameters
    ----------
    parameters : float64, shape (16,), as in `model.PARAMETERS`; an initial height below the plate is moved onto it
    speeds, coefficients : float64, shape (k,), ascending speeds of approach (m/s), their coefficients of restitution
    times : float64, shape (n,), s, ascending
    samples : float64, shape (n, 4), filled in the order of SAMPLE_COLUMNS (m, m/s)
    impacts : float64, shape (m, 3), filled for the first m impacts, with the numbers of IMPACT_DTYPE
    """
    c = contact.constants(parameters, 0.0)
    omega, gravity = c.omega, c.gravity
    period, psi0, end = 1.0 / parameters[model.FREQUENCY], parameters[model.PSI0], times[-1]
    motion = first_motion(c, parameters[model.Z0], parameters[model.VZ0], psi0)
    max_gap = motion.q
    # Whole cycles and a time in the cycle keep the phase precise in long runs.
    cycle, t, airborne = 0, 0.0, 0.0
    sampled = n_impacts = n_events = 0
    while sampled < len(times):
        while t >= period:
            t -= period
            cycle += 1
            n_events = 0
        base = cycle * period
        theta, left = psi0 + omega * t, end - base - t
        n_events += 1
        if n_events > MAX_EVENTS:
            samples[sampled:] = math.nan
            return n_impacts, max_gap, TOO_MANY_EVENTS
        if motion.kind == ARRIVING:
            if motion.rate < 0.0:
                if n_impacts < len(impacts):
                    copy(impacts[n_impacts], (base + t, -motion.rate, airborne))
                n_impacts += 1
            motion = bounce(c, motion, theta, restitution_at(-motion.rate, speeds, coefficients))
        elif motion.kind == RESTING:
            tau, leaves = rest_duration(c, motion, theta, left)
            sampled = sample_motion(c, motion, theta, base, t, tau, times, samples, sampled)
            motion = end_rest(c, motion, theta, tau, leaves)
            t += tau
        else:
            _, x, vx, sigma, z, vz, q, rate, skip = motion
            flight = Flight(z, vz, theta, c)
            if skip > 0.0:
                q, rate = gap(flight, skip)
                if q <= 0.0:
                    # The plate is back before it has really left.
                    x, vx = rigid_part_rest.rest_motion(c, theta, x, vx, sigma, skip)
                    motion = rest(x, vx, sigma)
                    t += skip
                    continue
            ahead = Flight(z + (vz - 0.5 * gravity * skip) * skip, vz - gravity * skip, theta + omega * skip, c)
            tau, speed = next_impact(ahead, q, rate, left - skip)
            tau += skip
            if not tau <= math.inf:
                samples[sampled:] = math.nan
                return n_impacts, max_gap, IMPACT_LOST
            max_gap = max(max_gap, highest_gap(flight, min(tau, left)))
            sampled = sample_motion(c, motion, theta, base, t, tau, times, samples, sampled)
            x, vx = slide(c, x, vx, tau)
            motion = Motion(ARRIVING, x, vx, sigma, z, vz, 0.0, -speed, 0.0)
            airborne = tau
            t += tau
    return n_impacts, max_gap, OK


class Summary(NamedTuple):
    """The result of a run: its last state, and totals over the run."""

    x: float  # m
    vx: float  # m/s
    z: float  # m
    vz: float  # m/s
    mean_velocity: float  # m/s, over the last part of the run
    impacts: int
    max_gap: float  # m
    status: str  # one of status.STATUS


def _follow(parameters, restitution, times, n_impacts=0):
    """Call `follow` with new arrays. Returns its result, the samples (NaN after an early end) and the impacts."""
    refuse_harmonics(parameters, "the rigid part")
    speeds, coefficients = ([0.0], [restitution]) if np.isscalar(restitution) else restitution
    speeds = np.asarray(speeds, dtype=np.float64)
    coefficients = check_array("restitution", coefficients, 0.0, 1.0)
    if speeds.shape != coefficients.shape or speeds.ndim != 1 or not (np.diff(speeds) > 0.0).all():
        raise ValueError("restitution must be a number or two columns of equal length, the speeds ascending")
    samples = np.empty((len(times), len(SAMPLE_COLUMNS)))
    impacts = np.empty((n_impacts, len(IMPACT_DTYPE)))
    result = follow(as_rows(parameters), speeds, coefficients, times, samples, impacts)
    return result, samples, impacts


def run(parameters: np.ndarray, duration: float, restitution) -> Summary:
    """Follow one rigid part from t = 0, at rest in x.

    ValueError names the argument that cannot be used.

    Parameters
    ----------
    parameters : a row of a table; stiffness, damping, mass, exponent and tension have no effect
    duration : s
    restitution : coefficient of restitution in [0, 1], or a pair of arrays (speeds of approach in m/s, coefficients)
    """
    duration = check_time("duration", duration)
    times = np.array([(1.0 - LAST) * duration, duration])
    (n_impacts, max_gap, status), samples, _ = _follow(parameters, restitution, times)
    x, vx, z, vz = (float(value) for value in samples[1])
    mean_velocity = (x - float(samples[0, 0])) / (LAST * duration)
    return Summary(x, vx, z, vz, mean_velocity, n_impacts, max_gap, STATUS[status])


def sample(parameters: np.ndarray, times: np.ndarray, restitution) -> dict[str, np.ndarray]:
    """States x, z (m), vx, vz (m/s) at `times` (s, not negative, any shape and order). For the rest see `run`."""
    return samples_and_impacts(parameters, times, restitution)[0]


def samples_and_impacts(
    parameters: np.ndarray, times: np.ndarray, restitution
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """As `sample`, and the impacts up to the last of `times`, of IMPACT_DTYPE."""
    times = check_array("times", times, 0.0, LONGEST, "s", least=0)
    moments, place = np.unique(times, return_inverse=True)
    samples, hits = np.empty((0, len(SAMPLE_COLUMNS))), np.empty((0, len(IMPACT_DTYPE)))
    if moments.size:
        room = math.ceil(IMPACTS_OF_CYCLE * (1.0 + as_rows(parameters)[model.FREQUENCY] * moments[-1]))
        (n_impacts, *_), samples, hits = _follow(parameters, restitution, moments, room)
        if n_impacts > room:
            _, samples, hits = _follow(parameters, restitution, moments, n_impacts)
        hits = hits[:n_impacts]
    sampled = {name: samples[place, k].reshape(times.shape) for k, name in enumerate(SAMPLE_COLUMNS)}
    return sampled, hits.view(IMPACT_DTYPE)[:, 0]
