"""One Taylor step of the contact: polynomials in s, and a proved bound on their remainders.

The equations are polynomial in (w, Y, cos φ, sin φ), and so are the equations of perturbations (η, ζ) of (δ, Y) at
fixed time,

    η' = w (ζ - β η),   ζ' = -p κ w^(2p-1) η,   and for the derivative by γ, ζ' = … + w z̈(φ).

`rates` states them once, for four kinds of arithmetic. `double_double` repeats its operations to compute candidates for
the coefficients. On truncated series it proves them. On bounds of the coefficients it gives the terms above the order.
On norms it gives a bound on the remainder.

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

from ..solver import plate
from .balls import Refused
from .double_double import enclose_series
from .law import PLATE, System

# Components of a step; the columns of perturbations follow, two components each.
W, Y, COSINE, SINE, PHASE, MOTION = range(6)
# Attempts with a bound, each twice as large as the last one, and with a step, each half as long.
DOUBLINGS, HALVINGS = 4, 20
# Factor for the rounding errors of a sum of three floats.
SLACK = 1.0 + 1e-15


def rates(system: System, x: Sequence, columns: int) -> list:
    """Derivatives by s of (w, Y, cos φ, sin φ, φ) and of `columns` perturbations, in any arithmetic with + - and *.

    The third perturbation, if there is one, is the derivative by γ.
    """
    law, gamma, _ = system
    w, y, cosine, sine = x[:PHASE]
    square, lift_w = w * w, w * plate.lift_share(PLATE, sine, cosine)
    stiff = w if law.twice_exponent == 2 else square  # w^(2p-1)
    for _ in range(law.twice_exponent - 3):
        stiff = stiff * w
    derivatives = [
        (y - square * law.beta) * arb(0.5),
        w + lift_w * gamma - stiff * square * law.kappa,
        w * sine * arb(-1),
        w * cosine,
        w,
    ]
    softening = law.kappa * law.twice_exponent / -2
    for column in range(columns):
        eta, zeta = x[MOTION + 2 * column : MOTION + 2 * column + 2]
        pull = stiff * eta * softening
        derivatives += [w * (zeta - eta * law.beta), pull + lift_w if column == 2 else pull]
    return derivatives


def bound_system(system: System) -> System:
    """Exact bounds on the numbers of a system, with signs such that `rates` subtracts nothing.

    The rates of bounds on ‖f‖ then bound ‖rates(f)‖ (for cos φ with a minus), and their growth from ‖f‖ to ‖f‖ + ‖e‖
    bounds ‖rates(f + e) - rates(f)‖, because Σ |(f + e)^k - f^k| ≤ (‖f‖ + ‖e‖)^k - ‖f‖^k for every product.
    """
    law, gamma, accuracy = system
    bounded = law._replace(beta=-law.beta.abs_upper(), kappa=-law.kappa.abs_upper())
    return System(bounded, gamma.abs_upper(), accuracy)


class Step(NamedTuple):
    """A step of length h: polynomials, and bounds on their remainders on [-h, h]."""

    length: arb
    parts: list[arb_poly]
    remainders: list[arb]

    def value(self, component: int, s: arb) -> arb:
        """A component over a ball of s within the step."""
        return self.parts[component](s) + arb(0, self.remainders[component])

    def carry(self, matrix: arb_mat, s: arb) -> arb_mat:
        """Perturbations of (δ, Y) at s from those at the beginning of the step: linear, plus what γ adds."""
        columns = [[self.value(i, s), self.value(i + 1, s)] for i in range(MOTION, len(self.parts), 2)]
        if not columns:
            return matrix
        moved = arb_mat([list(row) for row in zip(*columns[:2], strict=True)]) * matrix
        if len(columns) == 3:
            moved[0, 2] += columns[2][0]
            moved[1, 2] += columns[2][1]
        return moved


def expand(system: System, initial: Sequence[arb], columns: int) -> tuple[list[arb_poly], np.ndarray]:
    """The exact series of the solutions from all points of `initial`, in balls.

    Picard's operator T(x) = x0 + ∫ rates(x) ds is applied once to the candidates from `double_double`. If they contain
    the result, they contain the exact coefficients: the first coefficient is given, and the coefficient of order n + 1
    of T follows from the coefficients up to order n. The result then contains the exact coefficients, too. ValueError
    if the context (see balls.precision) truncates series before this order, which would make the remainder wrong.
    Refused if the candidates do not contain the result.

    Returns
    -------
    series, and bounds on the moduli of their coefficients, float64, shape (components, order + 1)
    """
    order = system.accuracy.order
    if ctx.cap <= order:
        raise ValueError(f"series of order {order} in a context for {ctx.cap - 1}")
    rows = enclose_series(lambda x: rates(system, x, columns), initial, order)
    sizes = SLACK * np.abs(rows).sum(axis=1)
    candidates = [
        arb_series([value, *high[1:]]) + arb_series([0, *low[1:]]) + arb_series([0, *radius[1:]]) * arb(0, 1)
        for value, (high, low, radius) in zip(initial, rows.tolist(), strict=True)
    ]
    proved = []
    for value, series, rate in zip(initial, candidates, rates(system, candidates, columns), strict=True):
        image = [value, *rate.integral().coeffs()[1 : order + 1]]
        if not all(map(arb.contains, series.coeffs(), image)):
            raise Refused("the series of a step is not proved")
        proved.append(arb_poly(image))
    return proved, sizes


def choose_length(sizes: np.ndarray, tolerance: float) -> arb:
    """A length, exact, at which the last terms of w and Y are about `tolerance`; nothing is proved here."""
    length, order = 1.0, sizes.shape[1] - 1
    for size in sizes[:COSINE]:
        for n in (order - 1, order):
            if size[n] > 0.0:
                length = min(length, (tolerance / size[n]) ** (1.0 / n))
    return arb(length)


def bound_remainders(
    bounds: System, sizes: np.ndarray, rate_bounds: Sequence[arb_poly], length: arb
) -> list[arb] | None:
    """Bounds on the remainders of series on [-length, length], or None if the search gives none.

    Parameters
    ----------
    bounds : as from `bound_system`
    sizes : bounds on the coefficients of the series, shape (components, order + 1)
    rate_bounds : the rates of polynomials with these coefficients
    length : exact
    """
    columns, order = (len(sizes) - MOTION) // 2, sizes.shape[1] - 1
    # The integral of a term of order n is length/(n + 1) of it.
    gain = length ** (order + 1) / (order + 1)
    defects = [gain * abs(rate.right_shift(order)(length)) for rate in rate_bounds]
    norms = [arb_poly(row)(length) for row in sizes.tolist()]
    before = rates(bounds, norms, columns)
    gain = length / (order + 2)
    radii = [2 * defect for defect in defects]
    for _ in range(DOUBLINGS):
        after = rates(bounds, [norm + radius for norm, radius in zip(norms, radii, strict=True)], columns)
        reached = [
            (defect + gain * abs(new - old)).upper() for defect, new, old in zip(defects, after, before, strict=True)
        ]
        if all(new <= old for new, old in zip(reached, radii, strict=True)):
            return reached
        radii = [2 * radius for radius in reached]
    return None


def make_step(system: System, initial: Sequence[arb], columns: int) -> Step:
    """A step of the contact with proved remainders.

    Refused if the remainder has a bound for none of the lengths that are tried.

    Parameters
    ----------
    system : the motion at an amplitude, and the accuracy of its steps
    initial : w, Y and φ; the step holds for all points of these balls
    columns : 0; 2 for the derivative by (δ, Y); 3 for the derivative by γ too
    """
    w, y, phase = initial
    sine, cosine = phase.sin_cos()
    identity = [arb(1), arb(0), arb(0), arb(1), arb(0), arb(0)][: 2 * columns]
    parts, sizes = expand(system, [w, y, cosine, sine, phase, *identity], columns)
    bounds = bound_system(system)
    rate_bounds = rates(bounds, [arb_poly(row) for row in sizes.tolist()], columns)
    # Bounds on the terms of a product are up to twice as large as the terms.
    length = choose_length(sizes, 0.5 * system.accuracy.tolerance)
    for _ in range(HALVINGS):
        remainders = bound_remainders(bounds, sizes, rate_bounds, length)
        if remainders is not None:
            return Step(length, parts, remainders)
        length = length / 2
    raise Refused("no step of the contact has a bounded remainder")
