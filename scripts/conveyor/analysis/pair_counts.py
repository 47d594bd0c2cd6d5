"""Numbers of pairs of points by their distance."""

import numpy as np

from ..solver.jit import float_bits, kernel

STRETCH = 256  # distances that are found at a time
FRACTION = 48  # bits of a float that are left out: sixteen steps in each doubling remain
TABLES = 4  # of counts, in turn: to add to a number that was just changed takes time


@kernel
def pair_counts(points, references, theiler, squares):
    """Numbers of pairs by squared distance, and of all pairs; shell k lies between squares[k] and squares[k + 1].

    points : shape (n, 2)
    references : each (an index) is paired with all points that are more than `theiler` samples away
    squares : descending, shape (k,), no two of them within 6 % of each other
    """
    limits = np.append(squares, -1.0)
    # The first bits of a squared distance tell its shell but for one limit, with which it is compared.
    lowest = float_bits(squares[-1]) >> FRACTION
    shells_of = np.empty((float_bits(squares[0]) >> FRACTION) - lowest + 1, np.int64)
    shell = len(squares)
    for step in range(len(shells_of)):
        while shell > 0 and (float_bits(squares[shell - 1]) >> FRACTION) - lowest <= step:
            shell -= 1
        shells_of[step] = shell
    x, y = points[:, 0].copy(), points[:, 1].copy()
    counts = np.zeros((TABLES, len(limits)), np.int64)
    near = np.empty(STRETCH)
    pairs = 0
    for i in references:
        for begin, end in ((0, i - theiler), (i + theiler + 1, len(x))):
            for at in range(begin, end, STRETCH):
                found = 0
                for j in range(at, min(at + STRETCH, end)):
                    near[found] = (x[j] - x[i]) ** 2 + (y[j] - y[i]) ** 2
                    found += near[found] < squares[0]
                for j in range(found):
                    shell = shells_of[max((float_bits(near[j]) >> FRACTION) - lowest, 0)]
                    counts[j % TABLES, shell + (near[j] < limits[shell])] += 1
            pairs += max(end - begin, 0)
    return counts.sum(axis=0)[1:], pairs
