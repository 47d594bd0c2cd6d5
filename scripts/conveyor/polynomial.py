"""Real polynomials on a step: evaluation, and the first root that no sign test at the ends could hide."""

import math

from .jit import kernel

# A root that a search starts on is left behind by at least this part of the step, so that it is not found twice.
LEAVE = 1e-6
ROOT_RESOLUTION = 1e-15
MAX_ITERATIONS = 200


@kernel
def value(coefficients, order, s):
    """Σ c_n sⁿ, n = 0 … order."""
    total = coefficients[order]
    for n in range(order - 1, -1, -1):
        total = total * s + coefficients[n]
    return total


@kernel
def value_and_slope(coefficients, order, s):
    """Σ c_n sⁿ and its derivative."""
    total = coefficients[order]
    slope = 0.0
    for n in range(order - 1, -1, -1):
        slope = slope * s + total
        total = total * s + coefficients[n]
    return total, slope


@kernel
def first_root(coefficients, order, start, end):
    """First root of a polynomial in (start, end] that is positive just behind `start`; infinity if there is none.

    The largest |second derivative| on [0, end] makes a parabola that lies below the polynomial. Steps to the roots of
    such parabolas cannot jump over a root, whatever the signs at the ends are, and converge quadratically to a simple
    root.
    """
    reach = 0.0
    curvature = 0.0
    power = end
    for n in range(1, order + 1):
        magnitude = abs(coefficients[n]) * power
        reach += magnitude
        curvature += n * (n - 1) * magnitude
        power *= end
    if coefficients[0] > reach:
        return math.inf
    curvature /= end * end
    s = start
    f, slope = value_and_slope(coefficients, order, s)
    shortest = LEAVE * end
    for _ in range(MAX_ITERATIONS):
        f = max(f, 0.0)
        if curvature > 0.0:
            advance = (slope + math.sqrt(slope * slope + 2.0 * curvature * f)) / curvature
        elif slope < 0.0:
            advance = -f / slope
        else:
            return math.inf
        if shortest == 0.0 and advance <= ROOT_RESOLUTION * end:
            return s
        s += max(advance, shortest)
        if s > end:
            return math.inf
        f, slope = value_and_slope(coefficients, order, s)
        if f <= 0.0:
            return s
        shortest = 0.0
    return s
