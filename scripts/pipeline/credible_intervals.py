"""Credible intervals of one parameter from a weighted sample of its posterior, smoothed by Silverman's rule.

Smoothing makes intervals a little wider, and less dependent on the few samples at their ends.
"""

import math

import numpy as np
from scipy.special import ndtr

from conveyor.elementary import exp
from conveyor.linear_algebra import dot
from pipeline.importance_sampling import effective_number

OPEN_DENSITY = 0.2  # of the largest density of a parameter: an end of the range with more is open


def smoothing(values: np.ndarray, weights: np.ndarray) -> float:
    """Silverman's width."""
    mean = dot(weights, values)
    deviation = math.sqrt(dot(weights, (values - mean) ** 2))
    return max(1.06 * deviation * effective_number(weights) ** -0.2, 1e-9 * max(abs(mean), 1.0))


def quantiles(values: np.ndarray, weights: np.ndarray, shares: list[float]) -> np.ndarray:
    """The values below which there are some shares of the posterior, of the shape of `shares`.

    values, weights : of the sample, shape (n,); the sum of the weights is 1
    """
    width = smoothing(values, weights)
    grid = np.linspace(values.min() - 4.0 * width, values.max() + 4.0 * width, 2000)
    below = np.sum(ndtr((grid[:, None] - values) / width) * weights, axis=1)
    return np.interp(shares, below, grid)


def interval(values: np.ndarray, weights: np.ndarray, confidence: float) -> tuple[float, float]:
    """The central interval with a share `confidence` of the posterior; the arguments as in `quantiles`."""
    low, high = quantiles(values, weights, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence])
    return float(low), float(high)


def open_ends(values: np.ndarray, weights: np.ndarray, bounds: tuple[float, float]) -> tuple[bool, bool]:
    """Whether the density is not small at the lower and at the upper bound, so that only the bound limits it there."""
    width = smoothing(values, weights)
    grid = np.linspace(*bounds, 200)
    density = np.sum(exp(-0.5 * ((grid[:, None] - values) / width) ** 2) * weights, axis=1)
    # At a bound, half of the smoothed density lies beyond it.
    return tuple(bool(2.0 * density[end] > OPEN_DENSITY * density.max()) for end in (0, -1))
