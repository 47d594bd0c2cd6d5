"""Box counting (Minkowski-Bouligand, Sect. 4.2): the boxes of shifted grids that hold a point, for many scales.

Four boxes make one box of twice the size. Along a Z-curve (Morton) they follow each other, so that points that are
sorted along the curve at the finest scale are sorted at all coarser scales.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...solver.jit import compiled, compiled_inline
from .scaling_region import SAMPLES_PER_BOX, SCALES, SCALES_PER_OCTAVE, Dimension, normalise, scaling_region

# Nested parts of a set of points: all, half, a quarter. A point of h halvings belongs to the first h + 1 parts.
PARTS = 3
# Positions of each grid over which box counts are averaged, in boxes: a Fibonacci lattice. Because 13 is odd, doubling
# only changes the order of the positions: nested grids have the same positions at each scale.
SHIFTS = np.modf(np.arange(13)[:, None] * np.array([1.0, 8.0]) / 13.0)[0]


class Samples(NamedTuple):
    """Points and the grids in which they are counted."""

    points: np.ndarray  # float64, shape (n, 2), in the unit square
    halvings: np.ndarray  # int64, shape (n,), see PARTS
    scales: np.ndarray  # float64, shape (k,), sizes of boxes, descending, each half of the one `step` before it
    step: int  # k if no scale is half of another one


@compiled_inline
def spread(number):
    """The lower 32 bits of an integer, with a zero bit between neighbours."""
    number = (number | (number << 16)) & 0x0000FFFF0000FFFF
    number = (number | (number << 8)) & 0x00FF00FF00FF00FF
    number = (number | (number << 4)) & 0x0F0F0F0F0F0F0F0F
    number = (number | (number << 2)) & 0x3333333333333333
    return (number | (number << 1)) & 0x5555555555555555


@compiled
def boxes_of(points, size, across_shift, along_shift):
    """Numbers along a Z-curve of the boxes of a shifted grid that the points lie in: int64, shape (n,).

    A shift by two bits gives the number of the box of twice the size. `size` is at least 2^-30.
    """
    boxes = np.empty(len(points), np.int64)
    inverse = 1.0 / size
    for i in range(len(points)):
        across, along = np.int64(points[i, 0] * inverse + across_shift), np.int64(points[i, 1] * inverse + along_shift)
        boxes[i] = spread(across) | (spread(along) << 1)
    return boxes


@compiled
def count_sorted(keys, finest, step, totals):
    """Add the numbers of boxes that hold a point of each part to `totals`, int64, shape (PARTS, k).

    keys : int64, shape (n,), ascending: the box of a point in the grid of the scale number `finest`, times four, plus
        the point's halvings
    """
    previous = np.full(PARTS, -1)
    for key in keys:
        box = key >> 2
        for part in range((key & 3) + 1):
            # A box differs from the one before up to the scale at which both lie in one box.
            different, k = box ^ previous[part], finest
            while different != 0 and k >= 0:
                totals[part, k] += 1
                different >>= 2
                k -= step
            previous[part] = box


def count_chain(samples: Samples, finest: int, shift: np.ndarray, totals: np.ndarray) -> None:
    """Add the numbers of boxes that hold a point of each part to `totals`, shape (PARTS, k), for a chain of grids.

    The chain has the scales number `finest`, `finest` - `step`, `finest` - 2 `step`, …, each twice the one before. The
    grid of the largest scale is shifted by `shift` boxes.
    """
    across, along = shift * 2.0 ** (finest // samples.step)
    boxes = boxes_of(samples.points, samples.scales[finest], across, along)
    count_sorted(np.sort(boxes << 2 | samples.halvings), finest, samples.step, totals)


def box_counts(samples: Samples, shifts: np.ndarray, samples_per_box: float) -> np.ndarray:
    """Mean numbers of occupied boxes over shifted grids for all points and their parts, shape (PARTS, k).

    Counts are zero from the scale on at which a box holds fewer than `samples_per_box` different samples on average.
    In half of the points, half as many are enough, and in a quarter, a quarter. Samples in one box of the finest scale
    count as one.

    shifts : float64, shape (s, 2), in boxes
    """
    scales, step = samples.scales, samples.step
    # The first chain shows which scales may be resolved: up to an octave beyond its last resolved scale.
    totals = np.zeros((PARTS, len(scales)), np.int64)
    finest = len(scales) - 1
    count_chain(samples, finest, shifts[0], totals)
    distinct = totals[:, -1:].copy()
    end = finest
    while end >= step and totals[0, end] * samples_per_box > distinct[0]:
        end -= step
    end = min(end + step, finest) + 1
    totals[:] = 0
    for shift in shifts:
        for k in range(max(end - step, 0), end):
            count_chain(samples, k, shift, totals)
    enough = totals * samples_per_box <= distinct * len(shifts) * 2 ** np.arange(PARTS)[:, None]
    return np.where(np.logical_and.accumulate(enough, axis=1), totals / len(shifts), 0.0)


def box_dimension(points: ArrayLike) -> Dimension:
    """Minkowski-Bouligand dimension of `points`, shape (n, 2), scaled axis by axis to the unit square.

    Counts are means over shifted grids, which makes N(ε)ε² the area of the set dilated by a box of size ε. Boxes that
    stay empty because the sample is finite are extrapolated: counts of n, n/2 and n/4 points, drawn at random with a
    fixed seed, are continued as a geometric series (Aitken), by no more than their last increment. The slope of this
    correction enters the error. Normally distributed points, whose tails are thin, reach some boxes too rarely for
    this: their dimension comes out too small, by more than its error. Correlation sums do not need such boxes.

    Samples that repeat resolve nothing: sample a periodic orbit at times incommensurate with its period.
    ValueError says why points cannot be used.

    Examples
    --------
    >>> points = np.random.default_rng(1).random((20_000, 2))  # a filled square
    >>> dimension = box_dimension(points)
    >>> bool(abs(dimension.value - 2.0) < dimension.error)
    True
    """
    points = normalise(points)
    n = len(points)
    order = np.random.default_rng(0).permutation(n)
    halvings = np.sum([np.arange(n) < n // part for part in (2, 4)], axis=0)
    samples = Samples(points[order], halvings, SCALES, SCALES_PER_OCTAVE)
    counts, half, quarter = box_counts(samples, SHIFTS, SAMPLES_PER_BOX)
    resolved = (counts > 0.0) & (half > 0.0) & (quarter > 0.0)
    scales, counts, half, quarter = (column[resolved] for column in (SCALES, counts, half, quarter))
    last, before = counts - half, half - quarter
    missing = np.where(before > last, last**2 / np.where(before > last, before - last, 1.0), 0.0)
    corrected = counts + np.minimum(missing, last)
    value, error, low, high = scaling_region(scales, np.log(corrected), np.log(corrected / counts)[None])
    return Dimension(-value, error, low, high, scales, counts)
