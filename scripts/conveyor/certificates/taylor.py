"""One Taylor step of the contact: polynomials in s, and a proved bound on what they leave out.

The equations are polynomial in (w, Y, cos φ, sin φ), and so are those of perturbations (η, ζ) of (δ, Y) at fixed time,

    η' = w (ζ - β η),   ζ' = -p κ w^(2p-1) η,   and for the derivative by γ, ζ' = … + w cos φ.

`rates` writes them once; it is evaluated in three arithmetics, each with one purpose: on truncated series it gives the
coefficients, on bounds of terms what the coefficients leave over, and on norms the bound of the remainder.

The remainder. Let ‖f‖ = Σ |f_n| hⁿ, so that ‖f g‖ ≤ ‖f‖ ‖g‖ and |f(s)| ≤ ‖f‖ for |s| ≤ h. Let x̄ be the exact solution's
series up to order N, and T(x) = x0 + ∫ rates(x) ds. If

    ‖terms of T(x̄) above order N‖ + h/(N+2) ‖rates(x̄ + e) - rates(x̄)‖ ≤ r   for all e of order > N with ‖e‖ ≤ r,

then the solution is x̄ + e with such an e. For Picard's iterates x̄, T(x̄), T(T(x̄)), … all lie in this set (an integral
of terms from order N + 1 on gains at least h/(N+2)), the n-th has the exact coefficients up to order N + n, and a bound
on Σ |f_n| hⁿ survives the limit of the coefficients.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat, arb_poly, arb_series, ctx

from .balls import Refused
from .law import Law

# Components of a step; the columns of perturbations follow, two components each.
W, Y, COSINE, SINE, PHASE = range(5)
MOTION = 5
# How often a bound that does not hold is doubled, and a step that has none is halved.
DOUBLINGS, HALVINGS = 4, 20
# What makes up for the rounding of floats in a bound, and for what vanishes in it.
SLACK, TINY = 1.0 + 1e-9, 1e-300


def rates(law: Law, gamma: arb, x: Sequence, columns: int) -> list:
    """Derivatives by s of (w, Y, cos φ, sin φ, φ) and of `columns` perturbations, in any arithmetic with + - and *.

    The third perturbation, if there is one, is the derivative by γ.
    """
    w, y, cosine, sine = x[:PHASE]
    square, driven = w * w, w * cosine
    stiff = w if law.twice_exponent == 2 else square  # w^(2p-1)
    for _ in range(law.twice_exponent - 3):
        stiff = stiff * w
    found = [
        (y - square * law.beta) * arb(0.5),
        w + driven * gamma - stiff * square * law.kappa,
        w * sine * arb(-1),
        driven,
        w,
    ]
    softening = law.kappa * law.twice_exponent / -2
    for column in range(columns):
        eta, zeta = x[MOTION + 2 * column : MOTION + 2 * column + 2]
        pull = stiff * eta * softening
        found += [w * (zeta - eta * law.beta), pull + driven if column == 2 else pull]
    return found


def size(number: arb) -> float:
    """An upper bound of |number| but for half a unit of the last digit."""
    return float(number.abs_upper())


class Terms:
    """Bounds on the terms |f_n| hⁿ of a polynomial, shape (k,), and on those of sums and products."""

    def __init__(self, bounds: np.ndarray):
        self.bounds = bounds

    def __add__(self, other: "Terms") -> "Terms":
        short, long = sorted((self.bounds, other.bounds), key=len)
        total = long.copy()
        total[: len(short)] += short
        return Terms(total)

    __sub__ = __add__

    def __mul__(self, other: "Terms | arb") -> "Terms":
        if isinstance(other, arb):
            return Terms(self.bounds * size(other))
        return Terms(np.convolve(self.bounds, other.bounds))


class Norm(NamedTuple):
    """Bounds on a polynomial part and on a deviation from it: ‖f‖ and ‖e‖ of f + e."""

    part: float
    deviation: float

    def __add__(self, other: "Norm") -> "Norm":
        return Norm(self.part + other.part, self.deviation + other.deviation)

    __sub__ = __add__

    def __mul__(self, other: "Norm | arb") -> "Norm":
        if isinstance(other, arb):
            factor = size(other)
            return Norm(self.part * factor, self.deviation * factor)
        # (f + e)(g + d) - f g = e (g + d) + f d.
        deviation = self.deviation * (other.part + other.deviation) + self.part * other.deviation
        return Norm(self.part * other.part, deviation)


class Step(NamedTuple):
    """A step of length h: polynomials, and bounds on what they leave out on [-h, h]."""

    length: arb
    parts: list[arb_poly]
    remainders: list[float]

    def value(self, component: int, s: arb) -> arb:
        """A component over a ball of s within the step."""
        return self.parts[component](s) + arb(0, self.remainders[component])

    def speed(self, law: Law, s: arb) -> arb:
        """v = δ' = Y - β w²."""
        w = self.value(W, s)
        return self.value(Y, s) - law.beta * w * w

    def carried(self, matrix: arb_mat, s: arb) -> arb_mat:
        """Perturbations of (δ, Y) at s from those at the beginning of the step: linear, plus what γ adds."""
        columns = [[self.value(i, s), self.value(i + 1, s)] for i in range(MOTION, len(self.parts), 2)]
        if not columns:
            return matrix
        moved = arb_mat([list(row) for row in zip(*columns[:2], strict=True)]) * matrix
        if len(columns) == 3:
            moved[0, 2] += columns[2][0]
            moved[1, 2] += columns[2][1]
        return moved


