"""Candidates for enclosures of the Taylor coefficients of a contact step, in compiled double-double arithmetic.

Nothing is proved here: `taylor` proves the enclosures with one evaluation in balls. Without candidates it would need an
evaluation for each order, and all proofs together would take 3.1 times as long. A number is a midpoint and a radius;
the midpoint is the unevaluated sum of two floats, which has about 30 digits (Dekker 1971).
"""

import numpy as np
from flint import arb

from ..solver.jit import compiled, compiled_inline, fma

# Components of a step; the columns of perturbations follow, two components each.
W, Y, COSINE, SINE, PHASE, MOTION = range(6)
# Parts of a number: the midpoint is HIGH + LOW.
HIGH, LOW, RADIUS = range(3)
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
def add(a, b):
    """a + b of two numbers (high, low, radius)."""
    high, low = two_sum(a[HIGH], b[HIGH])
    return high, low + a[LOW] + b[LOW], a[RADIUS] + b[RADIUS]


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
def enclose_series(series, twice_exponent, gamma, damping, stiffness, softening, bits):
    """Fill in the coefficients from order 1 on, for the rates that `taylor.rates` states.

    Parameters
    ----------
    series : float64, shape (5 + 2 columns, 3, order + 1): motion and perturbations, their coefficients of order 0 given
    twice_exponent : 2p
    gamma, damping, stiffness, softening : γ, -β, -κ and -p κ, as from `parts_of`
    bits : of the arithmetic in which the coefficients are proved
    """
    rounding = max(ROUNDING, 2.0 ** (SPARE_BITS - bits))
    length = series.shape[2]
    w, y, cosine, sine = series[W], series[Y], series[COSINE], series[SINE]
    square, driven = np.zeros((3, length)), np.zeros((3, length))
    # w³ … w^(2p-1), one after the other.
    powers = np.zeros((max(twice_exponent - 3, 0), 3, length))
    drifts = np.zeros((series.shape[0], 3, length))
    for n in range(length - 1):
        set_coefficient(square, n, convolve(w, w, n, rounding), rounding)
        set_coefficient(driven, n, convolve(w, cosine, n, rounding), rounding)
        stiff = w if twice_exponent == 2 else square
        for k in range(len(powers)):
            set_coefficient(powers[k], n, convolve(stiff, w, n, rounding), rounding)
            stiff = powers[k]
        push = add(coefficient(w, n), multiply(coefficient(driven, n), gamma, rounding))
        spring = multiply(convolve(stiff, square, n, rounding), stiffness, rounding)
        integrate(y, n, add(push, spring), rounding)
        turned = convolve(w, sine, n, rounding)
        integrate(cosine, n, (-turned[HIGH], -turned[LOW], turned[RADIUS]), rounding)
        integrate(sine, n, coefficient(driven, n), rounding)
        integrate(series[PHASE], n, coefficient(w, n), rounding)
        for row in range(MOTION, len(series), 2):
            eta, zeta, drift = series[row], series[row + 1], drifts[row]
            damped = multiply(coefficient(eta, n), damping, rounding)
            set_coefficient(drift, n, add(coefficient(zeta, n), damped), rounding)
            pull = multiply(convolve(stiff, eta, n, rounding), softening, rounding)
            integrate(eta, n, convolve(w, drift, n, rounding), rounding)
            integrate(zeta, n, add(pull, coefficient(driven, n)) if row == MOTION + 4 else pull, rounding)
        twice = add(coefficient(y, n), multiply(coefficient(square, n), damping, rounding))
        integrate(w, n, (0.5 * twice[HIGH], 0.5 * twice[LOW], 0.5 * twice[RADIUS]), rounding)
