"""The integrators of scipy's `solve_ivp` on the same model, with terminal, directional events."""

import numpy as np
from scipy.integrate import solve_ivp

from ..solver.status import EVENT_LOST, GAVE_UP
from .leg import Failed, Leg, Task
from .modes import counted_rates, terminal_events


def follow(method: str, parameters: np.ndarray, mode: int, task: Task) -> Leg:
    """Follow one leg in a mode by a `method` of solve_ivp.

    Failed at the limit of evaluations, or if the interpolant of LSODA does not meet its own steps.
    """
    counting, derivatives = np.append(parameters, 0.0), np.empty(4)

    def right_side(t, state):
        if counting[-1] >= task.limit:
            raise Failed(GAVE_UP, task.limit)
        counted_rates(derivatives, t, state, counting, mode)
        return derivatives.copy()

    options = {"method": method, "rtol": task.rtol, "atol": task.atol, "dense_output": len(task.times) > 0}
    try:
        # Radau's numerical Jacobian of a part that never moves sideways overflows; peers.run checks the result.
        with np.errstate(over="ignore", invalid="ignore"):
            events = terminal_events(parameters, mode)
            solution = solve_ivp(right_side, (task.t, task.end), task.state, events=events, **options)
    except ValueError as error:
        raise Failed(EVENT_LOST, int(counting[-1])) from error
    ended = None
    if solution.status == 1:
        ended = next(place for place, times in enumerate(solution.t_events) if len(times))
    passed = task.times[task.times <= solution.t[-1]]
    samples = solution.sol(passed).T if len(passed) else np.empty((0, 4))
    return Leg(float(solution.t[-1]), solution.y[:, -1].copy(), ended, samples, int(counting[-1]))
