"""Where to look for an orbit: its states at all nodes of a shooting, in floating point. Nothing is proved here."""

import math
from typing import NamedTuple

import numpy as np

from ..analysis import stroboscopic_map
from ..solver import contact
from ..solver.model import PARAMETERS
from ..solver.trajectory import OK
from .balls import Refused
from .law import Law
from .newton import CORRECTIONS, FARTHEST, inverse_of

TOLERANCE = 1e-15  # of the contact steps
CLOSE = 1e-15  # size of a correction after which no further one is made


class Guess(NamedTuple):
    """An orbit in floating point."""

    states: np.ndarray  # (δ, Y) at all nodes, in units of the law, shape (n, 2)
    matrices: np.ndarray  # derivatives of the next ones by them, shape (n, 2, 2)

    @property
    def slope(self) -> np.ndarray:
        """Derivative of what the motions miss the next nodes by, by all states, shape (2 n, 2 n)."""
        count = len(self.states)
        slope = np.zeros((count, 2, count, 2))
        node = np.arange(count)
        slope[node, :, node, :] = self.matrices
        slope[node, :, (node + 1) % count, :] -= np.eye(2)
        return slope.reshape(2 * count, 2 * count)

    @property
    def doubling_test(self) -> float:
        """(1 + μ1)(1 + μ2)."""
        whole = np.eye(2)
        for matrix in self.matrices:
            whole = matrix @ whole
        return 1.0 + np.trace(whole) + np.prod(np.linalg.det(self.matrices))


class Motion:
    """The motion at an amplitude in floating point, from node to node."""

    def __init__(self, law: Law, gamma: float, nodes: int):
        given = {
            "acceleration": gamma,
            "angle": 0.5 * math.pi,
            "frequency": 0.5 / math.pi,
            "psi0": law.phase,
            "stiffness": law.kappa,
            "damping": law.beta,
            "mass": 1.0,
            "exponent": 0.5 * law.twice_exponent,
            "gravity": 1.0,
        }
        parameters = np.array([float(given.get(name, 0.0)) for name in PARAMETERS])
        self.constants, self.nodes = contact.constants(parameters, TOLERANCE), nodes
        self.series, self.features = contact.workspace(), np.zeros(stroboscopic_map.FEATURES)

    def piece(self, node: int, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(δ, Y) at the next node, and its derivative, shape (2, 2)."""
        c, tangent = self.constants, np.eye(2)
        turn = 2.0 * math.pi / self.nodes
        state = start.copy()
        state[1] -= c.damping * max(state[0], 0.0)
        begin = c.psi0 + turn * (node % self.nodes)
        if stroboscopic_map.advance(c, self.series, state, begin, turn, tangent, self.features) != OK:
            raise Refused("floating point cannot follow the motion")
        state[1] += c.damping * max(state[0], 0.0)
        return state, tangent.T

    def pieces(self, states: np.ndarray) -> tuple[Guess, np.ndarray]:
        """The motions from all nodes, states of shape (n, 2), and where they arrive, shape (n, 2)."""
        ends, matrices = zip(*(self.piece(*pair) for pair in enumerate(states)), strict=True)
        return Guess(states, np.array(matrices)), np.array(ends)

    def launch(self, strobes: np.ndarray) -> np.ndarray:
        """States of all nodes, shape (n, 2), from those at the beginnings of the cycles, shape (period, 2)."""
        states = []
        for strobe in strobes:
            states.append(strobe)
            for node in range(self.nodes - 1):
                states.append(self.piece(node, states[-1])[0])
        return np.array(states)


def guess(law: Law, gamma: float, nodes: int, strobes: np.ndarray) -> Guess:
    """The orbit near approximate states at the beginnings of its cycles.

    Parameters
    ----------
    law, gamma : the law and its amplitude
    nodes : in a cycle
    strobes : (δ, Y) in units of the law, shape (period, 2)

    Raises
    ------
    Refused
        if there is none nearby
    """
    motion, last = Motion(law, gamma, nodes), math.inf
    found, ends = motion.pieces(motion.launch(strobes))
    inverse = inverse_of(found.slope)
    for _ in range(CORRECTIONS):
        step = (inverse @ (ends - np.roll(found.states, -1, axis=0)).ravel()).reshape(ends.shape)
        size = np.abs(step).max()
        if not size < FARTHEST:
            break
        if not size < 0.5 * last or size < CLOSE:
            return found
        last = size
        found, ends = motion.pieces(found.states - step)
    raise Refused("Newton's iteration finds nothing nearby")
