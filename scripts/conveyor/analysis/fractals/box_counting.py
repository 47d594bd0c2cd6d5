"""Box counting (Minkowski-Bouligand, Sect. 4.2): the boxes of shifted grids that hold a point, for many scales.

Four boxes make one box of twice the size. The grid of the next coarser scale is therefore filled from the boxes that
hold a point, whose number shrinks, and not from the points.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ...solver.jit import compiled, compiled_inline
from .scaling_region import (
    FINEST_SCALE,
    SAMPLES_PER_BOX,
    SCALES,
    SCALES_PER_OCTAVE,
    Dimension,
    normalise,
    scaling_region,
)

NEIGHBOURS = 64  # boxes along a Z-curve that lie side by side in a hash table
FRESH = 1 << 30  # number of boxes after which a hash table is cleared, because their numbers have 32 bits
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


class Workspace(NamedTuple):
    """Arrays that all chains of grids share; see `merge`."""

    owners: np.ndarray  # int32
    boxes: np.ndarray  # int64, shape (n,)
    deepest: np.ndarray  # int8, shape (n,)


@compiled_inline
def spread(number):
    """The lower 32 bits of an integer, with a zero bit between neighbours."""
    number = (number | (number << 16)) & 0x0000FFFF0000FFFF
    number = (number | (number << 8)) & 0x00FF00FF00FF00FF
    number = (number | (number << 4)) & 0x0F0F0F0F0F0F0F0F
    number = (number | (number << 2)) & 0x3333333333333333
    return (number | (number << 1)) & 0x5555555555555555


@compiled
def boxes_of(points, size, across_shift, along_shift, boxes):
    """Fill `boxes`, int64, with the numbers of the boxes of a shifted grid that the points lie in, along a Z-curve.

    Four boxes that make one of twice the size follow each other (Morton).
    """
    inverse = 1.0 / size
    for i in range(len(points)):
        across, along = np.int64(points[i, 0] * inverse + across_shift), np.int64(points[i, 1] * inverse + along_shift)
        boxes[i] = spread(across) | (spread(along) << 1)


def along_boxes(points: np.ndarray, size: float) -> np.ndarray:
    """The order of points of the unit square, shape (n, 2), along a Z-curve (Morton): points in one box are adjacent.

    `size` is the edge of the smallest boxes. The order does not change the counts, but it saves time, because boxes
    that are looked up one after the other stay in the processor's cache.
    """
    boxes = np.empty(len(points), np.int64)
    boxes_of(points, size, 0.0, 0.0, boxes)
    return np.argsort(boxes, kind="stable")


@compiled
def merge(boxes, deepest, n, owners, first):
    """Keep each of the first n boxes once, with the most halvings of its points; return the number of kept boxes.

    Parameters
    ----------
    boxes, deepest : int64 and int8, replaced from their beginnings on
    owners : int32, a hash table of a length 2^k ≥ 2 n: the number of a box that is kept, counted from `first`; a place
        is free whose number is smaller
    """
    # Only a part of the table that is long enough is used, so that it stays in the processor's cache.
    length = NEIGHBOURS
    while length < 2 * n:
        length *= 2
    mask = np.uint64(length - 1)
    kept = number = 0
    previous = np.int64(-1)
    for i in range(n):
        box, halvings = boxes[i], deepest[i]
        if box != previous:
            previous = box
            mixed = np.uint64(box // NEIGHBOURS) * np.uint64(0x9E3779B97F4A7C15)
            slot = ((mixed >> np.uint64(32)) * np.uint64(NEIGHBOURS) + np.uint64(box % NEIGHBOURS)) & mask
            while owners[slot] >= first and boxes[owners[slot] - first] != box:
                slot = (slot + np.uint64(1)) & mask
            if owners[slot] < first:
                owners[slot] = first + kept
                boxes[kept], deepest[kept] = box, halvings
                kept += 1
            number = owners[slot] - first
        deepest[number] = max(deepest[number], halvings)
    return kept


@compiled
def count_chain(samples, finest, shift, first, workspace, totals):
    """Add the numbers of boxes that hold a point of each part to `totals`, shape (PARTS, k), for a chain of grids.

    Its scales are number `finest`, the one `step` before it, of twice the size, and so on; of the last and largest one
    the grid is shifted by `shift` boxes. What each grid holds is found from the boxes of the one before.

    Parameters
    ----------
    samples, workspace : see Samples and Workspace
    first : as in `merge`; that of the next chain is returned
    """
    owners, boxes, deepest = workspace.owners, workspace.boxes, workspace.deepest
    n = len(samples.points)
    # Loops, because slices compile slowly: their error messages need text functions.
    if first > FRESH:
        for i in range(len(owners)):
            owners[i] = -1
        first = 0
    positions = 2.0 ** (finest // samples.step)
    boxes_of(samples.points, samples.scales[finest], shift[0] * positions, shift[1] * positions, boxes)
    for i in range(n):
        deepest[i] = samples.halvings[i]
    for k in range(finest, -1, -samples.step):
        kept = merge(boxes, deepest, n, owners, first)
        first += n
        n = kept
        for i in range(n):
            for part in range(deepest[i] + 1):
                totals[part, k] += 1
            boxes[i] >>= 2
    return first


@compiled
def box_counts(samples, shifts, samples_per_box):
    """Mean numbers of occupied boxes over shifted grids for all points and their parts, shape (PARTS, k).

    Zero from the first scale on whose boxes hold fewer than `samples_per_box` samples that the finest scale tells
    apart; in a part as many fewer as it is smaller.
    """
    n, scales, step = len(samples.points), samples.scales, samples.step
    length = NEIGHBOURS
    while length < 2 * n:
        length *= 2
    workspace = Workspace(np.empty(length, np.int32), np.empty(n, np.int64), np.empty(n, np.int8))
    # The first chain shows which scales may be resolved: up to an octave beyond its last resolved scale.
    totals = np.zeros((PARTS, len(scales)), np.int64)
    finest = len(scales) - 1
    first = count_chain(samples, finest, shifts[0], FRESH + 1, workspace, totals)
    distinct = np.zeros(PARTS, np.int64)
    for part in range(PARTS):
        distinct[part] = totals[part, finest]
    end = finest
    while end >= step and totals[0, end] * samples_per_box > distinct[0]:
        end -= step
    end = min(end + step, finest) + 1
    totals = np.zeros((PARTS, len(scales)), np.int64)
    for s in range(len(shifts)):
        for k in range(max(end - step, 0), end):
            first = count_chain(samples, k, shifts[s], first, workspace, totals)
    counts = np.zeros((PARTS, len(scales)))
    resolved = np.ones(PARTS, np.bool_)
    for k in range(end):
        for part in range(PARTS):
            enough = totals[part, k] * samples_per_box <= distinct[part] * len(shifts) * (1 << part)
            resolved[part] = resolved[part] and enough
            if resolved[part]:
                counts[part, k] = totals[part, k] / len(shifts)
        if not resolved[0]:
            break
    return counts


def box_dimension(points: np.ndarray) -> Dimension:
    """Minkowski-Bouligand dimension of `points`, shape (n, 2), scaled axis by axis to the unit square.

    Counts are means over shifted grids, which makes N(ε)ε² the area of the set dilated by a box of size ε. Boxes that
    stay empty because the sample is finite are extrapolated: counts of n, n/2 and n/4 points, drawn at random with a
    fixed seed, are continued as a geometric series (Aitken), by no more than their last increment. The slope of this
    correction enters the error.

    Samples that repeat resolve nothing: sample a periodic orbit at times incommensurate with its period.
    """
    points = normalise(points)
    points = points[np.random.default_rng(0).permutation(len(points))]
    order = along_boxes(points, FINEST_SCALE)
    halvings = np.sum([order < len(points) // part for part in (2, 4)], axis=0)
    samples = Samples(points[order], halvings, SCALES, SCALES_PER_OCTAVE)
    counts, half, quarter = box_counts(samples, SHIFTS, SAMPLES_PER_BOX)
    resolved = (counts > 0.0) & (half > 0.0) & (quarter > 0.0)
    scales, counts, half, quarter = (column[resolved] for column in (SCALES, counts, half, quarter))
    last, before = counts - half, half - quarter
    missing = np.where(before > last, last**2 / np.where(before > last, before - last, 1.0), 0.0)
    corrected = counts + np.minimum(missing, last)
    value, error, low, high = scaling_region(scales, np.log(corrected), np.log(corrected / counts)[None])
    return Dimension(-value, error, low, high, scales, counts)


def box_dimension_of_paper(points: np.ndarray, sizes: Iterable[float] = tuple(0.5 ** np.arange(1, 9))) -> Dimension:
    """Box counting without precautions: one grid, a straight line through the counts of all `sizes`.

    The error is twice the standard error of the slope, as if the counts scattered independently.
    """
    # A copy lies in memory in its own order: `box_counts` would be compiled once more for a reversed view.
    scales = np.sort(np.asarray(sizes, dtype=np.float64))[::-1].copy()
    samples = Samples(normalise(points), np.zeros(len(points), np.int64), scales, len(scales))
    counts = box_counts(samples, np.zeros((1, 2)), 0.0)[0]
    (slope, _), covariance = np.polyfit(np.log(scales), np.log(counts), 1, cov=True)
    return Dimension(-slope, 2.0 * np.sqrt(covariance[0, 0]), scales[-1], scales[0], scales, counts)
