"""How uncertain the end of a trajectory is near the boundaries of a map of basins.

An initial condition is uncertain within ε if another one at the distance ε has another label. The share of uncertain
initial conditions grows as ε^α with the uncertainty exponent α (McDonald, Grebogi, Ott and Yorke 1985): α = 1 for a
smooth boundary, and less for a fractal one, whose dimension is D - α in a map of D axes. Attractors.jl counts boxes
with several labels in place of pairs. Boxes of a few points miss most of a fractal boundary; on a Cantor set, their
exponent is twice the true one. The basin entropy (Daza et al. 2016), as there, is the mean over boxes of -Σ p log p
with the shares p of the labels in a box.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...arguments import check_count
from ...linear_algebra import fit_line

DISTANCES = np.arange(1, 16)  # points


class Uncertainty(NamedTuple):
    """The uncertainty exponent of a map."""

    value: float  # α; NaN where labels differ at fewer than three distances
    error: float  # standard error of the slope if the points scatter independently, see uncertainty_exponent
    distances: np.ndarray  # points along an axis, shape (k,)
    uncertain: np.ndarray  # share of pairs at each distance with different labels, mean over the axes, shape (k,)

    def __repr__(self) -> str:
        return f"Uncertainty(α = {self.value:.3g} ± {self.error:.1g})"


class BasinEntropy(NamedTuple):
    """The basin entropy of a map, in nats."""

    value: float  # mean over all boxes
    boundary: float  # mean over the uncertain boxes; above log 2 the boundary is fractal; NaN for a single basin


def check_map(labels: ArrayLike, least: int) -> np.ndarray:
    """The numbers of the labels of a map, without axes of one point; ValueError unless each other axis has `least`."""
    try:
        labels = np.squeeze(np.asarray(labels))
    except ValueError as error:
        raise ValueError(f"labels must be an array: {error}") from None
    if labels.ndim == 0 or min(labels.shape) < least:
        raise ValueError(f"labels must be a map of at least {least} points along each axis, got {labels.shape}")
    if labels.dtype.kind not in "OUSbiu":
        raise ValueError(f"labels must be words or whole numbers, got the type {labels.dtype}")
    return np.unique(labels.astype(str), return_inverse=True)[1].reshape(labels.shape)


def shares_in_boxes(numbers: np.ndarray, size: int) -> np.ndarray:
    """The shares of the labels in as few boxes of a size as cover the map, shape (boxes, labels)."""
    # Evenly spaced first points: multiples of the size, if it divides the axis.
    corners = [np.linspace(0, length - size, -(-length // size)).round().astype(int) for length in numbers.shape]
    windows = np.lib.stride_tricks.sliding_window_view(numbers, (size,) * numbers.ndim)
    boxes = windows[np.ix_(*corners)].reshape(-1, size**numbers.ndim)
    return np.stack([(boxes == label).mean(axis=1) for label in range(int(numbers.max()) + 1)], axis=1)


def uncertainty_exponent(labels: ArrayLike) -> Uncertainty:
    """The uncertainty exponent of a map of labels, as from `basin`, over distances of 1 to 15 points.

    The error covers only the scatter of the shares around a power law, as if each distance had pairs of its own. It
    does not cover the number of points in the map or the choice of distances. On a self-similar boundary such as a
    Cantor set, the share also oscillates with the logarithm of the distance, so that the exponent may be off by several
    errors. Maps with different numbers of points show how far.

    labels : words or whole numbers on a grid of one, two or more axes, with at least 30 points along each

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(300), np.arange(300))
    >>> round(uncertainty_exponent(np.hypot(x, y) < 200).value, 1)  # a smooth boundary
    1.0
    """
    numbers = check_map(labels, 2 * int(DISTANCES[-1]))
    axes = [np.moveaxis(numbers, axis, 0) for axis in range(numbers.ndim)]
    uncertain = np.array([np.mean([(line[far:] != line[:-far]).mean() for line in axes]) for far in DISTANCES])
    some = uncertain > 0.0
    value = error = np.nan
    if some.sum() > 2:
        value, _, error = fit_line(np.log(DISTANCES[some]), np.log(uncertain[some]))
    return Uncertainty(value, error, DISTANCES, uncertain)


def basin_entropy(labels: ArrayLike, size: int = 20) -> BasinEntropy:
    """The basin entropy of a map of labels in boxes with `size` points along an edge.

    If the size divides each axis, the boxes are those of Attractors.jl, which refuses other sizes. Otherwise, boxes of
    the same size overlap as little as possible and cover the whole map.

    Examples
    --------
    >>> half = np.arange(100)[:, None] + np.zeros((100, 100), dtype=int) < 50
    >>> [round(entropy, 3) for entropy in basin_entropy(half, 20)]  # in one of five rows, boxes have both labels
    [0.139, 0.693]
    """
    size = check_count("size", size, 1, 10**6)
    try:
        shares = shares_in_boxes(check_map(labels, 2 * size), size)
    except ValueError as error:
        raise ValueError(f"size = {size}: {error}") from None
    entropies = -np.sum(shares * np.log(np.where(shares > 0.0, shares, 1.0)), axis=1)
    uncertain = shares.max(axis=1) < 1.0
    return BasinEntropy(float(entropies.mean()), float(entropies[uncertain].mean()) if uncertain.any() else np.nan)
