"""A periodic orbit: existence and uniqueness, least period, multipliers and stability."""

from functools import reduce
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from .. import linear_algebra
from .balls import Refused, bounds
from .motion import Arrival, Impact
from .newton import Zero, correct, exact, midpoints, prove_zero
from .shooting import NODES, Shooting, equations_at, launch


class ProvedOrbit(NamedTuple):
    """A box that contains exactly one orbit for each amplitude of a ball."""

    shooting: Shooting
    zero: Zero
    trace: arb  # of the derivative of (δ, Y) over a period
    determinant: arb  # product of the multipliers, from the duration of contact
    contact: arb  # phase in contact in a period

    def strobe(self, cycle: int) -> tuple[arb, arb]:
        """(δ, Y) at the beginning of a cycle of the period, in units of the law."""
        row = 2 * NODES * cycle
        return self.zero.enclosure[row, 0], self.zero.enclosure[row + 1, 0]

    @property
    def duration(self) -> arb:
        """The period as a phase, rad."""
        return 2 * arb.pi() * self.shooting.period

    @property
    def half_width(self) -> float:
        """The largest half-width of the enclosure of a state at any node, in units of the law."""
        return max(bounds(value.rad())[1] for value in self.zero.enclosure.entries())

    @property
    def impacts(self) -> list[Impact]:
        """All impacts in the order of time from the first strobe on."""
        return [impact for arrival in self.zero.evidence for impact in arrival.impacts]

    @property
    def fold_test(self) -> arb:
        """(1 - μ1)(1 - μ2)."""
        return 1 - self.trace + self.determinant

    @property
    def doubling_test(self) -> arb:
        """(1 + μ1)(1 + μ2)."""
        return 1 + self.trace + self.determinant

    @property
    def stability(self) -> str:
        """Proved from Jury's conditions: "stable" if both multipliers are inside the unit circle, "unstable" if one is
        outside, else "open".

        Let p(μ) = μ² - trace μ + det be the characteristic polynomial. Both multipliers are inside if and only if
        det < 1 and p(±1) > 0. If p(1) < 0 or p(-1) < 0, a real multiplier lies beyond +1 or -1. det < 1 holds for every
        orbit with contact.
        """
        if self.fold_test > 0 and self.doubling_test > 0 and self.determinant < 1:
            return "stable"
        if self.fold_test < 0 or self.doubling_test < 0:
            return "unstable"
        return "open"

    def multipliers(self) -> list[tuple[arb, arb]]:
        """Real and imaginary parts of both multipliers, the larger modulus first.

        Refused if the proof does not show whether they are real, or which one has the larger modulus.
        """
        half = self.trace / 2
        square = half * half - self.determinant
        if square < 0:
            root = (-square).sqrt()
            return [(half, root), (half, -root)]
        if not square > 0 or half.contains(0):
            raise Refused("open whether the multipliers are real, or which one is larger")
        # The root that does not cancel; the other one follows from the product.
        first = half + square.sqrt() if half > 0 else half - square.sqrt()
        return [(first, arb(0)), (self.determinant / first, arb(0))]


def rotation(direction: np.ndarray) -> arb_mat:
    """The rotation, in floating point, that turns the first axis into a direction, shape (2,)."""
    x, y = direction / linear_algebra.length(direction)
    return exact(np.array([[x, -y], [y, x]]))


def linearise(shooting: Shooting, arrivals: list[Arrival]) -> tuple[arb, arb, arb]:
    """Trace and determinant of the derivative P over a period, and the duration of contact as a phase.

    Q⁻¹ P Q has the trace of P for any Q. With the rotation onto the first column of the product at each node, the
    factors of P are nearly triangular, and the trace is as narrow as the diagonal. The divergence of the flow is -β in
    contact, which gives the determinant (Liouville). It is narrower than the determinant of the product, and must
    agree with it.
    """
    matrices = [arb_mat([[arrival.matrix[i, j] for j in range(2)] for i in range(2)]) for arrival in arrivals]
    whole = reduce(lambda product, matrix: linear_algebra.product(midpoints(matrix), product), matrices, np.eye(2))
    base = frame = rotation(linear_algebra.eigenvector(whole, linear_algebra.eigenvalues(whole)[0]).real)
    product = arb_mat([[1, 0], [0, 1]])
    for matrix in matrices:
        following = base if matrix is matrices[-1] else rotation(midpoints(matrix * frame)[:, 0])
        product = following.inv() * matrix * frame * product
        frame = following
    contact = sum((arrival.contact for arrival in arrivals), arb(0))
    determinant = (-shooting.law.beta * contact).exp()
    if not determinant.overlaps(product.det()):
        raise Refused("the determinant contradicts the time in contact")
    return product.trace(), determinant, contact


def prove_orbit(shooting: Shooting, gamma: arb, strobes: np.ndarray) -> ProvedOrbit:
    """The orbit near approximate states at the beginnings of its cycles.

    Parameters
    ----------
    shooting : period and accuracy
    gamma : amplitudes, a ball; there is an orbit for each of them
    strobes : (δ, Y) in units of the law, shape (period, 2)
    """
    equations = equations_at(shooting, gamma)
    near = correct(equations, launch(shooting, gamma, strobes), shooting.least)
    zero = prove_zero(equations, near, shooting.least)
    orbit = ProvedOrbit(shooting, zero, *linearise(shooting, zero.evidence))
    check_period(orbit)
    return orbit


def check_period(orbit: ProvedOrbit) -> None:
    """Prove that the period n is the least period.

    The least period divides n. If it were smaller, n/p would be a period for some prime p, and states n/p cycles apart
    would be equal. Refused if the orbit may repeat itself earlier.
    """
    period = orbit.shooting.period
    for prime in range(2, period + 1):
        if period % prime == 0 and all(prime % factor for factor in range(2, prime)):
            first, later = orbit.strobe(0), orbit.strobe(period // prime)
            if all(a.overlaps(b) for a, b in zip(first, later, strict=True)):
                raise Refused(f"its period may be {period // prime} instead of {period} cycles")


def check_near(orbit: ProvedOrbit, strobes: np.ndarray, closeness: float) -> float:
    """The distance between the orbit and approximate states at the beginnings of its cycles, in units of the law.

    Refused if it is larger than `closeness`: the proof is for another orbit.
    """
    enclosed = np.array([[float(value) for value in orbit.strobe(cycle)] for cycle in range(orbit.shooting.period)])
    distance = float(np.abs(enclosed - strobes).max())
    if not distance <= closeness:
        raise Refused(f"the orbit that is proved lies {distance:.1e} away, in g/ω² and g/ω: it is another one")
    return distance