def expand(law: Law, gamma: arb, start: Sequence[arb], columns: int, order: int) -> list[arb_poly]:
    """The exact series of the solutions from all points of `start`, up to an order, in balls.

    Each of Picard's iterations makes one more coefficient exact, and computes the earlier ones as before.

    Raises
    ------
    ValueError
        where the context (see balls.precision) cuts series off before the order: the remainder would be wrong
    """
    if ctx.cap <= order:
        raise ValueError(f"series of order {order} in a context for {ctx.cap - 1}")
    series = [arb_series([value], prec=1) for value in start]
    constants = [arb_series([value], prec=order + 1) for value in start]
    for _ in range(order):
        series = [c + rate.integral() for c, rate in zip(constants, rates(law, gamma, series, columns), strict=True)]
    return [arb_poly(part.coeffs()) for part in series]


def length_of(sizes: np.ndarray, tolerance: float) -> float:
    """A step whose last terms of w and Y are about `tolerance`; nothing is proved here."""
    length, order = 1.0, sizes.shape[1] - 1
    for part in sizes[:COSINE]:
        for n in (order - 1, order):
            if part[n] > 0.0:
                length = min(length, (tolerance / part[n]) ** (1.0 / n))
    return float(length)


def remainders(law: Law, gamma: arb, sizes: np.ndarray, length: float) -> list[float] | None:
    """Bounds on what series up to an order leave out on [-length, length], or None if none is found.

    All numbers here are floats, none is negative, and none is subtracted: rounded to the nearest, each of some hundred
    operations errs by half a unit of the last digit, which SLACK makes up for, or by the least float, which TINY does.

    sizes : of the coefficients of the series, as from `size`, shape (number of components, order + 1)
    """
    columns, order = (len(sizes) - MOTION) // 2, sizes.shape[1] - 1
    terms = sizes * length ** np.arange(order + 1.0)
    # The integral of the term of order n has the order n + 1.
    defects = [
        length * float((rate.bounds[order:] / np.arange(order + 1.0, len(rate.bounds) + 1.0)).sum())
        for rate in rates(law, gamma, [Terms(row) for row in terms], columns)
    ]
    norms = terms.sum(axis=1).tolist()
    gain = length / (order + 2)
    bound = [2.0 * defect for defect in defects]
    for _ in range(DOUBLINGS):
        changed = rates(law, gamma, [Norm(*pair) for pair in zip(norms, bound, strict=True)], columns)
        reached = [
            SLACK * (defect + gain * rate.deviation) + TINY for defect, rate in zip(defects, changed, strict=True)
        ]
        if all(there <= here for there, here in zip(reached, bound, strict=True)):
            return reached
        bound = [2.0 * there for there in reached]
    return None


def step(law: Law, gamma: arb, start: Sequence[arb], columns: int, order: int, tolerance: float) -> Step:
    """A step of the contact with proved remainders.

    Parameters
    ----------
    law, gamma : the law and its amplitude
    start : w, Y and φ, all points of which are meant
    columns : 0; 2 for the derivative by (δ, Y); 3 for that by γ too
    order, tolerance : of the series, and of its last terms

    Raises
    ------
    Refused
        if no length is found for which the remainder has a bound
    """
    w, y, phase = start
    sine, cosine = phase.sin_cos()
    identity = [arb(1), arb(0), arb(0), arb(1), arb(0), arb(0)][: 2 * columns]
    parts = expand(law, gamma, [w, y, cosine, sine, phase, *identity], columns, order)
    sizes = np.array([[size(part[n]) for n in range(order + 1)] for part in parts])
    # Bounds of a product's terms are up to twice the terms.
    length = length_of(sizes, 0.5 * tolerance)
    for _ in range(HALVINGS):
        found = remainders(law, gamma, sizes, length)
        if found is not None:
            return Step(arb(length), parts, found)
        length = 0.5 * length
    raise Refused("no step of the contact has a bounded remainder")
