"""Input and output of an integrator that follows the motion in one mode: flight, slip forward or backward, stick."""

from typing import NamedTuple

import numpy as np

# The modes; SIGN is the motion without modes, in which signs switch the forces.
SIGN, FLIGHT, FORWARD, BACKWARD, STICK = range(5)


class Failed(Exception):
    """A run does not reach its end; arguments: the code of its status, and the evaluations of its unfinished leg."""


class Task(NamedTuple):
    """One leg of a run."""

    t: float  # s, at the beginning
    end: float  # s
    state: np.ndarray  # x, ẋ, z, ż (m, m/s) at the beginning, shape (4,)
    times: np.ndarray  # s, ascending, after `t` and up to `end`, at which states are wanted
    rtol: float
    atol: np.ndarray  # m, m/s, shape (4,)
    limit: int  # evaluations of the right-hand side that are left


class Leg(NamedTuple):
    """The result of a leg, which ends at an event or at the end of the task, unless the integrator fails before."""

    t: float  # s, where it stopped
    state: np.ndarray  # x, ẋ, z, ż there, shape (4,)
    ended: int | None  # the event that ended it, a place among modes.ENDS of the mode; None where there is none
    samples: np.ndarray  # states at the wanted times up to `t`, shape (k, 4)
    evaluations: int  # of the right-hand side
