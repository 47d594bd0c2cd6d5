"""The equations of a periodic orbit, by multiple shooting.

The orbit is cut at phases that divide each excitation cycle evenly. The unknowns are the states (δ, Y) at these nodes,
and the equations say that each state leads to the next one. One linear system couples the errors of all pieces. Errors
are not carried from piece to piece, because each oscillation of the contact would enlarge them.
"""

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from .law import Accuracy, Law, System
from .motion import Arrival, follow
from .newton import Approximation, Equations, approximate_inverse

# Nodes in an excitation cycle, in which the contact of a riding part oscillates about five times.
NODES = 8


class Shooting(NamedTuple):
    """The orbits of `period` excitation cycles, cut at NODES phases of each cycle."""

    law: Law
    accuracy: Accuracy
    period: int

    @property
    def count(self) -> int:
        """Number of nodes of an orbit."""
        return self.period * NODES

    @property
    def least(self) -> float:
        """Least radius of a box, well above the error of one piece of the motion."""
        return 16.0 * self.accuracy.tolerance


def follow_to_next_node(system: System, node: int, delta: arb, y: arb, columns: int) -> Arrival:
    """The motion from one node to the next one."""
    turn = 2 * arb.pi() / NODES
    begin = system.law.phase + turn * (node % NODES)
    return follow(system, begin, begin + turn, delta, y, columns)


def residual(states: list[arb], arrivals: list[Arrival]) -> arb_mat:
    """How far each motion misses the next node, shape (2 count, 1); states: δ and Y of the first node, the second, …"""
    reached = arb_mat([[value] for arrival in arrivals for value in (arrival.delta, arrival.y)])
    return reached - arb_mat([[value] for value in states[2:] + states[:2]])


def residual_slope(arrivals: list[Arrival]) -> arb_mat:
    """Derivative of the residual by the states, shape (2 count, 2 count)."""
    size = 2 * len(arrivals)
    rows = [[arb(0)] * size for _ in range(size)]
    for row, entries in enumerate(rows):
        matrix, first = arrivals[row // 2].matrix, row - row % 2
        entries[first] += matrix[row % 2, 0]
        entries[first + 1] += matrix[row % 2, 1]
        entries[(row + 2) % size] -= 1
    return arb_mat(rows)


def launch(shooting: Shooting, gamma: arb, strobes: np.ndarray) -> Approximation:
    """States of all nodes from approximate states at the beginnings of the cycles, shape (period, 2)."""
    system = System(shooting.law, gamma, shooting.accuracy)
    states, arrivals = [], []
    for strobe in strobes:
        state = [arb(float(value)) for value in strobe]
        for node in range(NODES):
            arrivals.append(follow_to_next_node(system, node, *state, columns=2))
            states += state
            state = [arrivals[-1].delta.mid(), arrivals[-1].y.mid()]
    centre = arb_mat([[value] for value in states])
    return Approximation(centre, residual(states, arrivals), approximate_inverse(residual_slope(arrivals)))


def follow_all(system: System, states: list[arb], columns: int) -> list[Arrival]:
    """The motions from all nodes to the next ones; states: as for `residual`."""
    return [
        follow_to_next_node(system, node, *state, columns)
        for node, state in enumerate(zip(states[::2], states[1::2], strict=True))
    ]


def equations_at(shooting: Shooting, gamma: arb) -> Equations:
    """Equations for (δ, Y) of all nodes at the amplitudes of a ball; their evidence is the arrivals at all nodes."""
    system = System(shooting.law, gamma, shooting.accuracy)

    def evaluate(states: arb_mat, derivative: bool) -> tuple[arb_mat, arb_mat | None, list[Arrival]]:
        arrivals = follow_all(system, states.entries(), 2 if derivative else 0)
        value = residual(states.entries(), arrivals)
        return value, residual_slope(arrivals) if derivative else None, arrivals

    return evaluate


def equations_on_arc(shooting: Shooting, origin: arb_mat, direction: arb_mat, place: arb) -> Equations:
    """Equations for (δ, Y) of all nodes and γ, at the places of a ball along an arc of a branch.

    The place is the component of (unknowns - `origin`) along `direction`; it is regular at folds.

    Parameters
    ----------
    origin, direction : exact, shapes (2 count + 1, 1) and (1, 2 count + 1)
    place : the place
    """

    def evaluate(unknown: arb_mat, derivative: bool) -> tuple[arb_mat, arb_mat | None, list[Arrival]]:
        *states, gamma = unknown.entries()
        system = System(shooting.law, gamma, shooting.accuracy)
        arrivals = follow_all(system, states, 3 if derivative else 0)
        last = (direction * (unknown - origin))[0, 0] - place
        value = arb_mat([*residual(states, arrivals).tolist(), [last]])
        if not derivative:
            return value, None, arrivals
        by_gamma = [arrival.matrix[i, 2] for arrival in arrivals for i in range(2)]
        rows = [[*row, drift] for row, drift in zip(residual_slope(arrivals).tolist(), by_gamma, strict=True)]
        return value, arb_mat([*rows, direction.entries()]), arrivals

    return evaluate
