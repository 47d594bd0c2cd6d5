"""Other integrators on the same model, as one would write it down for them: peers to compare the solver with.

They are those of scipy's `solve_ivp`, and heyoka where that is installed.

`treatment` says how the jumps of the right-hand side are handled:

- "sign": not at all. The force is switched by the sign of the gap, friction by that of the slip velocity.
- "events": flight, slip forward, slip backward and stick each have a smooth right-hand side, and an event of
  `solve_ivp` ends each. The next mode begins at the state that the event has found.
- "modes": the same, and the next mode begins beside the zero of that event, on its own side.

scipy's right-hand sides are compiled, so that the comparison is one of methods, not of Python against machine code.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from ..solver import model
from ..solver.jit import kernel
from . import heyoka_peer
from .force_law import contact_acceleration, friction_acceleration

HEYOKA = "heyoka"
INTEGRATORS = ("RK45", "DOP853", "Radau", "LSODA", HEYOKA)
TREATMENTS = ("sign", "events", "modes")
STATUSES = ("ok", "gave up", "stuck at an event", "step too small", "event lost", "not finite", "not installed")
OK, GAVE_UP, STUCK, STEP_TOO_SMALL, EVENT_LOST, NOT_FINITE, NOT_INSTALLED = STATUSES

SIGN, FLIGHT, FORWARD, BACKWARD, STICK = range(5)
# Where "modes" puts the variable of an event that is handled, in units of the plate's motion: a few roundings beside
# zero. At zero, or on the wrong side, it is found as the same event again, or never again: the part falls through.
BESIDE = 1e-15
# heyoka finds the plate in other roundings: nearer to it, a contact begins outside of it, where its force is no number.
BESIDE_OF_HEYOKA = 1e-13


class Summary(NamedTuple):
    """What one run comes to; NaN where it did not reach the end."""

    x: float  # m
    vx: float  # m/s
    z: float  # m
    vz: float  # m/s
    mean_velocity: float  # m/s, over the last part of the run
    evaluations: int  # of the right-hand side, those for Jacobians included
    status: str  # one of STATUSES


@kernel
def plate_motion(parameters, t):
    """z_s (m), ż_s, ẋ_s (m/s) and ẍ_s (m/s²) at the time t (s) (Eqs. 3, 4, 10)."""
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    phase = omega * t + parameters[model.PSI0]
    a_z = parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE])
    a_x = parameters[model.ACCELERATION] * math.cos(parameters[model.ANGLE])
    sine, cosine = math.sin(phase), math.cos(phase)
    ahead, straight = math.sin(parameters[model.PHASE_SHIFT]), math.cos(parameters[model.PHASE_SHIFT])
    sine_x, cosine_x = sine * straight + cosine * ahead, cosine * straight - sine * ahead
    return -a_z / omega**2 * cosine, a_z / omega * sine, a_x / omega * sine_x, a_x * cosine_x


@kernel
def gravity_of(parameters):
    """The components of gravity normal to the track and down along it, m/s²."""
    gravity, inclination = parameters[model.GRAVITY], parameters[model.INCLINATION]
    return gravity * math.cos(inclination), gravity * math.sin(inclination)


@kernel
def normal_force(parameters, t, state):
    """Gap (m) and F_c/m (m/s²) as if in contact, of the state (x, ẋ, z, ż)."""
    z, vz, _, _ = plate_motion(parameters, t)
    gap = state[2] - z
    mass = parameters[model.MASS]
    push = contact_acceleration(
        min(gap, 0.0),
        state[3] - vz,
        parameters[model.STIFFNESS] / mass,
        parameters[model.DAMPING] / mass,
        parameters[model.EXPONENT],
        parameters[model.TENSION],
    )
    return gap, push


@kernel
def rates(t, state, parameters, mode):
    """Derivative of the state (x, ẋ, z, ż), shape (4,)."""
    gap, push = normal_force(parameters, t, state)
    if mode == FLIGHT or (mode == SIGN and gap > 0.0):
        push = 0.0
    _, _, vx, ax = plate_motion(parameters, t)
    normal, downhill = gravity_of(parameters)
    if mode == STICK:
        forward = ax
    else:
        slip = vx - state[1]
        if mode == FORWARD:
            slip = 1.0
        elif mode == BACKWARD:
            slip = -1.0
        rub = friction_acceleration(push, slip, parameters[model.FRICTION], parameters[model.TENSION])
        forward = rub - downhill
    return np.array([state[1], forward, state[3], push - normal])


@kernel
def gap_of(t, state, parameters):
    """The gap (m)."""
    return state[2] - plate_motion(parameters, t)[0]


@kernel
def slip_of(t, state, parameters):
    """The slip velocity ẋ_s - ẋ_p (m/s)."""
    return plate_motion(parameters, t)[2] - state[1]


@kernel
def pull_of(parameters, t):
    """What a part that sticks needs from friction, m/s²."""
    return plate_motion(parameters, t)[3] + gravity_of(parameters)[1]


@kernel
def grip_of(t, state, parameters):
    """What friction can hold beyond what a part that sticks needs, m/s²."""
    _, push = normal_force(parameters, t, state)
    return parameters[model.STATIC_FRICTION] * push - abs(pull_of(parameters, t))


# The event functions that end each mode, and the direction of their zeros.
ENDS: dict[int, tuple[tuple[Callable, float], ...]] = {
    SIGN: (),
    FLIGHT: ((gap_of, -1.0),),
    FORWARD: ((gap_of, 1.0), (slip_of, -1.0)),
    BACKWARD: ((gap_of, 1.0), (slip_of, 1.0)),
    STICK: ((gap_of, 1.0), (grip_of, -1.0)),
}


def next_mode(parameters: np.ndarray, t: float, state: np.ndarray, ended: Callable | None, mode: int) -> int:
    """The mode that follows `mode` after the event `ended`; None for both at the start."""
    z, _, vx, _ = plate_motion(parameters, t)
    if state[2] > z if ended is None else ended is gap_of and mode != FLIGHT:
        return FLIGHT
    slips = ended not in (slip_of, grip_of) and state[1] != vx
    if not slips and ended is not grip_of and grip_of(t, state, parameters) >= 0.0:
        return STICK
    return FORWARD if (vx - state[1] if slips else pull_of(parameters, t)) > 0.0 else BACKWARD


def put_beside(
    parameters: np.ndarray, t: float, state: np.ndarray, ended: Callable, mode: int, beside: float = BESIDE
) -> None:
    """Change `state` after the event `ended` to be just on the side of the zero that belongs to the next `mode`."""
    z, _, vx, _ = plate_motion(parameters, t)
    _, beside_vx, beside_z, _ = beside * scales(parameters)
    if ended is gap_of:
        state[2] = z + (beside_z if mode == FLIGHT else -beside_z)
    elif mode == FORWARD:
        state[1] = vx - beside_vx
    elif mode == BACKWARD:
        state[1] = vx + beside_vx


# The same modes and events under heyoka's names.
HEYOKA_MODES = {
    FLIGHT: heyoka_peer.FLIGHT,
    FORWARD: heyoka_peer.FORWARD,
    BACKWARD: heyoka_peer.BACKWARD,
    STICK: heyoka_peer.STICK,
}
HEYOKA_EVENTS = {heyoka_peer.GAP: gap_of, heyoka_peer.SLIP: slip_of, heyoka_peer.GRIP: grip_of}


class GaveUp(Exception):
    """More evaluations than allowed."""


class Stuck(Exception):
    """The same mode and state at the same time again: the run would find these events for ever."""


class EventLost(Exception):
    """The search for an event finds no change of sign: LSODA's interpolant does not meet its own steps."""


