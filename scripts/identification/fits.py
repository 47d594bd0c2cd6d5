"""Least squares of misfits, with some parameters held."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

# Of logarithms: small against a per cent, large against the tolerance of the trajectories.
STEP = 1e-3
EVALUATIONS = 60
ENOUGH = 1e-6  # relative change of the total, and of the parameters


class Fit(NamedTuple):
    """Parameters, shape (k,), the sum of the squared misfits there, and whether the search came to an end."""

    x: np.ndarray
    total: float
    settled: bool


def fit(residuals: Callable[[np.ndarray], np.ndarray], starts: np.ndarray, bounds: np.ndarray) -> Fit:
    """The least sum of squares from several starts, by the trust-region method with differences.

    Parameters
    ----------
    residuals : shape (n, m), for parameters of shape (n, k)
    starts : shape (s, k); what lies outside the bounds is moved to them
    bounds : lower and upper ones, shape (2, k)
    """
    low, high = bounds
    inner = 1e-9 * (high - low)

    values: dict[bytes, np.ndarray] = {}

    def value(x: np.ndarray) -> np.ndarray:
        if x.tobytes() not in values:
            values[x.tobytes()] = residuals(x[None])[0]
        return values[x.tobytes()]

    def slope(x: np.ndarray) -> np.ndarray:
        # Away from the upper bounds.
        steps = np.where(x + STEP <= high, STEP, -STEP)
        return ((residuals(x + np.diag(steps)) - value(x)) / steps[:, None]).T

    found = []
    for start in starts:
        solution = least_squares(
            value,
            np.clip(start, low + inner, high - inner),
            jac=slope,
            bounds=bounds,
            max_nfev=EVALUATIONS,
            ftol=ENOUGH,
            xtol=ENOUGH,
            gtol=ENOUGH,
        )
        found.append(Fit(solution.x, 2.0 * float(solution.cost), solution.status > 0))
    return min(found, key=lambda one: one.total)
