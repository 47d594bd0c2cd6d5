"""heyoka's Taylor integrator on the same model: a compiled peer that need not be installed.

Flight, slip forward, slip backward and stick are systems of their own, and terminal events end them, as in `peers`
with the treatment "modes". See https://bluescarni.github.io/heyoka.py.
"""

from functools import lru_cache
from typing import Any

import numpy as np

from ..solver import plate
from ..solver.contact_law import spring_and_damper
from ..solver.model import EXPONENT, PARAMETERS, TENSION, TENSION_ALLOW
from .leg import BACKWARD, FLIGHT, FORWARD, STICK, Leg, Task
from .modes import ENDS


@lru_cache(maxsize=64)
def systems(exponent: float, tolerance: float) -> dict[int, Any]:
    """Compiled integrators by mode; their parameters are set when they are used.

    Each has the events of its mode, in the same order; the last event of stick occurs twice, once for each direction.
    """
    import heyoka as hy

    x, vx, z, vz = hy.make_vars("x", "vx", "z", "vz")
    p = {name: hy.par[k] for k, name in enumerate(PARAMETERS)}
    c = plate.Plate(
        2.0 * np.pi * p["frequency"],
        p["acceleration"] * hy.cos(p["angle"]),
        p["acceleration"] * hy.sin(p["angle"]),
        hy.cos(p["phase_shift"]),
        hy.sin(p["phase_shift"]),
        0,
        0,
    )
    phase = c.omega * hy.time + p["psi0"]
    turn = c, hy.sin(phase), hy.cos(phase)
    # Gap and its rate, slip velocity, and the acceleration of the plate along the track, as expressions.
    gap, rate = z - plate.height(*turn), vz - plate.rise(*turn)
    slip, forward = plate.speed(*turn) - vx, c.a_x * plate.pull_share(*turn)
    push = spring_and_damper(p["stiffness"] * (-gap) ** exponent, p["damping"], -rate) / p["mass"]
    rub = p["friction"] * push
    up, down = hy.event_direction.positive, hy.event_direction.negative

    def system(ax, az, *ends):
        return hy.taylor_adaptive(
            [(x, vx), (vx, ax), (z, vz), (vz, az)],
            [0.0, 0.0, 1.0, 0.0],
            tol=tolerance,
            t_events=[hy.t_event(function, direction=direction) for function, direction in ends],
        )

    normal, downhill = p["gravity"] * hy.cos(p["inclination"]), p["gravity"] * hy.sin(p["inclination"])
    pressed, held, pull = push - normal, p["static_friction"] * push, forward + downhill
    return {
        FLIGHT: system(0.0 * x - downhill, -normal, (gap, down)),
        FORWARD: system(rub - downhill, pressed, (gap, up), (slip, down)),
        BACKWARD: system(-rub - downhill, pressed, (gap, up), (slip, up)),
        STICK: system(forward, pressed, (gap, up), (held - pull, down), (held + pull, down)),
    }


def follow(parameters: np.ndarray, mode: int, task: Task) -> Leg:
    """Follow one leg in a mode. A step of order n counts n evaluations: it finds n derivatives of the force."""
    if parameters[TENSION] != TENSION_ALLOW:
        raise ValueError("heyoka follows the contact with tension = allow only")
    integrator = systems(float(parameters[EXPONENT]), task.rtol)[mode]
    integrator.pars[:] = parameters[: len(integrator.pars)]
    integrator.time = task.t
    integrator.state[:] = task.state
    integrator.reset_cooldowns()
    most_steps = task.limit // integrator.order + 1
    outcome, _, _, steps, curve, *_ = integrator.propagate_until(
        task.end, max_steps=most_steps, c_output=len(task.times) > 0
    )
    state, evaluations = integrator.state.copy(), steps * integrator.order
    # Outcomes from -1 downwards are the numbers of terminal events.
    event = -1 - int(outcome)
    ended = min(event, len(ENDS[mode]) - 1) if event < len(integrator.t_events) else None
    if not np.isfinite(state).all():
        return Leg(task.t, state, None, np.empty((0, 4)), evaluations)
    passed = task.times[task.times <= integrator.time]
    samples = curve(passed) if len(passed) else np.empty((0, 4))
    return Leg(integrator.time, state, ended, samples, evaluations)