class Counted:
    """A right-hand side that counts its evaluations and stops at a limit."""

    def __init__(self, parameters: np.ndarray, limit: int):
        self.parameters = parameters
        self.limit = limit
        self.mode = SIGN
        self.count = 0

    def __call__(self, t: float, state: np.ndarray) -> np.ndarray:
        self.count += 1
        if self.count > self.limit:
            raise GaveUp
        return rates(t, state, self.parameters, self.mode)


def watch(parameters: np.ndarray, function: Callable, direction: float) -> Callable:
    """An event of solve_ivp that ends the integration."""

    def event(t, state):
        return function(t, state, parameters)

    event.terminal, event.direction = True, direction
    return event


def leg_of_scipy(right_side: Counted, t: float, end: float, state: np.ndarray, options: dict):
    """Follow `state` in one mode to an event or to `end`: time, state and event, or None where the integrator fails."""
    ends = ENDS[right_side.mode]
    watched = [watch(right_side.parameters, function, direction) for function, direction in ends]
    try:
        # Radau's numerical Jacobian of a part that never moves sideways overflows; what comes of it is judged below.
        with np.errstate(over="ignore", invalid="ignore"):
            found = solve_ivp(right_side, (t, end), state, events=watched, **options)
    except ValueError as error:
        raise EventLost from error
    if not found.success:
        return None
    ended = None
    if found.status == 1:
        ended = next(function for (function, _), times in zip(ends, found.t_events, strict=True) if len(times))
    return float(found.t[-1]), found.y[:, -1].copy(), ended


