"""Fractal dimension of a point set in the plane, with its scaling region and an error bar.

Two estimators: box counting (Minkowski-Bouligand, the paper's Sect. 4.2) and the correlation sum of Grassberger and
Procaccia, Physica D 9 (1983) 189, with the window of Theiler, Phys. Rev. A 34 (1986) 2427. Either yields a curve
log(measure) over log(scale) whose slope is the dimension only in between: boxes smaller than the distance of the
samples count samples, boxes as large as the set feel its rim. `scaling_region` finds what lies in between.
"""

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from conveyor.jit import kernel

SCALES_PER_OCTAVE = 4
COARSEST_SCALE = 0.25  # of the set's extent
FINEST_SCALE = 2.0**-20  # samples closer than this are one sample: a settled orbit repeats itself
SHIFTS = 8  # positions of each grid over which box counts are averaged
# Boxes hold at least ten resolved samples on average: of a uniform set, e^-10 of the boxes is then missed.
SAMPLES_PER_BOX = 10.0
MINIMUM_PAIRS = 1000.0  # pairs closer than the smallest radius used: 3 % noise
MAXIMUM_PAIRS = 1e8  # more distances than this are not computed: fewer reference points instead
MINIMUM_SPAN = np.log(8.0)  # shortest scaling region, three octaves


class Dimension(NamedTuple):
    """Estimate of a dimension.

    Attributes
    ----------
    value, error : dimension and its standard error, statistics and choice of the region together; NaN if no region
        of three octaves could be resolved with the given points
    scale_low, scale_high : limits of the scaling region, in units of the set's extent
    scales : box sizes or radii, descending, float64, shape (k,)
    counts : mean number of occupied boxes, or share of pairs that are closer than the radius, float64, shape (k,)
    """

    value: float
    error: float
    scale_low: float
    scale_high: float
    scales: np.ndarray
    counts: np.ndarray


def normalise(points: np.ndarray) -> np.ndarray:
    """The points, shape (n, 2), scaled axis by axis to the unit square; an axis without extent becomes zero."""
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or not len(points) or not np.isfinite(points).all():
        raise ValueError(f"points must be finite and of shape (n, 2) with n > 0, got shape {points.shape}")
    low, extent = points.min(axis=0), np.ptp(points, axis=0)
    return np.ascontiguousarray((points - low) / np.where(extent > 0.0, extent, 1.0))


def scales_below(coarsest: float) -> np.ndarray:
    """Log-spaced scales from `coarsest` down to FINEST_SCALE."""
    octaves = np.log2(coarsest / FINEST_SCALE)
    return coarsest * 2.0 ** (-np.arange(int(octaves * SCALES_PER_OCTAVE) + 1) / SCALES_PER_OCTAVE)


@kernel
def count_boxes(points, size, shift_x, shift_y, keys, stamps, stamp):
    """Number of boxes of a shifted grid that hold a point; `keys`, `stamps` form a hash table of length 2^k > n."""
    mask = np.uint64(len(keys) - 1)
    inverse = 1.0 / size
    count = 0
    previous = np.uint64(0xFFFFFFFFFFFFFFFF)
    for i in range(len(points)):
        column = np.uint64(points[i, 0] * inverse + shift_x)
        row = np.uint64(points[i, 1] * inverse + shift_y)
        key = (column << np.uint64(32)) | row
        if key == previous:
            continue
        previous = key
        mixed = key * np.uint64(0x9E3779B97F4A7C15)
        slot = (mixed ^ (mixed >> np.uint64(32))) & mask
        while stamps[slot] == stamp and keys[slot] != key:
            slot = (slot + np.uint64(1)) & mask
        if stamps[slot] != stamp:
            stamps[slot] = stamp
            keys[slot] = key
            count += 1
    return count


@kernel
def box_counts(points, scales, shifts, samples_per_box):
    """Mean counts of boxes over shifted grids, shape of `scales`; zero from the first scale that n points leave open."""
    length = 1
    while length < 2 * len(points):
        length *= 2
    keys = np.empty(length, np.uint64)
    stamps = np.full(length, -1, np.int64)
    resolved = count_boxes(points, scales[-1], shifts[0, 0], shifts[0, 1], keys, stamps, 0)
    counts = np.zeros(len(scales))
    stamp = 0
    for k in range(len(scales)):
        total = 0
        for s in range(len(shifts)):
            stamp += 1
            total += count_boxes(points, scales[k], shifts[s, 0], shifts[s, 1], keys, stamps, stamp)
        if total * samples_per_box > resolved * len(shifts):
            break
        counts[k] = total / len(shifts)
    return counts


@kernel
def pair_counts(points, stride, theiler, squares):
    """Number of pairs per shell of the squared radii `squares` (descending), and of all pairs.

    Every `stride`-th point is paired with all that are more than `theiler` samples away.
    """
    shells = np.zeros(len(squares), np.int64)
    pairs = 0
    n = len(points)
    for i in range(0, n, stride):
        x = points[i, 0]
        y = points[i, 1]
        for j in range(n):
            if abs(i - j) <= theiler:
                continue
            pairs += 1
            square = (points[j, 0] - x) ** 2 + (points[j, 1] - y) ** 2
            k = 0
            while k < len(squares) and square < squares[k]:
                k += 1
            if k > 0:
                shells[k - 1] += 1
    return shells, pairs
