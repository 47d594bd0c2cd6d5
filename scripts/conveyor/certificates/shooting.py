"""The equations of a periodic orbit, by multiple shooting.

The orbit is cut at phases that divide each excitation cycle evenly. The unknowns are the states (δ, Y) at all of them,
the equations say that each follows from the one before: the errors of one piece are not carried through the others,
where the contact's ringing would blow up their boxes, but are joined by one linear system.
"""

from typing import NamedTuple

from flint import arb, arb_mat

from .law import Law
from .motion import Accuracy, Arrival, follow

# Nodes in an excitation cycle: the contact of a riding part rings about five times in it.
NODES = 8


class Shooting(NamedTuple):
    """The orbits of `period` excitation cycles, cut at `nodes` phases of each."""

    law: Law
    accuracy: Accuracy
    period: int
    nodes: int

    @property
    def count(self) -> int:
        """Number of nodes of an orbit."""
        return self.period * self.nodes

    @property
    def least(self) -> float:
        """Least radius of a box: well above what one piece of the motion adds."""
        return 16.0 * self.accuracy.tolerance

    def arrival(self, gamma: arb, node: int, delta: arb, y: arb, columns: int) -> Arrival:
        """The motion from one node to the next."""
        turn = 2 * arb.pi() / self.nodes
        begin = self.law.phase + turn * (node % self.nodes)
        return follow(self.law, self.accuracy, gamma, begin, begin + turn, delta, y, columns)

    def arrivals(self, gamma: arb, states: arb_mat, columns: int) -> list[Arrival]:
        """The motions from all nodes; states : (δ, Y) of all nodes below each other, shape (2 count, 1)."""
        return [
            self.arrival(gamma, node, states[2 * node, 0], states[2 * node + 1, 0], columns)
            for node in range(self.count)
        ]

    def residual(self, states: arb_mat, arrivals: list[Arrival]) -> arb_mat:
        """By what each motion misses the next node, shape (2 count, 1)."""
        reached = arb_mat([[value] for arrival in arrivals for value in (arrival.delta, arrival.y)])
        wanted = states.entries()
        return reached - arb_mat([[value] for value in wanted[2:] + wanted[:2]])

    def slope(self, arrivals: list[Arrival]) -> arb_mat:
        """Its derivative by the states, shape (2 count, 2 count)."""
        size = 2 * self.count
        rows = [[arb(0)] * size for _ in range(size)]
        for row, entries in enumerate(rows):
            matrix, own = arrivals[row // 2].matrix, row - row % 2
            entries[own] += matrix[row % 2, 0]
            entries[own + 1] += matrix[row % 2, 1]
            entries[(row + 2) % size] -= 1
        return arb_mat(rows)


class AtAmplitude(NamedTuple):
    """Equations for (δ, Y) of all nodes at the amplitudes of a ball."""

    shooting: Shooting
    gamma: arb

    def __call__(self, unknown: arb_mat, derivative: bool) -> tuple[arb_mat, arb_mat | None, list[Arrival]]:
        arrivals = self.shooting.arrivals(self.gamma, unknown, 2 if derivative else 0)
        value = self.shooting.residual(unknown, arrivals)
        return value, self.shooting.slope(arrivals) if derivative else None, arrivals


class OnArc(NamedTuple):
    """Equations for (δ, Y) of all nodes and γ, at the places of a ball along an arc of a branch.

    The place is the component of the unknowns, less `origin`, along `direction`: folds are no obstacle to it.
    """

    shooting: Shooting
    origin: arb_mat  # shape (2 count + 1, 1), exact
    direction: arb_mat  # shape (1, 2 count + 1), exact
    place: arb

    def __call__(self, unknown: arb_mat, derivative: bool) -> tuple[arb_mat, arb_mat | None, list[Arrival]]:
        *entries, gamma = unknown.entries()
        states = arb_mat([[value] for value in entries])
        arrivals = self.shooting.arrivals(gamma, states, 3 if derivative else 0)
        last = (self.direction * (unknown - self.origin))[0, 0] - self.place
        value = arb_mat([*self.shooting.residual(states, arrivals).tolist(), [last]])
        if not derivative:
            return value, None, arrivals
        drift = [arrival.matrix[i, 2] for arrival in arrivals for i in range(2)]
        rows = [[*row, by_gamma] for row, by_gamma in zip(self.shooting.slope(arrivals).tolist(), drift, strict=True)]
        return value, arb_mat([*rows, self.direction.entries()]), arrivals
