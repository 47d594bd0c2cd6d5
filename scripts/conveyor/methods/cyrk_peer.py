"""CyRK's Runge-Kutta methods on the same model: compiled peers that need not be installed.

`pysolve_ivp` gets what https://cyrk.readthedocs.io recommends: a right-hand side that numba has compiled and that fills
an array, and terminal, directional events. (Its solver that is compiled throughout knows no events.) Each event ends a
solve; `peers` chooses the next mode.
"""

from collections.abc import Callable, Sequence

import numpy as np

from .leg import Leg, Task

# Evaluations of a step of the cheapest method: as many steps as this allows take no fewer evaluations than the limit.
FEWEST = 6


def watch(function: Callable, direction: float) -> Callable:
    """An event that ends a solve, with the arguments of the right-hand side."""

    def event(t, state, parameters, mode):
        return function(t, state, parameters)

    event.terminal, event.direction = True, int(direction)
    return event


def follow(
    method: str,
    counted_rates: Callable,
    parameters: np.ndarray,
    mode: int,
    ends: Sequence[tuple[Callable, float]],
    task: Task,
) -> Leg:
    """Follow one leg, `ended` by a place in `ends`.

    Parameters
    ----------
    method : in the words of CyRK
    counted_rates : (derivatives, t, state, parameters, mode), which counts its calls in the last of the parameters
    parameters : from `model.pack`
    ends : event functions (t, state, parameters) and the directions of their zeros
    """
    from CyRK import pysolve_ivp

    counted = np.append(parameters, 0.0)
    found = pysolve_ivp(
        counted_rates,
        (task.t, task.end),
        task.state,
        method=method,
        events=[watch(*one) for one in ends] or None,
        args=(counted, mode),
        rtol=task.rtol,
        atol=task.atol,
        max_num_steps=task.limit // FEWEST + 1,
        pass_dy_as_arg=True,
        dense_output=len(task.times) > 0,
    )
    t = float(found.t[-1])
    passed = task.times[task.times <= t]
    samples = found.call_vectorize(passed).T if len(passed) else np.empty((0, 4))
    ended = found.event_terminate_index if found.success and found.event_terminated else None
    return Leg(t, found.y[:, -1].copy(), ended, samples, int(counted[-1]))
