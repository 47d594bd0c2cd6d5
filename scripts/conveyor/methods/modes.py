"""The model for integrators of SciPy: right-hand side, events that end a mode, and the mode that follows."""

import math
from collections.abc import Callable

import numpy as np

from ..packing import as_rows
from ..solver import model, plate
from ..solver.contact_law import coefficients_per_mass
from ..solver.jit import compiled, compiled_inline, copy
from .force_law import contact_acceleration, friction_acceleration, least_push, least_rub, power_of_depth

# The modes; SIGN is the motion without modes, in which signs switch the forces.
SIGN, FLIGHT, FORWARD, BACKWARD, STICK = range(5)
BESIDE = 1e-15  # in units of `scales`, some rounding errors beside zero, where a mode begins


@compiled_inline
def plate_of(parameters):
    """The Plate of a parameter vector."""
    return plate.Plate(
        2.0 * math.pi * parameters[model.FREQUENCY],
        parameters[model.ACCELERATION] * math.cos(parameters[model.ANGLE]),
        parameters[model.ACCELERATION] * math.sin(parameters[model.ANGLE]),
        math.cos(parameters[model.PHASE_SHIFT]),
        math.sin(parameters[model.PHASE_SHIFT]),
        None,
    )


@compiled
def plate_motion(parameters, t):
    """z_s (m), ż_s, ẋ_s (m/s) and ẍ_s (m/s²) at the time t (s) (Eqs. 3, 4, 10)."""
    c = plate_of(parameters)
    phase = c.omega * t + parameters[model.PSI0]
    sine, cosine = math.sin(phase), math.cos(phase)
    along = plate.speed(c, sine, cosine), c.a_x * plate.pull_share(c, sine, cosine)
    return plate.height(c, sine, cosine), plate.rise(c, sine, cosine), *along


@compiled
def gravity_of(parameters):
    """The components of gravity normal to the track and down along it, m/s²."""
    return model.normal_gravity(parameters), parameters[model.GRAVITY] * math.sin(parameters[model.INCLINATION])


@compiled
def normal_force(parameters, t, state):
    """Gap (m) and F_c/m (m/s²) as if in contact, of the state (x, ẋ, z, ż)."""
    z, vz, _, _ = plate_motion(parameters, t)
    gap = state[2] - z
    closed = min(gap, 0.0)
    stiffness, damping = coefficients_per_mass(parameters)
    push = contact_acceleration(
        closed,
        vz - state[3],
        power_of_depth(-closed, parameters[model.EXPONENT]),
        stiffness,
        damping,
        least_push(parameters[model.TENSION]),
    )
    return gap, push


@compiled
def counted_rates(derivatives, t, state, parameters, mode):
    """Fill in the derivatives of the state (x, ẋ, z, ż), shape (4,); an additional last parameter counts the calls."""
    parameters[-1] += 1.0
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
        rub = friction_acceleration(push, slip, parameters[model.FRICTION], least_rub(parameters[model.TENSION]))
        forward = rub - downhill
    copy(derivatives, (state[1], forward, state[3], push - normal))


@compiled
def gap_of(t, state, parameters):
    """The gap (m)."""
    return state[2] - plate_motion(parameters, t)[0]


@compiled
def slip_of(t, state, parameters):
    """The slip velocity ẋ_s - ẋ_p (m/s)."""
    return plate_motion(parameters, t)[2] - state[1]


@compiled
def pull_of(parameters, t):
    """The friction per mass that a part needs to stick, m/s²."""
    return plate_motion(parameters, t)[3] + gravity_of(parameters)[1]


@compiled
def grip_of(t, state, parameters):
    """The friction per mass that is available beyond what a part needs to stick, m/s²."""
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


def terminal_events(parameters: np.ndarray, mode: int) -> list[Callable]:
    """The events of a mode as functions (t, state, …) that end a solve, with the attributes of SciPy."""

    def terminal(function, direction):
        def event(t, state, *_):
            return function(t, state, parameters)

        event.terminal, event.direction = True, int(direction)
        return event

    return [terminal(*end) for end in ENDS[mode]]


def next_mode(parameters: np.ndarray, t: float, state: np.ndarray, ended: Callable | None, mode: int) -> int:
    """The mode that follows `mode` after the event `ended`; None for both at the start."""
    z, _, vx, _ = plate_motion(parameters, t)
    if state[2] > z if ended is None else ended is gap_of and mode != FLIGHT:
        return FLIGHT
    slips = ended not in (slip_of, grip_of) and state[1] != vx
    if not slips and ended is not grip_of and grip_of(t, state, parameters) >= 0.0:
        return STICK
    return FORWARD if (vx - state[1] if slips else pull_of(parameters, t)) > 0.0 else BACKWARD


def scales(parameters: np.ndarray) -> np.ndarray:
    """The scales of x, ẋ, z, ż (m, m/s) for absolute tolerances: amplitudes of the plate's motion, shape (4,)."""
    c = plate_of(as_rows(parameters))
    return np.array([c.a_x / c.omega**2, c.a_x / c.omega, c.a_z / c.omega**2, c.a_z / c.omega])


def put_beside(parameters: np.ndarray, t: float, state: np.ndarray, ended: Callable, mode: int) -> None:
    """Change `state` after the event `ended` to be just on the side of the zero that belongs to the next `mode`.

    At the zero or on its wrong side the integrator finds the same event again, or never again, and the part falls
    through.
    """
    z, _, vx, _ = plate_motion(parameters, t)
    _, beside_vx, beside_z, _ = BESIDE * scales(parameters)
    if ended is gap_of:
        state[2] = z + (beside_z if mode == FLIGHT else -beside_z)
    elif mode == FORWARD:
        state[1] = vx - beside_vx
    elif mode == BACKWARD:
        state[1] = vx + beside_vx
