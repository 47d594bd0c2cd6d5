"""The integrators of SciPy's `solve_ivp` on the same model.

`treatment` is the way in which the jumps of the right-hand side are handled:

- "sign": not at all. The sign of the gap switches the force, and the sign of the slip velocity switches friction.
- "events": flight, slip forward, slip backward and stick each have a smooth right-hand side, and terminal, directional
  events of the integrator end each mode. The next mode begins at the state of the event.
- "modes": the same, but the next mode begins beside the zero of the event, on its own side.

The right-hand sides are compiled, so that methods are compared, not Python with machine code.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from conveyor.methods import modes
from conveyor.packing import as_rows, refuse_harmonics
from conveyor.parameters import LAST, PARAMETERS

TREATMENTS = ("sign", "events", "modes")
# How a run ended.
OK, NOT_FINITE = "ok", "not finite"
GAVE_UP, STUCK, STEP_TOO_SMALL, EVENT_LOST = "gave up", "stuck at an event", "step too small", "event lost"
# m and m/s, the scale of absolute tolerances on a plate at rest, so that none is zero.
SMALLEST_SCALE = 1e-6


class Failed(Exception):
    """A run does not reach its end; arguments: its status, and the evaluations of its unfinished leg."""


class Leg(NamedTuple):
    """The motion in one mode, which ends at an event or at the end of the task."""

    t: float  # s, where it ended
    state: np.ndarray  # x, ẋ, z, ż there (m, m/s), shape (4,)
    ended: int | None  # the event that ended it, a place among modes.ENDS of the mode; None where there is none
    samples: np.ndarray  # states at the wanted times up to `t`, shape (k, 4)
    evaluations: int  # of the right-hand side


class IntegratorRun(NamedTuple):
    """The result of a run; NaN if it did not reach the end."""

    x: float  # m
    vx: float  # m/s
    z: float  # m
    vz: float  # m/s
    mean_velocity: float  # m/s, over the last part of the run
    evaluations: int  # of the right-hand side, those for Jacobians included
    status: str  # one of those above
    samples: np.ndarray  # x, ẋ, z, ż at the wanted times, shape (k, 4)
    events: np.ndarray  # s, the times of impacts and separations, as far as the treatment finds them


@dataclass
class Trajectory:
    """The state of a run."""

    parameters: np.ndarray
    integrator: str
    limit: int  # of evaluations
    times: np.ndarray  # s, ascending, at which states are wanted
    mode: int = modes.SIGN
    evaluations: int = 0
    samples: list[np.ndarray] = field(default_factory=list)
    events: list[float] = field(default_factory=list)


def follow(trajectory: Trajectory, begin: float, end: float, state: np.ndarray, rtol: float, atol: np.ndarray) -> Leg:
    """Follow the part in its present mode, from the time `begin` to `end` (s) at the latest.

    Failed at the limit of evaluations, at a step that is too small, or if the interpolant of LSODA does not meet its
    own steps.
    """
    limit = trajectory.limit - trajectory.evaluations
    counting = np.append(trajectory.parameters, 0.0)
    derivatives = np.empty(4)

    def right_side(t, state):
        if counting[-1] >= limit:
            raise Failed(GAVE_UP, limit)
        modes.counted_rates(derivatives, t, state, counting, trajectory.mode)
        return derivatives.copy()

    times = trajectory.times[len(trajectory.samples) :]
    times = times[times <= end]
    # SciPy interpolates at these times only, and without them not at all.
    wanted = np.union1d(times, [end]) if len(times) else None
    options = {"method": trajectory.integrator, "rtol": rtol, "atol": atol, "t_eval": wanted}
    try:
        # Radau's numerical Jacobian of a part that never moves sideways overflows; `run` checks the result.
        with np.errstate(over="ignore", invalid="ignore"):
            events = modes.terminal_events(trajectory.parameters, trajectory.mode)
            solution = solve_ivp(right_side, (begin, end), state, events=events, **options)
    except ValueError as error:
        raise Failed(EVENT_LOST, int(counting[-1])) from error
    if not solution.success:
        raise Failed(STEP_TOO_SMALL, int(counting[-1]))
    states = np.reshape(solution.y, (4, -1))  # also if no wanted time was reached
    if solution.status == 1:
        ended = next(place for place, zeros in enumerate(solution.t_events) if len(zeros))
        t, last = float(solution.t_events[ended][0]), solution.y_events[ended][0]
    else:
        ended, t, last = None, end, states[:, -1]
    samples = states[:, : np.searchsorted(times, t, side="right")].T
    return Leg(t, last.copy(), ended, samples, int(counting[-1]))


def advance(trajectory: Trajectory, begin: float, end: float, state: np.ndarray, treatment: str, rtol: float):
    """State at the time `end` (s), else an error Failed; absolute tolerances are `rtol` of `scales`."""
    parameters = trajectory.parameters
    atol = rtol * np.maximum(modes.scales(parameters), SMALLEST_SCALE)
    t, state = begin, state.copy()
    if treatment != "sign" and trajectory.mode == modes.SIGN:
        trajectory.mode = modes.next_mode(parameters, t, state, None, modes.SIGN)
    met = set()  # modes and states at the time t
    while t < end:
        leg = follow(trajectory, t, end, state, rtol, atol)
        trajectory.evaluations += leg.evaluations
        trajectory.samples.extend(leg.samples)
        if trajectory.evaluations >= trajectory.limit:
            raise Failed(GAVE_UP, 0)
        if leg.t > t:
            met.clear()
        t, state = leg.t, leg.state
        if leg.ended is not None:
            ended, _ = modes.ENDS[trajectory.mode][leg.ended]
            if ended is modes.gap_of:
                trajectory.events.append(t)
            trajectory.mode = modes.next_mode(parameters, t, state, ended, trajectory.mode)
            if treatment == "modes":
                modes.put_beside(parameters, t, state, ended, trajectory.mode)
        situation = trajectory.mode, state.tobytes()
        if situation in met:  # The run would not end.
            raise Failed(STUCK, 0)
        met.add(situation)
    return state


def run(
    parameters: np.ndarray,
    duration: float,
    integrator: str,
    treatment: str,
    tolerance: float,
    max_evaluations: int,
    times: Sequence[float] = (),
) -> IntegratorRun:
    """Integrate one trajectory from t = 0.

    Parameters
    ----------
    parameters : a row of a table
    duration : s
    integrator : RK45, DOP853, Radau or LSODA
    treatment : one of TREATMENTS
    tolerance : relative tolerance; the absolute one is `tolerance` times `scales`
    max_evaluations : of the right-hand side, after which a run is given up
    times : s, ascending, above 0 and within the duration, at which states are wanted: they are interpolated
    """
    refuse_harmonics(parameters, integrator)
    parameters = as_rows(parameters)
    trajectory = Trajectory(parameters, integrator, max_evaluations, np.asarray(times, dtype=np.float64))

    def lost(status: str, evaluations: int) -> IntegratorRun:
        samples = np.full((len(times), 4), math.nan)
        return IntegratorRun(*(math.nan,) * 5, evaluations, status, samples, np.empty(0))

    z0, vz0 = parameters[[PARAMETERS.index(name) for name in ("z0", "vz0")]]
    state = np.array([0.0, 0.0, modes.plate_motion(parameters, 0.0)[0] if math.isnan(z0) else z0, vz0])
    middle = (1.0 - LAST) * duration
    try:
        before = advance(trajectory, 0.0, middle, state, treatment, tolerance)
        after = advance(trajectory, middle, duration, before, treatment, tolerance)
    except Failed as failure:
        status, evaluations = failure.args
        return lost(status, min(trajectory.evaluations + evaluations, max_evaluations))
    if not np.isfinite(after).all():
        return lost(NOT_FINITE, trajectory.evaluations)
    x, vx, z, vz = map(float, after)
    mean_velocity = (x - float(before[0])) / (LAST * duration)
    samples, events = np.array(trajectory.samples).reshape(-1, 4), np.array(trajectory.events)
    return IntegratorRun(x, vx, z, vz, mean_velocity, trajectory.evaluations, OK, samples, events)
