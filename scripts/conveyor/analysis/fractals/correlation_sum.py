"""The correlation sum: the share of pairs of points that are closer than a radius (Eq. 25).

Grassberger and Procaccia, Physica D 9 (1983) 189, with the window of Theiler, Phys. Rev. A 34 (1986) 2427.
"""

import numpy as np

from ...solver.jit import compiled
from .scaling_region import SAMPLES_PER_BOX, SCALES, Dimension, normalise, scaling_region

STRETCH = 256  # distances that are found at a time
FRACTION = 48  # bits of a float that are left out; sixteen steps in each doubling remain
TABLES = 4  # of counts, used in turn, because to change the same number twice in a row takes longer


@compiled
def pair_counts(points, references, theiler, squares):
    """Numbers of pairs by squared distance, and of all pairs; shell k lies between squares[k] and squares[k + 1].

    Parameters
    ----------
    points : shape (n, 2)
    references : each (an index) is paired with all points that are more than `theiler` samples away
    squares : descending, shape (k,), no two of them within 6 % of each other
    """
    # Loops, because slices compile slowly: their error messages need text functions.
    shells = len(squares)
    limits = np.empty(shells + 1)
    for shell in range(shells):
        limits[shell] = squares[shell]
    limits[shells] = -1.0
    # The first bits of a squared distance give its shell, up to one limit, with which the distance is compared. Of two
    # floats that are not negative, the larger one has the larger bits.
    bits_of_limits = squares.view(np.int64)
    lowest = bits_of_limits[-1] >> FRACTION
    shells_of = np.empty((bits_of_limits[0] >> FRACTION) - lowest + 1, np.int64)
    shell = shells
    for step in range(len(shells_of)):
        while shell > 0 and (bits_of_limits[shell - 1] >> FRACTION) - lowest <= step:
            shell -= 1
        shells_of[step] = shell
    x, y = np.empty(len(points)), np.empty(len(points))
    for j in range(len(points)):
        x[j], y[j] = points[j, 0], points[j, 1]
    counts = np.zeros((TABLES, shells + 1), np.int64)
    apart, near = np.empty(STRETCH), np.empty(STRETCH)
    bits = near.view(np.int64)
    largest = squares[0]
    pairs = 0
    for i in references:
        x_i, y_i = x[i], y[i]
        for begin, end in ((0, i - theiler), (i + theiler + 1, len(x))):
            for at in range(begin, end, STRETCH):
                count = min(STRETCH, end - at)
                # A loop of its own, so that the processor computes several distances at a time.
                for j in range(count):
                    apart[j] = (x[at + j] - x_i) ** 2 + (y[at + j] - y_i) ** 2
                found = 0
                for j in range(count):
                    square = apart[j]
                    near[found] = square
                    found += square < largest
                for j in range(found):
                    shell = shells_of[max((bits[j] >> FRACTION) - lowest, 0)]
                    counts[j % TABLES, shell + (near[j] < limits[shell])] += 1
            pairs += max(end - begin, 0)
    totals = np.zeros(shells, np.int64)
    for table in range(TABLES):
        for shell in range(shells):
            totals[shell] += counts[table, shell + 1]
    return totals, pairs


MINIMUM_PAIRS = 1000  # closer than the smallest radius: 3 % noise
MAXIMUM_PAIRS = 6e7  # distances to compute; larger sets are seen from fewer reference points
BLOCKS = 8  # stretches of a series whose correlation sums are compared


def correlation_dimension(points: np.ndarray, theiler: int) -> Dimension:
    """Correlation dimension of a series of `points`, shape (n, 2), scaled axis by axis to the unit square (Eq. 25).

    Neighbours are counted for BLOCKS consecutive parts of the series; twice the standard error that their slopes give
    enters the error.

    Parameters
    ----------
    points : consecutive samples
    theiler : pairs at most this number of samples apart are neighbours in time, not on the attractor, and left out
    """
    points = normalise(points)
    n = len(points)
    references = np.random.default_rng(0).permutation(n)[: int(min(n, max(MAXIMUM_PAIRS / n, 1.0)))]
    blocks = [pair_counts(points, block, theiler, SCALES**2) for block in np.array_split(np.sort(references), BLOCKS)]
    closer = np.cumsum([shells[::-1] for shells, _ in blocks], axis=1)[:, ::-1]
    total = closer.sum(axis=0)
    resolved = (total >= max(MINIMUM_PAIRS, SAMPLES_PER_BOX * total[-1])) & (closer > 0).all(axis=0)
    counts = total[resolved] / max(sum(pairs for _, pairs in blocks), 1)
    deviations = np.log(BLOCKS * closer[:, resolved] / total[resolved])
    noise = 2.0 * deviations / np.sqrt(BLOCKS * (BLOCKS - 1))
    return Dimension(*scaling_region(SCALES[resolved], np.log(counts), noise), SCALES[resolved], counts)
