"""CVODE of SUNDIALS with its root finding on the same model: a peer that need not be installed.

Used as the documentation of scikit-sundae recommends: Adams' methods for a problem that is not stiff, BDF for one
that is; event functions with directions, at whose zeros the integrator stops; one solver for each mode, which begins
anew at each event. The right-hand side is compiled by numba; its callback is a function of Python.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .leg import Leg, Task

ROOT_FOUND = 2  # CV_ROOT_RETURN


def solver_of(
    method: str,
    counted_rates: Callable,
    parameters: np.ndarray,
    mode: int,
    ends: Sequence[tuple[Callable, float]],
    task: Task,
) -> Any:
    """A solver of one mode by the `method` Adams or BDF; other arguments as of `cyrk_peer.follow`."""
    from sksundae.cvode import CVODE

    counted = np.append(parameters, 0.0)
    functions = [function for function, _ in ends]

    def right_side(t, state, derivatives):
        counted_rates(derivatives, t, state, counted, mode)

    def events(t, state, values):
        for place, function in enumerate(functions):
            values[place] = function(t, state, counted)

    events.terminal = [True] * len(ends)
    events.direction = [int(direction) for _, direction in ends]
    watched = {"eventsfn": events, "num_events": len(ends)} if ends else {}
    return CVODE(right_side, method=method, rtol=task.rtol, atol=task.atol, max_num_steps=task.limit, **watched)


def follow(solver: Any, task: Task) -> Leg:
    """Follow one leg, `ended` by a place among the events of its solver."""
    solver.init_step(task.t, task.state)
    states = []
    for wanted in np.union1d(task.times, task.end):
        found = solver.step(wanted, "normal", task.end)
        if not found.success or found.status == ROOT_FOUND:
            break
        states.append(found.y)
    ended = int(np.flatnonzero(found.i_events[-1])[0]) if found.status == ROOT_FOUND else None
    samples = np.array(states[: len(task.times)]).reshape(-1, 4)
    return Leg(float(found.t), found.y, ended, samples, found.nfev)
