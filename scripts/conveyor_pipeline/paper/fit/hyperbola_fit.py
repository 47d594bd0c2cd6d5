"""Fit of the critical initial height by a hyperbola, z0 = A / (B + â) + C (Eq. 13), and how well it is determined.

For given B the problem is linear in A and C, and exactly solved (variable projection): `hyperbola_profile` gives the
best error over B, a valley along which very different triples fit almost equally well; `fit_hyperbola` goes to its
bottom. `fit_hyperbola_by_pymoo` searches in all three parameters as the paper does, by an evolution strategy.
"""

import numpy as np
from scipy.optimize import least_squares

from conveyor_pipeline.paper.fit.hyperbola import Hyperbola, critical_height, mean_squared_error

STARTS = 100  # values of B at which the valley is searched for its minima


def hyperbola_profile(acceleration: np.ndarray, height: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The valley: the best triple for each value of B, and its error.

    Parameters
    ----------
    acceleration, height : data, m/s² and m, shape (n,)
    b : values of B, m/s², shape (k,)

    Returns
    -------
    parameters, errors : float64, shape (k, 3), A (m²/s²), B (m/s²) and C (m); and mean squared errors, m², shape (k,)
    """
    x = 1.0 / (np.asarray(b, dtype=np.float64)[:, None] + acceleration)
    centred = x - x.mean(axis=1, keepdims=True)
    a = np.sum(centred * (height - np.mean(height)), axis=1) / np.sum(centred**2, axis=1)
    c = np.mean(height) - a * x.mean(axis=1)
    parameters = np.stack([a, b, c], axis=1)
    return parameters, mean_squared_error(acceleration, height, parameters)


def fit_hyperbola(acceleration: np.ndarray, height: np.ndarray, bounds: tuple[float, float]) -> Hyperbola:
    """Least-squares fit with B within `bounds` (m/s²), A and C free: the lowest minimum that a scan of B shows.

    Parameters
    ----------
    acceleration, height : data, m/s² and m, shape (n,), n ≥ 3
    bounds : B + â must not change its sign over the data: the pole of Eq. 13 lies outside them
    """
    starts = np.linspace(*bounds, STARTS)
    _, errors = hyperbola_profile(acceleration, height, starts)
    best = int(np.argmin(errors))
    scale = np.ptp(height) or 1.0

    def residuals(b: np.ndarray) -> np.ndarray:
        parameters, _ = hyperbola_profile(acceleration, height, b)
        return (critical_height(acceleration, parameters[0]) - height) / scale

    bracket = starts[max(best - 1, 0)], starts[min(best + 1, STARTS - 1)]
    solution = least_squares(residuals, starts[best], bounds=bracket, jac="3-point", xtol=1e-15, ftol=1e-15, gtol=1e-15)
    parameters, _ = hyperbola_profile(acceleration, height, solution.x)
    return Hyperbola(*map(float, parameters[0]))


def fit_hyperbola_by_pymoo(
    acceleration: np.ndarray, height: np.ndarray, bounds: dict[str, tuple[float, float]], seed: int, evaluations: int
) -> Hyperbola:
    """Fit by CMA-ES (Hansen 2016, in pymoo), which learns the direction of the narrow, curved valley.

    Parameters
    ----------
    acceleration, height : data, m/s² and m, shape (n,), n ≥ 3
    bounds : low and high of "A" (m²/s²), "B" (m/s²) and "C" (m)
    seed : of the random numbers, 0 or above; the same seed gives the same result
    evaluations : largest number of triples to try
    """
    # Slow to import.
    from pymoo.algorithms.soo.nonconvex.cmaes import CMAES
    from pymoo.core.problem import Problem
    from pymoo.optimize import minimize

    low, high = np.array([bounds[name] for name in Hyperbola._fields], dtype=np.float64).T
    # In the unit cube and in units of the data's variance, which suit the algorithm's own scales and tolerances.
    unit = np.var(height) or 1.0

    class Error(Problem):
        def __init__(self):
            super().__init__(n_var=3, n_obj=1, xl=0.0, xu=1.0)

        def _evaluate(self, x, out):
            out["F"] = mean_squared_error(acceleration, height, low + x * (high - low)) / unit

    # The strategy draws from NumPy's global generator and takes seed 0 as a request to seed from the clock.
    result = minimize(Error(), CMAES(x0=np.full(3, 0.5), sigma=0.3), ("n_eval", evaluations), seed=seed + 1)
    return Hyperbola(*map(float, low + result.X * (high - low)))