def leg_of_heyoka(right_side: Counted, t: float, end: float, state: np.ndarray, options: dict):
    """The same by heyoka."""
    mode, limit = HEYOKA_MODES[right_side.mode], right_side.limit - right_side.count
    leg = heyoka_peer.follow(right_side.parameters, mode, t, end, state, options["rtol"], limit)
    if leg is None:
        return None
    right_side.count += leg.evaluations
    if right_side.count >= right_side.limit:
        raise GaveUp
    return leg.t, leg.state, HEYOKA_EVENTS.get(leg.ended)


def advance(right_side: Counted, begin: float, end: float, state: np.ndarray, treatment: str, options: dict):
    """State at the time `end` (s), or None where the integrator fails; `options` are those of solve_ivp."""
    parameters = right_side.parameters
    t, state = begin, state.copy()
    by_heyoka = options["method"] == HEYOKA
    follow_leg, beside = (leg_of_heyoka, BESIDE_OF_HEYOKA) if by_heyoka else (leg_of_scipy, BESIDE)
    if treatment != "sign" and right_side.mode == SIGN:
        right_side.mode = next_mode(parameters, t, state, None, SIGN)
    met = set()  # modes and states at the time t
    while t < end:
        leg = follow_leg(right_side, t, end, state, options)
        if leg is None:
            return None
        if leg[0] > t:
            met.clear()
        t, state, ended = leg
        if ended is not None:
            right_side.mode = next_mode(parameters, t, state, ended, right_side.mode)
            if treatment == "modes":
                put_beside(parameters, t, state, ended, right_side.mode, beside)
        here = right_side.mode, state.tobytes()
        if here in met:
            raise Stuck
        met.add(here)
    return state


def scales(parameters: np.ndarray) -> np.ndarray:
    """Sizes of x, ẋ, z, ż (m, m/s) that absolute tolerances refer to: those of the plate's motion, shape (4,)."""
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    a_z = parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE])
    a_x = parameters[model.ACCELERATION] * math.cos(parameters[model.ANGLE])
    return np.array([a_x / omega**2, a_x / omega, a_z / omega**2, a_z / omega])


def run(
    parameters: np.ndarray,
    duration: float,
    integrator: str,
    treatment: str,
    tolerance: float,
    max_evaluations: int,
    last: float = 0.25,
) -> Summary:
    """Integrate one trajectory from t = 0.

    Parameters
    ----------
    parameters : float64, shape (16,), from `model.pack`
    duration : s
    integrator : one of INTEGRATORS, methods of scipy's solve_ivp but the last one
    treatment : one of TREATMENTS; heyoka knows "modes" only
    tolerance : relative tolerance; the absolute one of solve_ivp is `tolerance` times `scales`
    max_evaluations : of the right-hand side, after which a run is given up
    last : share of the run over which the mean velocity is taken

    Raises
    ------
    ValueError
        for an unknown integrator or treatment
    """
    if integrator not in INTEGRATORS or treatment not in TREATMENTS:
        raise ValueError(f"{integrator!r} with {treatment!r} is none of {INTEGRATORS} with {TREATMENTS}")
    lost = (math.nan,) * 5
    if integrator == HEYOKA and treatment != "modes":
        raise ValueError(f"heyoka handles events by modes, not by {treatment}")
    if integrator == HEYOKA and not heyoka_peer.installed():
        return Summary(*lost, 0, NOT_INSTALLED)
    right_side = Counted(parameters, max_evaluations)
    z0 = parameters[model.Z0]
    state = np.array([0.0, 0.0, plate_motion(parameters, 0.0)[0] if math.isnan(z0) else z0, parameters[model.VZ0]])
    middle = (1.0 - last) * duration
    options = {"method": integrator, "rtol": tolerance, "atol": tolerance * scales(parameters)}
    try:
        before = advance(right_side, 0.0, middle, state, treatment, options)
        after = None if before is None else advance(right_side, middle, duration, before, treatment, options)
    except GaveUp:
        return Summary(*lost, right_side.limit, GAVE_UP)
    except Stuck:
        return Summary(*lost, right_side.count, STUCK)
    except EventLost:
        return Summary(*lost, right_side.count, EVENT_LOST)
    if after is None:
        return Summary(*lost, right_side.count, STEP_TOO_SMALL)
    if not np.isfinite(after).all():
        return Summary(*lost, right_side.count, NOT_FINITE)
    x, vx, z, vz = map(float, after)
    return Summary(x, vx, z, vz, (x - float(before[0])) / (last * duration), right_side.count, OK)
