"""The correlation sum: the share of pairs of points that are closer than a radius (Eq. 25).

Grassberger and Procaccia, Physica D 9 (1983) 189, with the window of Theiler, Phys. Rev. A 34 (1986) 2427.
"""

import numpy as np
from numpy.typing import ArrayLike

from ...arguments import check_count
from ...solver.jit import compiled
from .scaling_region import SAMPLES_PER_BOX, SCALES, Dimension, normalise, scaling_region


@compiled
def pair_counts(points, references, theiler, squares):
    """Numbers of pairs that are closer than each radius, int64, shape (k,), and of all pairs.

    Parameters
    ----------
    points : float64, shape (n, 2)
    references : each (an index) is paired with all points that are more than `theiler` samples away
    squares : of the radii, descending, shape (k,)
    """
    counts, pairs = np.zeros(len(squares), np.int64), 0
    n = len(points)
    x, y = points[:, 0].copy(), points[:, 1].copy()
    near = np.empty(n)
    for i in references:
        # A loop of its own, so that the processor computes several distances at a time.
        for j in range(n):
            near[j] = (x[j] - x[i]) ** 2 + (y[j] - y[i]) ** 2
        begin, end = max(i - theiler, 0), min(i + theiler + 1, n)
        near[begin:end] = np.inf
        pairs += n - (end - begin)
        count = n
        for k in range(len(squares)):
            # Keep what is closer than this radius, without branches: the processor could not guess them.
            closer = 0
            for j in range(count):
                apart = near[j]
                near[closer] = apart
                closer += apart < squares[k]
            counts[k] += closer
            count = closer
            if count == 0:
                break
    return counts, pairs


MINIMUM_PAIRS = 1000  # closer than the smallest radius: 3 % noise
MAXIMUM_PAIRS = 6e7  # distances to compute; larger sets are seen from fewer reference points
BLOCKS = 8  # stretches of a series whose correlation sums are compared


def correlation_dimension(points: ArrayLike, theiler: int = 0) -> Dimension:
    """Correlation dimension of a series of `points`, shape (n, 2), scaled axis by axis to the unit square (Eq. 25).

    Neighbours are counted for BLOCKS consecutive parts of the series; twice the standard error that their slopes give
    enters the error.

    Parameters
    ----------
    points : consecutive samples
    theiler : pairs at most this number of samples apart are neighbours in time, not on the attractor, and left out;
        0 to n - 1

    Examples
    --------
    >>> angle = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, 10_000)
    >>> dimension = correlation_dimension(np.column_stack([np.cos(angle), np.sin(angle)]))
    >>> bool(abs(dimension.value - 1.0) < dimension.error < 0.1)
    True
    """
    points = normalise(points)
    n = len(points)
    theiler = check_count("theiler", theiler, 0, n - 1)
    references = np.random.default_rng(0).permutation(n)[: int(min(n, max(MAXIMUM_PAIRS / n, 1.0)))]
    blocks = [pair_counts(points, block, theiler, SCALES**2) for block in np.array_split(np.sort(references), BLOCKS)]
    closer = np.array([counts for counts, _ in blocks])
    total = closer.sum(axis=0)
    resolved = (total >= max(MINIMUM_PAIRS, SAMPLES_PER_BOX * total[-1])) & (closer > 0).all(axis=0)
    counts = total[resolved] / max(sum(pairs for _, pairs in blocks), 1)
    deviations = np.log(BLOCKS * closer[:, resolved] / total[resolved])
    noise = 2.0 * deviations / np.sqrt(BLOCKS * (BLOCKS - 1))
    return Dimension(*scaling_region(SCALES[resolved], np.log(counts), noise), SCALES[resolved], counts)
