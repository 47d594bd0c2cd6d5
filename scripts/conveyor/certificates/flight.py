"""Flight: gap and rate in closed form, and their derivatives.

Relative to the plate q'' = -1 - γ cos φ, so that with τ = φ - θ after a take-off at the phase θ

    q = q0 + (u0 + γ sin θ) τ - τ²/2 + γ (cos φ - cos θ),   u = q' = u0 - τ - γ (sin φ - sin θ).
"""

from typing import NamedTuple

from flint import arb, arb_mat


class Flight(NamedTuple):
    """A flight from the phase θ with the gap q0 and its rate u0; all may be wide."""

    phase: arb
    gap0: arb
    rate0: arb
    gamma: arb

    def gap(self, lapse: arb) -> arb:
        """q after the phase `lapse`."""
        sine, cosine = self.phase.sin_cos()
        swing = self.gamma * ((self.phase + lapse).cos() - cosine + sine * lapse)
        return self.gap0 + (self.rate0 - lapse / 2) * lapse + swing

    def rate(self, lapse: arb) -> arb:
        """u after the phase `lapse`."""
        return self.rate0 - lapse - self.gamma * ((self.phase + lapse).sin() - self.phase.sin())

    def carry(self, matrix: arb_mat, lapse: arb) -> arb_mat:
        """Perturbations of (δ, Y) at fixed time after the phase `lapse`, from those at take-off.

        In flight δ = -q and Y = δ', so that δ'' = 1 + γ cos φ: ζ stays and η grows by τ ζ. A third column belongs to
        γ: ζ' = cos φ and η' = ζ.
        """
        if matrix.ncols() == 0:
            return matrix
        free = arb_mat([[1, lapse], [0, 1]]) * matrix
        if matrix.ncols() == 3:
            sine, cosine = self.phase.sin_cos()
            end = self.phase + lapse
            free[0, 2] += cosine - end.cos() - sine * lapse
            free[1, 2] += end.sin() - sine
        return free
