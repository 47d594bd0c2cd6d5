"""Candidates for enclosures of the Taylor coefficients of a contact step, in compiled double-double arithmetic.

Nothing is proved here: `taylor` proves the enclosures with one evaluation in balls. Without candidates it would need an
evaluation for each order, and all proofs together would take 3.1 times as long. A number is a midpoint and a radius;
the midpoint is the unevaluated sum of two floats, which has about 30 digits (Dekker 1971).
"""

from collections.abc import Callable, Sequence

import numpy as np
from flint import arb, ctx

from ..solver.jit import compiled, compiled_inline, fma

# Parts of a number: the midpoint is HIGH + LOW.
HIGH, LOW, RADIUS = range(3)
# Operations on two series, or on a series and a constant.
PRODUCT, SUM, DIFFERENCE, MULTIPLE = range(4)
# Relative rounding error of a product in double-double arithmetic. In an arithmetic of `bits` bits it is taken to be
# 2^(SPARE_BITS - bits). Radii are enlarged by the factor WIDER, because they have rounding errors, too.
ROUNDING, SPARE_BITS, WIDER = 1e-30, 4, 1.0 + 1e-6


def parts_of(ball: arb) -> tuple[float, float, float]:
    """Both floats of the midpoint of a ball and its radius, rounded to nearest."""
    midpoint = ball.mid()
    high = float(midpoint)
    return high, float(midpoint - high), float(ball.rad())


@compiled_inline
def two_sum(a, b):
    """a + b, and the error of this sum (Knuth)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


@compiled_inline
def two_product(a, b):
    """a b, and the error of this product."""
    product = a * b
    return product, fma(a, b, -product)


@compiled_inline
def add(a, b, sign):
    """a + b or, if the sign is -1, a - b of two numbers (high, low, radius)."""
    high, low = two_sum(a[HIGH], sign * b[HIGH])
    return high, low + a[LOW] + sign * b[LOW], a[RADIUS] + b[RADIUS]


@compiled_inline
def multiply(a, b, rounding):
    """a b of two numbers; `rounding` is the relative rounding error that the radius includes."""
    high, low = two_product(a[HIGH], b[HIGH])
    radius = abs(a[HIGH]) * b[RADIUS] + a[RADIUS] * (abs(b[HIGH]) + b[RADIUS])
    return high, low + a[HIGH] * b[LOW] + a[LOW] * b[HIGH], radius + rounding * abs(high)


@compiled_inline
def coefficient(series, n):
    """The coefficient of order n as a number (high, low, radius)."""
    return series[HIGH, n], series[LOW, n], series[RADIUS, n]


@compiled_inline
def set_coefficient(series, n, value, rounding):
    """Set the coefficient of order n, with a radius that includes a relative error `rounding`."""
    series[HIGH, n], series[LOW, n] = two_sum(value[HIGH], value[LOW])
    series[RADIUS, n] = WIDER * (value[RADIUS] + rounding * abs(value[HIGH]))


@compiled_inline
def integrate(series, n, rate, rounding):
    """Set the coefficient of order n + 1 from the coefficient of order n of the derivative, `rate`."""
    count = n + 1.0
    high = rate[HIGH] / count
    back, lost = two_product(high, count)
    low = ((rate[HIGH] - back) - lost + rate[LOW]) / count
    set_coefficient(series, n + 1, (high, low, rate[RADIUS] / count), rounding)


@compiled_inline
def convolve(a, b, n, rounding):
    """The coefficient of order n of the product of two series."""
    high = low = radius = size = 0.0
    for k in range(n + 1):
        one, other = a[HIGH, k], b[HIGH, n - k]
        product, error = two_product(one, other)
        high, lost = two_sum(high, product)
        low += error + lost + one * b[LOW, n - k] + a[LOW, k] * other
        radius += abs(one) * b[RADIUS, n - k] + a[RADIUS, k] * (abs(other) + b[RADIUS, n - k])
        size += abs(product)
    return high, low, radius + rounding * size


@compiled
def fill_in(series, operations, constants, rates, bits):
    """Fill in the coefficients from order 1 on.

    Parameters
    ----------
    series : float64, shape (components + operations, 3, order + 1), the components' coefficients of order 0 given
    operations : their kinds, and the places of their operands among the series or constants, shape (operations, 3)
    constants : as from `parts_of`
    rates : places of the components' derivatives
    bits : of the arithmetic in which the coefficients are proved
    """
    rounding = max(ROUNDING, 2.0 ** (SPARE_BITS - bits))
    for n in range(series.shape[2] - 1):
        for k in range(len(operations)):
            kind, a, b = operations[k]
            if kind == PRODUCT:
                value = convolve(series[a], series[b], n, rounding)
            elif kind == MULTIPLE:
                value = multiply(coefficient(series[a], n), constants[b], rounding)
            else:
                sign = 1.0 if kind == SUM else -1.0
                value = add(coefficient(series[a], n), coefficient(series[b], n), sign)
            set_coefficient(series[len(rates) + k], n, value, rounding)
        for k in range(len(rates)):
            integrate(series[k], n, coefficient(series[rates[k]], n), rounding)


class Recorded:
    """A series in a formula. Its operations are recorded, so that compiled code can repeat them for each order."""

    def __init__(self, place: int, rows: list, constants: list):
        self.place, self.rows, self.constants = place, rows, constants

    def record(self, kind: int, other: int) -> "Recorded":
        """The result of an operation with the series or constant at another place."""
        self.rows.append((kind, self.place, other))
        return Recorded(len(self.rows) - 1, self.rows, self.constants)

    def __add__(self, other: "Recorded") -> "Recorded":
        return self.record(SUM, other.place)

    def __sub__(self, other: "Recorded") -> "Recorded":
        return self.record(DIFFERENCE, other.place)

    def __mul__(self, other: "Recorded | arb") -> "Recorded":
        if isinstance(other, Recorded):
            return self.record(PRODUCT, other.place)
        self.constants.append(parts_of(other))
        return self.record(MULTIPLE, len(self.constants) - 1)


def enclose_series(rates: Callable[[Sequence], Sequence], initial: Sequence[arb], order: int) -> np.ndarray:
    """Candidates for the series of the solutions of x' = rates(x) from all points of `initial`.

    Returns float64, shape (components, 3, order + 1); the rates consist of sums, differences and products.
    """
    rows, constants = [None] * len(initial), []
    places = [rate.place for rate in rates([Recorded(k, rows, constants) for k in range(len(initial))])]
    series = np.zeros((len(rows), 3, order + 1))
    series[: len(initial), :, 0] = [parts_of(value) for value in initial]
    fill_in(series, np.array(rows[len(initial) :]), np.array(constants), np.array(places), ctx.prec)
    return series[: len(initial)]
