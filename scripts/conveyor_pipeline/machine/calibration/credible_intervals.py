"""Credible intervals of one parameter from a weighted sample of its posterior, smoothed by Silverman's rule.

Smoothing makes intervals a little wider, and less dependent on the few samples at their ends.
"""

import math
from collections.abc import Iterable

import numpy as np
from scipy.special import ndtr

from conveyor.elementary import exp
from conveyor.linear_algebra import dot
from conveyor_pipeline.machine.calibration.importance_sampling import effective_number

CONFIDENCE = 0.95  # of the intervals
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


def summarize(columns: Iterable[np.ndarray], weights: np.ndarray) -> np.ndarray:
    """Median and ends of the central interval with a share CONFIDENCE of the posterior of each parameter, shape (d, 3).

    columns, weights : values of d parameters, each of shape (n,), and weights as in `quantiles`
    """
    shares = [0.5, 0.5 - 0.5 * CONFIDENCE, 0.5 + 0.5 * CONFIDENCE]
    return np.array([quantiles(values, weights, shares) for values in columns])


def with_errors(values: np.ndarray, errors: np.ndarray, is_log: bool) -> dict[str, float]:
    """Best value and ends of an interval, shape (3,), with their Monte Carlo errors, as columns of a table.

    is_log : whether the errors belong to the logarithms of the values
    """
    columns = {}
    for name, value, error in zip(("best", "low", "high"), values, values * errors if is_log else errors, strict=True):
        columns |= {name: value, f"{name}_error": error}
    return columns


def open_ends(values: np.ndarray, weights: np.ndarray, bounds: tuple[float, float]) -> tuple[bool, bool]:
    """Whether the density is not small at the lower and at the upper bound, so that only the bound limits it there."""
    width = smoothing(values, weights)
    grid = np.linspace(*bounds, 200)
    density = np.sum(exp(-0.5 * ((grid[:, None] - values) / width) ** 2) * weights, axis=1)
    # At a bound, half of the smoothed density lies beyond it.
    return tuple(bool(2.0 * density[end] > OPEN_DENSITY * density.max()) for end in (0, -1))
