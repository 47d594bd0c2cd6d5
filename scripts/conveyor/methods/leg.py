"""Motion in one mode (flight, slip forward, slip backward, stick): what an integrator is asked for, and returns."""

from typing import Any, NamedTuple

import numpy as np


class Task(NamedTuple):
    """What is asked of an integrator."""

    t: float  # s, at the beginning
    end: float  # s
    state: np.ndarray  # x, ẋ, z, ż (m, m/s) at the beginning, shape (4,)
    times: np.ndarray  # s, ascending, after `t` and up to `end`, at which states are wanted
    rtol: float
    atol: np.ndarray  # m, m/s, shape (4,)
    limit: int  # evaluations of the right-hand side that are left


class Leg(NamedTuple):
    """What an integrator returns; it failed, or reached the limit, where it ends before both the end and an event."""

    t: float  # s, at its end
    state: np.ndarray  # x, ẋ, z, ż at its end, shape (4,)
    ended: Any  # the event at its end, in the terms of the integrator; None where there is none
    samples: np.ndarray  # states at those of the wanted times that are not after its end, shape (k, 4)
    evaluations: int  # of the right-hand side
