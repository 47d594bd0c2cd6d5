"""Taylor polynomials in an array: values, and the first root, proved to be the first one.

An array holds the coefficients of several polynomials, one polynomial after the other. `row` is the place of the first
coefficient of a polynomial, and row + n that of the coefficient of order n. In an array for several trajectories side
by side (lanes), the n-th coefficients of all of them follow each other.
"""

import math

import numpy as np

from .jit import compiled, compiled_inline, fma

# Order of every series, and the number of coefficients in its row, the last ones of which are zero.
ORDER = 16
SIZE = 20

# A search that starts on a root moves on by at least this part of the step, so that it does not find the root again.
LEAVE = 1e-6
# A correction of this relative size ends an iteration that converges quadratically, because the next one is its square.
CLOSE = 1e-9
# Values below this part of the sum of all terms have no reliable sign.
NOISE = 1e-15
MAX_ITERATIONS = 200
# Steps of a search before its piece is cut, and pieces before the search gives up.
MAX_STEPS = 60
MAX_PIECES = 1000

# Answers of a search.
FOUND, ABSENT, OPEN = range(3)
# The place of the first row of an array. It is a NumPy integer, and so are all places counted from it: for a Python
# integer in a call, numba would compile the function once more, for this value alone.
FIRST_ROW = np.int64(0)


@compiled_inline
def place(row, n):
    """The place of coefficient n. It is unsigned: numba would check at each access whether a signed one is negative."""
    return np.uint64(row + n)


@compiled_inline
def value_in_lane(series, row, lanes, s):
    """Σ c_n sⁿ, in four interleaved sums that the processor computes at the same time; row and lanes are unsigned."""
    s2 = s * s
    s4 = s2 * s2
    sum0 = sum1 = sum2 = sum3 = 0.0
    for n in range(SIZE - 4, -1, -4):
        sum0 = fma(sum0, s4, series[row + np.uint64(n) * lanes])
        sum1 = fma(sum1, s4, series[row + np.uint64(n + 1) * lanes])
        sum2 = fma(sum2, s4, series[row + np.uint64(n + 2) * lanes])
        sum3 = fma(sum3, s4, series[row + np.uint64(n + 3) * lanes])
    return (sum0 + s * sum1) + s2 * (sum2 + s * sum3)


@compiled_inline
def value(series, row, s):
    """Σ c_n sⁿ of a polynomial."""
    return value_in_lane(series, np.uint64(row), np.uint64(1), s)


@compiled_inline
def derivatives(series, row, s):
    """Σ c_n sⁿ and its first and second derivatives, each in two sums that the processor computes at the same time."""
    value0 = value1 = slope0 = slope1 = bend0 = bend1 = 0.0
    s2 = s * s
    for n in range(ORDER, -1, -2):
        c0, c1 = series[place(row, n)], series[place(row, n + 1)]
        c2, c3 = series[place(row, n + 2)], series[place(row, n + 3)]
        value0 = fma(value0, s2, c0)
        value1 = fma(value1, s2, c1)
        slope0 = fma(slope0, s2, (n + 1) * c1)
        slope1 = fma(slope1, s2, (n + 2) * c2)
        bend0 = fma(bend0, s2, (n + 1) * (n + 2) * c2)
        bend1 = fma(bend1, s2, (n + 2) * (n + 3) * c3)
    return value0 + s * value1, slope0 + s * slope1, bend0 + s * bend1


@compiled_inline
def root_of_crossing(series, row, low, high):
    """The root of a polynomial that changes its sign once between `low` and `high`, by safeguarded Newton steps."""
    close = CLOSE * max(abs(low), abs(high))
    f_low, f_high = value(series, row, low), value(series, row, high)
    sign = 1.0 if f_high > 0.0 else -1.0
    s = high - f_high * (high - low) / (f_high - f_low) if f_high != f_low else high
    for _ in range(MAX_ITERATIONS):
        f, gradient, _ = derivatives(series, row, s)
        if sign * f > 0.0:
            high = s
        else:
            low = s
        following = s - f / gradient if gradient != 0.0 else low
        if abs(following - s) <= close:
            if abs(following) >= close:
                return min(max(following, low), high)
            close = CLOSE * abs(following)  # near zero the error must be relative to the root
        s = following if low < following < high else 0.5 * (low + high)
    return s


