"""Integrators of other libraries on the same model.

The integrators are the methods of scipy's `solve_ivp` and, if they are installed, CyRK, CVODE of SUNDIALS and heyoka.

`treatment` is the way in which the jumps of the right-hand side are handled:

- "sign": not at all. The sign of the gap switches the force, and the sign of the slip velocity switches friction.
- "events": flight, slip forward, slip backward and stick each have a smooth right-hand side, and events of the
  integrator end each mode. The next mode begins at the state of the event.
- "modes": the same, but the next mode begins beside the zero of the event, on its own side.

The right-hand sides are compiled, so that methods are compared, not Python with machine code.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..packing import as_rows, refuse_harmonics
from ..parameters import LAST
from ..solver import model
from ..solver.status import GAVE_UP, NOT_FINITE, NOT_INSTALLED, OK, STATUS, STEP_TOO_SMALL, STUCK
from . import cyrk_peer, heyoka_peer, scipy_peer, sundials_peer
from .leg import SIGN, Failed, Leg, Task
from .modes import ENDS, gap_of, next_mode, plate_motion, put_beside, scales
from .rivals import RIVALS, installed_version

HEYOKA = "heyoka"
TREATMENTS = ("sign", "events", "modes")

# Where "modes" puts the variable of an event, in units of the plate's motion: a few rounding errors beside zero. At
# zero or on the wrong side the integrator finds the same event again, or never again, and the part falls through.
BESIDE = 1e-15
# heyoka rounds differently. Nearer to the plate a contact would begin outside of it, where its force is NaN.
BESIDE_OF_HEYOKA = 1e-13
# m and m/s, the scale of absolute tolerances on a plate at rest, because CVODE takes no tolerance of zero.
SMALLEST_SCALE = 1e-6


class PeerRun(NamedTuple):
    """The result of a run; NaN if it did not reach the end."""

    x: float  # m
    vx: float  # m/s
    z: float  # m
    vz: float  # m/s
    mean_velocity: float  # m/s, over the last part of the run
    evaluations: int  # of the right-hand side, those for Jacobians included
    status: str  # one of STATUS
    samples: np.ndarray  # x, ẋ, z, ż at the wanted times, shape (k, 4)
    events: np.ndarray  # s, the times of impacts and separations, as far as the treatment finds them


@dataclass
class Trajectory:
    """The state of a run."""

    parameters: np.ndarray
    integrator: str
    limit: int  # of evaluations
    times: np.ndarray  # s, ascending, at which states are wanted
    mode: int = SIGN
    evaluations: int = 0
    samples: list[np.ndarray] = field(default_factory=list)
    events: list[float] = field(default_factory=list)
    solvers: dict[int, Any] = field(default_factory=dict)  # of SUNDIALS, by mode


def leg_of(trajectory: Trajectory, task: Task) -> Leg:
    """Follow the part in its present mode by the trajectory's integrator."""
    parameters, mode = trajectory.parameters, trajectory.mode
    _, module, method, _ = RIVALS[trajectory.integrator]
    if module == "scipy":
        return scipy_peer.follow(method, parameters, mode, task)
    if module == "CyRK":
        return cyrk_peer.follow(method, parameters, mode, task)
    if module == "heyoka":
        return heyoka_peer.follow(parameters, mode, task)
    if mode not in trajectory.solvers:
        whole = task._replace(limit=trajectory.limit)
        trajectory.solvers[mode] = sundials_peer.solver_of(method, parameters, mode, whole)
    return sundials_peer.follow(trajectory.solvers[mode], task)


def advance(trajectory: Trajectory, begin: float, end: float, state: np.ndarray, treatment: str, rtol: float):
    """State at the time `end` (s), else an error Failed; absolute tolerances are `rtol` of `scales`."""
    parameters = trajectory.parameters
    atol = rtol * np.maximum(scales(parameters), SMALLEST_SCALE)
    t, state = begin, state.copy()
    beside = BESIDE_OF_HEYOKA if trajectory.integrator == HEYOKA else BESIDE
    if treatment != "sign" and trajectory.mode == SIGN:
        trajectory.mode = next_mode(parameters, t, state, None, SIGN)
    met = set()  # modes and states at the time t
    while t < end:
        times = trajectory.times[len(trajectory.samples) :]
        left = trajectory.limit - trajectory.evaluations
        leg = leg_of(trajectory, Task(t, end, state, times[times <= end], rtol, atol, left))
        trajectory.evaluations += leg.evaluations
        trajectory.samples.extend(leg.samples)
        if trajectory.evaluations >= trajectory.limit:
            raise Failed(GAVE_UP, 0)
        if leg.ended is None and leg.t < end:
            raise Failed(STEP_TOO_SMALL, 0)
        if leg.t > t:
            met.clear()
        t, state = leg.t, leg.state
        if leg.ended is not None:
            ended, _ = ENDS[trajectory.mode][leg.ended]
            if ended is gap_of:
                trajectory.events.append(t)
            trajectory.mode = next_mode(parameters, t, state, ended, trajectory.mode)
            if treatment == "modes":
                put_beside(parameters, t, state, ended, trajectory.mode, beside)
        here = trajectory.mode, state.tobytes()
        if here in met:  # The run would not end.
            raise Failed(STUCK, 0)
        met.add(here)
    return state


def run(
    parameters: np.ndarray,
    duration: float,
    integrator: str,
    treatment: str,
    tolerance: float,
    max_evaluations: int,
    times: Sequence[float] = (),
) -> PeerRun:
    """Integrate one trajectory from t = 0.

    ValueError for an unknown integrator or treatment.

    Parameters
    ----------
    parameters : a row of a table
    duration : s
    integrator : one of RIVALS
    treatment : one of TREATMENTS; heyoka knows "modes" only
    tolerance : relative tolerance; the absolute one is `tolerance` times `scales`
    max_evaluations : of the right-hand side, after which a run is given up
    times : s, ascending, above 0 and within the duration, at which states are wanted: they are interpolated (CVODE
        chooses the first step of a leg by the first of them)
    """
    if integrator not in RIVALS or treatment not in TREATMENTS:
        raise ValueError(f"{integrator!r} with {treatment!r} is none of {tuple(RIVALS)} with {TREATMENTS}")
    if integrator == HEYOKA and treatment != "modes":
        raise ValueError(f"heyoka handles events by modes, not by {treatment}")
    refuse_harmonics(parameters, integrator)
    parameters = as_rows(parameters)
    trajectory = Trajectory(parameters, integrator, max_evaluations, np.asarray(times, dtype=np.float64))

    def lost(status: int, evaluations: int) -> PeerRun:
        return PeerRun(*(math.nan,) * 5, evaluations, STATUS[status], np.full((len(times), 4), math.nan), np.empty(0))

    if installed_version(integrator) is None:
        return lost(NOT_INSTALLED, 0)
    z0 = parameters[model.Z0]
    state = np.array([0.0, 0.0, plate_motion(parameters, 0.0)[0] if math.isnan(z0) else z0, parameters[model.VZ0]])
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
    return PeerRun(x, vx, z, vz, mean_velocity, trajectory.evaluations, STATUS[OK], samples, events)
