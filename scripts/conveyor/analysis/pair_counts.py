"""Numbers of pairs of points by their distance."""

import numpy as np

from ..solver.jit import float_bits, kernel

STRETCH = 256  # distances that are found at a time
FRACTION = 48  # bits of a float that are left out: sixteen steps in each doubling remain
TABLES = 4  # of counts, in turn: to add to a number that was just changed takes time


@kernel
def pair_counts(points, references, theiler, squares):
    """Numbers of pairs by squared distance, and of all pairs; shell k lies between squares[k] and squares[k + 1].

    Parameters
    ----------
    points : shape (n, 2)
    references : each (an index) is paired with all points that are more than `theiler` samples away
    squares : descending, shape (k,), no two of them within 6 % of each other
    """
    # Slices would bring in the text functions of their errors, which take long to compile.
    shells = len(squares)
    limits = np.empty(shells + 1)
    for shell in range(shells):
        limits[shell] = squares[shell]
    limits[shells] = -1.0
    # The first bits of a squared distance tell its shell but for one limit, with which it is compared.
    lowest = float_bits(squares[-1]) >> FRACTION
    shells_of = np.empty((float_bits(squares[0]) >> FRACTION) - lowest + 1, np.int64)
    shell = shells
    for step in range(len(shells_of)):
        while shell > 0 and (float_bits(squares[shell - 1]) >> FRACTION) - lowest <= step:
            shell -= 1
        shells_of[step] = shell
    x, y = np.empty(len(points)), np.empty(len(points))
    for j in range(len(points)):
        x[j], y[j] = points[j, 0], points[j, 1]
    counts = np.zeros((TABLES, shells + 1), np.int64)
    apart, near = np.empty(STRETCH), np.empty(STRETCH)
    largest = squares[0]
    pairs = 0
    for i in references:
        x_i, y_i = x[i], y[i]
        for begin, end in ((0, i - theiler), (i + theiler + 1, len(x))):
            for at in range(begin, end, STRETCH):
                count = min(STRETCH, end - at)
                # By itself, as the processor then finds several at a time.
                for j in range(count):
                    apart[j] = (x[at + j] - x_i) ** 2 + (y[at + j] - y_i) ** 2
                found = 0
                for j in range(count):
                    square = apart[j]
                    near[found] = square
                    found += square < largest
                for j in range(found):
                    shell = shells_of[max((float_bits(near[j]) >> FRACTION) - lowest, 0)]
                    counts[j % TABLES, shell + (near[j] < limits[shell])] += 1
            pairs += max(end - begin, 0)
    totals = np.zeros(shells, np.int64)
    for table in range(TABLES):
        for shell in range(shells):
            totals[shell] += counts[table, shell + 1]
    return totals, pairs
