"""How uncertain the end of a trajectory is near the boundaries of a map of basins.

A box of the map is uncertain if its points have more than one label. The share of uncertain boxes grows with their size
ε as ε^α, with the uncertainty exponent α (McDonald, Grebogi, Ott and Yorke 1985): α = 1 for a smooth boundary, and less
for a fractal one of the dimension D - α in D dimensions. The basin entropy (Daza et al. 2016) is the mean over boxes of
-Σ p log p with the shares p of the labels in a box. Both are defined as in Attractors.jl.
"""

from typing import NamedTuple

import numpy as np

from ...arguments import check_count
from ...linear_algebra import fit_line

SIZES = range(2, 16)  # points along an edge of a box


class Uncertainty(NamedTuple):
    """The uncertainty exponent of a map."""

    value: float  # α; NaN where fewer than three box sizes have uncertain boxes
    error: float  # standard error of the slope, in which the size of the map is not included
    sizes: np.ndarray  # points along an edge of a box, shape (k,)
    uncertain: np.ndarray  # share of uncertain boxes, shape (k,)

    def __repr__(self) -> str:
        return f"Uncertainty(α = {self.value:.3g} ± {self.error:.1g})"


class BasinEntropy(NamedTuple):
    """The basin entropy of a map, in nats."""

    value: float  # mean over all boxes
    boundary: float  # mean over the uncertain boxes; above log 2 the boundary is fractal; NaN for a single basin


def check_map(labels: np.ndarray, size: int) -> np.ndarray:
    """The numbers of the labels of a map; ValueError unless it has at least two boxes of a size along each axis."""
    labels = np.asarray(labels)
    if labels.ndim == 0 or min(labels.shape) < 2 * size:
        raise ValueError(f"labels must be a map with two boxes of size = {size} along each axis, got {labels.shape}")
    if labels.dtype.kind not in "OUSbiu":
        raise ValueError(f"labels must be words or whole numbers, got the type {labels.dtype}")
    return np.unique(labels.astype(str), return_inverse=True)[1].reshape(labels.shape)


def shares_in_boxes(numbers: np.ndarray, size: int) -> np.ndarray:
    """The shares of the labels in all whole boxes of a size, shape (boxes, labels)."""
    whole = numbers[tuple(slice(length - length % size) for length in numbers.shape)]
    split = whole.reshape([part for length in whole.shape for part in (length // size, size)])
    order = [*range(0, split.ndim, 2), *range(1, split.ndim, 2)]
    boxes = split.transpose(order).reshape(-1, size**numbers.ndim)
    return np.stack([(boxes == label).mean(axis=1) for label in range(int(numbers.max()) + 1)], axis=1)


def uncertainty_exponent(labels: np.ndarray) -> Uncertainty:
    """The uncertainty exponent of a map of labels, as from `basin`, over boxes of 2 to 15 points along an edge.

    labels : words or whole numbers on a grid of one, two or more axes, with at least 30 points along each

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(300), np.arange(300))
    >>> round(uncertainty_exponent(np.hypot(x, y) < 200).value, 1)  # a smooth boundary
    1.0
    """
    numbers, sizes = check_map(labels, SIZES[-1]), np.array(SIZES)
    uncertain = np.array([(shares_in_boxes(numbers, size).max(axis=1) < 1.0).mean() for size in SIZES])
    some = uncertain > 0.0
    value = error = np.nan
    if some.sum() > 2:
        value, _, error = fit_line(np.log(sizes[some]), np.log(uncertain[some]))
    return Uncertainty(value, error, sizes, uncertain)


def basin_entropy(labels: np.ndarray, size: int = 20) -> BasinEntropy:
    """The basin entropy of a map of labels in boxes with `size` points along an edge.

    Examples
    --------
    >>> half = np.arange(100)[:, None] + np.zeros((100, 100), dtype=int) < 50
    >>> basin_entropy(half, 20)  # one row of boxes in five has both labels, in equal parts
    BasinEntropy(value=0.138..., boundary=0.693...)
    """
    size = check_count("size", size, 1, 10**6)
    shares = shares_in_boxes(check_map(labels, size), size)
    entropies = -np.sum(shares * np.log(np.where(shares > 0.0, shares, 1.0)), axis=1)
    uncertain = shares.max(axis=1) < 1.0
    return BasinEntropy(float(entropies.mean()), float(entropies[uncertain].mean()) if uncertain.any() else np.nan)
