"""CyRK's Runge-Kutta methods on the same model: compiled peers that need not be installed.

`pysolve_ivp` is called as https://cyrk.readthedocs.io recommends: with a right-hand side that numba has compiled and
that fills an array, and with terminal, directional events. (CyRK's fully compiled solver has no events.) Each event
ends a solve, and `peers` chooses the next mode.
"""

import numpy as np

from .leg import Leg, Task
from .modes import counted_rates, terminal_events

# Evaluations in a step of the cheapest method. The limit of evaluations divided by it is a limit of steps.
FEWEST = 6


def follow(method: str, parameters: np.ndarray, mode: int, task: Task) -> Leg:
    """Follow one leg in a mode by a `method` of CyRK."""
    from CyRK import pysolve_ivp

    counting = np.append(parameters, 0.0)
    solution = pysolve_ivp(
        counted_rates,
        (task.t, task.end),
        task.state,
        method=method,
        events=terminal_events(parameters, mode) or None,
        args=(counting, mode),
        rtol=task.rtol,
        atol=task.atol,
        max_num_steps=task.limit // FEWEST + 1,
        pass_dy_as_arg=True,
        dense_output=len(task.times) > 0,
    )
    t = float(solution.t[-1])
    passed = task.times[task.times <= t]
    samples = solution.call_vectorize(passed).T if len(passed) else np.empty((0, 4))
    ended = solution.event_terminate_index if solution.success and solution.event_terminated else None
    return Leg(t, solution.y[:, -1].copy(), ended, samples, int(counting[-1]))
