"""Least-squares fits of misfits from several initial guesses."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

# Step of finite differences in logarithms of parameters: small for the fit, large for the tolerance of trajectories.
STEP = 1e-3
EVALUATIONS = 60
ENOUGH = 1e-6  # relative change of the total and of the parameters at which a fit has converged


class Fit(NamedTuple):
    """Parameters, shape (k,), the sum of the squared misfits there, and whether the fit has converged."""

    x: np.ndarray
    total: float
    settled: bool


def fit(residuals: Callable[[np.ndarray], np.ndarray], guesses: np.ndarray, bounds: np.ndarray) -> Fit:
    """The best least-squares fit from several guesses, by SciPy's trust-region method with finite differences.

    Parameters
    ----------
    residuals : function from parameters, shape (n, k), to residuals, shape (n, m)
    guesses : shape (s, k); values outside the bounds are moved to them
    bounds : lower and upper bounds, shape (2, k)
    """
    low, high = bounds
    inner = 1e-9 * (high - low)

    values: dict[bytes, np.ndarray] = {}

    def value(x: np.ndarray) -> np.ndarray:
        if x.tobytes() not in values:
            values[x.tobytes()] = residuals(x[None])[0]
        return values[x.tobytes()]

    def slope(x: np.ndarray) -> np.ndarray:
        # Forward differences, backward ones at the upper bounds.
        steps = np.where(x + STEP <= high, STEP, -STEP)
        return ((residuals(x + np.diag(steps)) - value(x)) / steps[:, None]).T

    found = []
    for guess in guesses:
        solution = least_squares(
            value,
            np.clip(guess, low + inner, high - inner),
            jac=slope,
            bounds=bounds,
            max_nfev=EVALUATIONS,
            ftol=ENOUGH,
            xtol=ENOUGH,
            gtol=ENOUGH,
        )
        found.append(Fit(solution.x, 2.0 * float(solution.cost), solution.status > 0))
    return min(found, key=lambda result: result.total)
