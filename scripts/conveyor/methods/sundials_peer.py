"""CVODE of SUNDIALS with its root finding on the same model: a peer that need not be installed.

It is used as the documentation of scikit-sundae recommends: Adams' methods for problems that are not stiff and BDF for
stiff ones; event functions with directions, at whose zeros the integrator stops; one solver for each mode, which
restarts at each event. The right-hand side is compiled by numba; its callback is a Python function.
"""

from typing import Any

import numpy as np

from .leg import Leg, Task
from .modes import counted_rates, terminal_events

ROOT_FOUND = 2  # CV_ROOT_RETURN


def solver_of(method: str, parameters: np.ndarray, mode: int, task: Task) -> Any:
    """A solver of one mode by the `method` Adams or BDF, with the tolerances and the limit of a task."""
    from sksundae.cvode import CVODE

    counting = np.append(parameters, 0.0)

    def right_side(t, state, derivatives):
        counted_rates(derivatives, t, state, counting, mode)

    def events(t, state, values):
        for place, event in enumerate(events.functions):
            values[place] = event(t, state)

    events.functions = terminal_events(parameters, mode)
    events.terminal = [event.terminal for event in events.functions]
    events.direction = [event.direction for event in events.functions]
    watched = {"eventsfn": events, "num_events": len(events.functions)} if events.functions else {}
    return CVODE(right_side, method=method, rtol=task.rtol, atol=task.atol, max_num_steps=task.limit, **watched)


def follow(solver: Any, task: Task) -> Leg:
    """Follow one leg by the solver of its mode."""
    solver.init_step(task.t, task.state)
    states = []
    for wanted in np.union1d(task.times, task.end):
        step = solver.step(wanted, "normal", task.end)
        if not step.success or step.status == ROOT_FOUND:
            break
        states.append(step.y)
    ended = int(np.flatnonzero(step.i_events[-1])[0]) if step.status == ROOT_FOUND else None
    samples = np.array(states[: len(task.times)]).reshape(-1, 4)
    return Leg(float(step.t), step.y, ended, samples, step.nfev)
