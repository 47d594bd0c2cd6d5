"""Flight: gap and rate in closed form, and their derivatives.

Relative to the plate, whose height is γ z(φ) in units of the law, with τ = φ - θ after a take-off at the phase θ,

    q = q0 + u0 τ - τ²/2 - γ (z(φ) - z(θ) - z'(θ) τ),   u = q' = u0 - τ - γ (z'(φ) - z'(θ)).
"""

from typing import NamedTuple

from flint import arb, arb_mat

from ..solver.plate import height, rise
from .law import PLATE


class Flight(NamedTuple):
    """A flight from the phase θ with the gap q0 and its rate u0; all may be wide."""

    phase: arb
    gap0: arb
    rate0: arb
    gamma: arb

    def swing(self, lapse: arb) -> tuple[arb, arb]:
        """z(φ) - z(θ) - z'(θ) τ and z'(φ) - z'(θ) after the phase τ = `lapse`."""
        begin, end = self.phase.sin_cos(), (self.phase + lapse).sin_cos()
        rate = rise(PLATE, *begin)
        return height(PLATE, *end) - height(PLATE, *begin) - rate * lapse, rise(PLATE, *end) - rate

    def gap(self, lapse: arb) -> arb:
        """q after the phase `lapse`."""
        return self.gap0 + (self.rate0 - lapse / 2) * lapse - self.gamma * self.swing(lapse)[0]

    def rate(self, lapse: arb) -> arb:
        """u after the phase `lapse`."""
        return self.rate0 - lapse - self.gamma * self.swing(lapse)[1]

    def carry(self, matrix: arb_mat, lapse: arb) -> arb_mat:
        """Perturbations of (δ, Y) at fixed time after the phase `lapse`, from those at take-off.

        In flight δ = -q and Y = δ': ζ stays and η grows by τ ζ. A third column is the derivative by γ.
        """
        if matrix.ncols() == 0:
            return matrix
        free = arb_mat([[1, lapse], [0, 1]]) * matrix
        if matrix.ncols() == 3:
            swing, turn = self.swing(lapse)
            free[0, 2] += swing
            free[1, 2] += turn
        return free