@compiled
def expand_about(series, row, s):
    """The expansion of a polynomial about `s`, as an array of its own."""
    shifted = np.empty(SIZE)
    for n in range(SIZE):
        shifted[place(FIRST_ROW, n)] = series[place(row, n)]
    for k in range(ORDER):
        for n in range(ORDER - 1, k - 1, -1):
            shifted[place(FIRST_ROW, n)] += s * shifted[place(FIRST_ROW, n + 1)]
    return shifted


@compiled
def search(series, row, start, end, shortest, noise):
    """Search for the first root in (start, end].

    The second derivative at s and bounds on the second and third derivatives give a parabola below the polynomial from
    s to `end`. A step to the root of this parabola cannot pass a root of the polynomial, and such steps converge
    quadratically to a simple root. While `shortest` > 0 the search leaves a root on which it began: steps have at least
    this length, and values below `noise` have no sign.

    Returns
    -------
    answer, s, shortest : FOUND with the root; ABSENT with `end`; or OPEN, with the place up to which there is no root,
        if the parabolas are too narrow to go on. `shortest` is what the rest of the search must begin with.
    """
    second = third = 0.0
    power = 1.0
    for n in range(2, ORDER + 1):
        second += n * (n - 1) * abs(series[place(row, n)]) * power
        third += (n + 1) * n * (n - 1) * abs(series[place(row, n + 1)]) * power
        power *= end
    s = start
    f, gradient, bend = series[row], series[row + 1], 2.0 * series[row + 2]
    if s != 0.0:
        f, gradient, bend = derivatives(series, row, s)
    for _ in range(MAX_STEPS):
        f = max(f, 0.0)
        remaining = end - s
        lowest, highest = max(-second, bend - third * remaining), min(second, bend + third * remaining)
        if gradient >= 0.0 and gradient + min(lowest, 0.0) * remaining >= 0.0:
            return ABSENT, end, 0.0
        if gradient + max(highest, 0.0) * remaining < 0.0:
            # The polynomial falls from here on, so that the sign at the end decides.
            low = s + shortest
            if low >= end or value(series, row, end) > (-noise if shortest > 0.0 else 0.0):
                return ABSENT, end, 0.0
            return FOUND, low if value(series, row, low) <= 0.0 else root_of_crossing(series, row, low, end), 0.0
        root = math.sqrt(max(gradient * gradient - 2.0 * lowest * f, 0.0))
        advance = 0.0
        if gradient > 0.0:
            advance = (gradient + root) / -lowest
        elif f > 0.0:
            advance = 2.0 * f / (root - gradient)
        if shortest == 0.0 and advance <= CLOSE * end:
            return FOUND, s + advance, 0.0
        if s + max(advance, shortest) > end:
            return ABSENT, end, shortest
        s += max(advance, shortest)
        f, gradient, bend = derivatives(series, row, s)
        if shortest > 0.0 and abs(f) <= noise:
            shortest *= 2.0
        elif f <= 0.0:
            return FOUND, s, 0.0
        else:
            shortest = 0.0
    return OPEN, s, shortest


@compiled
def first_root(series, row, start, end, leave):
    """First root of a polynomial in (start, end] that is positive just behind `start`; infinity if there is none.

    A search that starts on a root moves on by at least the part `leave` of `end`.
    """
    reach = 0.0
    power = end
    for n in range(1, ORDER + 1):
        reach += abs(series[place(row, n)]) * power
        power *= end
    if series[row] > reach or reach == 0.0:
        return math.inf
    noise = NOISE * (abs(series[row]) + reach)
    answer, s, shortest = search(series, row, start, end, leave * end, noise)
    piece = end - s
    for _ in range(MAX_PIECES):
        if answer == FOUND:
            return s
        if answer == ABSENT and s >= end:
            return math.inf
        # Bounds on a shorter piece, from the expansion about its beginning, are tighter.
        piece *= 2.0 if answer == ABSENT else 0.25
        piece = min(piece, end - s)
        shifted = expand_about(series, row, s)
        answer, advance, shortest = search(shifted, FIRST_ROW, 0.0, piece, shortest, noise)
        s = end if answer == ABSENT and piece == end - s else s + advance
    return math.inf
