"""Balls for the Taylor coefficients of a contact step, in compiled arithmetic: a suggestion, which `taylor` proves.

A number is a centre as the sum of two floats, with some 30 digits (Dekker 1971), and a radius.
"""

import numpy as np
from flint import arb

from ..solver.jit import inlined, kernel

# Rows of a step; those of perturbations follow, two for each column.
W, Y, COSINE, SINE, PHASE, MOTION = range(6)
CENTRE, REST, RADIUS = range(3)
# What radii allow for: the rounding of a product here, relative to the sizes of its terms, that in balls of some bits
# with a few bits to spare, and that of radii.
ROUNDING, SPARE, WIDER = 1e-30, 4, 1.0 + 1e-6
SPLIT = 134217729.0  # 2^27 + 1


def parts_of(ball: arb) -> tuple[float, float, float]:
    """Both floats of the centre and the radius, about."""
    centre = ball.mid()
    first = float(centre)
    return first, float(centre - first), float(ball.rad())


@inlined
def two_sum(a, b):
    """a + b, and what rounding took from it."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


@inlined
def two_product(a, b):
    """a b, and what rounding took from it."""
    product = a * b
    wide_a, wide_b = SPLIT * a, SPLIT * b
    high_a, high_b = wide_a - (wide_a - a), wide_b - (wide_b - b)
    low_a, low_b = a - high_a, b - high_b
    return product, ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b


@inlined
def plus(a, b):
    first, rest = two_sum(a[CENTRE], b[CENTRE])
    return first, rest + a[REST] + b[REST], a[RADIUS] + b[RADIUS]


@inlined
def times(a, b, rounding):
    first, rest = two_product(a[CENTRE], b[CENTRE])
    radius = abs(a[CENTRE]) * b[RADIUS] + a[RADIUS] * (abs(b[CENTRE]) + b[RADIUS])
    return first, rest + a[CENTRE] * b[REST] + a[REST] * b[CENTRE], radius + rounding * abs(first)


@inlined
def term(row, n):
    return row[CENTRE, n], row[REST, n], row[RADIUS, n]


@inlined
def put(row, n, value, rounding):
    row[CENTRE, n], row[REST, n] = two_sum(value[CENTRE], value[REST])
    row[RADIUS, n] = WIDER * (value[RADIUS] + rounding * abs(value[CENTRE]))


@inlined
def put_integral(row, n, rate, rounding):
    """The term of order n + 1 from that of order n of the rate."""
    count = n + 1.0
    first = rate[CENTRE] / count
    back, lost = two_product(first, count)
    rest = ((rate[CENTRE] - back) - lost + rate[REST]) / count
    put(row, n + 1, (first, rest, rate[RADIUS] / count), rounding)


@inlined
def product(a, b, n, rounding):
    """The term of order n of the product of two rows."""
    first = rest = radius = size = 0.0
    for k in range(n + 1):
        one, other = a[CENTRE, k], b[CENTRE, n - k]
        whole, error = two_product(one, other)
        first, lost = two_sum(first, whole)
        rest += error + lost + one * b[REST, n - k] + a[REST, k] * other
        radius += abs(one) * b[RADIUS, n - k] + a[RADIUS, k] * (abs(other) + b[RADIUS, n - k])
        size += abs(whole)
    return first, rest, radius + rounding * size


@kernel
def suggest(rows, twice_exponent, gamma, damping, stiffness, softening, bits):
    """Fill the terms from order 1 on, with the rates that `taylor.rates` writes.

    Parameters
    ----------
    rows : float64, shape (5 + 2 columns, 3, order + 1): motion and perturbations; their terms of order 0 are given
    twice_exponent : 2p
    gamma, damping, stiffness, softening : γ, -β, -κ and -p κ, as from `parts_of`
    bits : of the arithmetic in which the terms are proved
    """
    rounding = max(ROUNDING, 2.0 ** (SPARE - bits))
    length = rows.shape[2]
    w, y, cosine, sine = rows[W], rows[Y], rows[COSINE], rows[SINE]
    square, driven = np.zeros((3, length)), np.zeros((3, length))
    # w³ … w^(2p-1), one after the other.
    powers = np.zeros((max(twice_exponent - 3, 0), 3, length))
    drifts = np.zeros((rows.shape[0], 3, length))
    for n in range(length - 1):
        put(square, n, product(w, w, n, rounding), rounding)
        put(driven, n, product(w, cosine, n, rounding), rounding)
        stiff = w if twice_exponent == 2 else square
        for k in range(len(powers)):
            put(powers[k], n, product(stiff, w, n, rounding), rounding)
            stiff = powers[k]
        push = plus(term(w, n), times(term(driven, n), gamma, rounding))
        spring = times(product(stiff, square, n, rounding), stiffness, rounding)
        put_integral(y, n, plus(push, spring), rounding)
        turned = product(w, sine, n, rounding)
        put_integral(cosine, n, (-turned[CENTRE], -turned[REST], turned[RADIUS]), rounding)
        put_integral(sine, n, term(driven, n), rounding)
        put_integral(rows[PHASE], n, term(w, n), rounding)
        for row in range(MOTION, len(rows), 2):
            eta, zeta, drift = rows[row], rows[row + 1], drifts[row]
            put(drift, n, plus(term(zeta, n), times(term(eta, n), damping, rounding)), rounding)
            pull = times(product(stiff, eta, n, rounding), softening, rounding)
            put_integral(eta, n, product(w, drift, n, rounding), rounding)
            put_integral(zeta, n, plus(pull, term(driven, n)) if row == MOTION + 4 else pull, rounding)
        twice = plus(term(y, n), times(term(square, n), damping, rounding))
        put_integral(w, n, (0.5 * twice[CENTRE], 0.5 * twice[REST], 0.5 * twice[RADIUS]), rounding)
