"""Fit of the critical initial height by a hyperbola, z0 = A / (B + â) + C (Eq. 13), and how well it is determined.

For given B the problem is linear in A and C, and exactly solved (variable projection): `hyperbola_profile` gives the
best error over B, a valley along which very different triples fit almost equally well; `fit_hyperbola` goes to its
bottom. `fit_hyperbola_by_pymoo` searches in all three parameters as the paper does, by an evolution strategy.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from conveyor_pipeline.paper.fit.hyperbola import Hyperbola, critical_height, mean_squared_error

STARTS = 100  # values of B at which the valley is searched for its minima


class Fit(NamedTuple):
    """Result of a fit.

    Attributes
    ----------
    parameters : the best triple
    error : its mean squared error, m²
    evaluations : number of triples (values of B for `fit_hyperbola`) whose error was computed
    history : best error so far, m², over the number of evaluations, float64, shape (steps, 2)
    """

    parameters: Hyperbola
    error: float
    evaluations: int
    history: np.ndarray


def hyperbola_profile(acceleration: np.ndarray, height: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The valley: the best triple for each value of B, and its error.

    Parameters
    ----------
    acceleration, height : data, m/s² and m, shape (n,)
    b : values of B, m/s², shape (k,)

    Returns
    -------
    parameters, errors : float64, shape (k, 3), A (m²/s²), B (m/s²) and C (m); and mean squared errors, m², shape (k,)

    Examples
    --------
    >>> amplitudes = np.linspace(25.0, 50.0, 20)
    >>> heights = critical_height(amplitudes, Hyperbola(5e-3, 1.0, -5e-5))
    >>> parameters, errors = hyperbola_profile(amplitudes, heights, np.array([0.0, 1.0]))
    >>> parameters[:, 0].round(5).tolist(), bool(errors[1] < errors[0])
    ([0.00472, 0.005], True)
    """
    x = 1.0 / (np.asarray(b, dtype=np.float64)[:, None] + acceleration)
    centred = x - x.mean(axis=1, keepdims=True)
    a = np.sum(centred * (height - np.mean(height)), axis=1) / np.sum(centred**2, axis=1)
    c = np.mean(height) - a * x.mean(axis=1)
    parameters = np.stack([a, b, c], axis=1)
    return parameters, mean_squared_error(acceleration, height, parameters)


def fit_hyperbola(acceleration: np.ndarray, height: np.ndarray, bounds: tuple[float, float]) -> Fit:
    """Least-squares fit with B within `bounds` (m/s²), A and C free: the lowest minimum that a scan of B shows.

    ValueError if the data or the bounds cannot be used.

    Parameters
    ----------
    acceleration, height : data, m/s² and m, shape (n,), n ≥ 3
    bounds : B + â must not change its sign over the data: the pole of Eq. 13 lies outside them

    Examples
    --------
    >>> amplitudes = np.linspace(25.0, 50.0, 20)
    >>> fit = fit_hyperbola(amplitudes, critical_height(amplitudes, Hyperbola(5e-3, 1.0, -5e-5)), (-20.0, 20.0))
    >>> round(fit.parameters.A, 6), round(fit.parameters.B, 4)
    (0.005, 1.0)
    """
    acceleration, height = check_data(acceleration, height, bounds)
    starts = np.linspace(*bounds, STARTS)
    _, errors = hyperbola_profile(acceleration, height, starts)
    best = int(np.argmin(errors))
    scale = np.ptp(height) or 1.0

    def residuals(b: np.ndarray) -> np.ndarray:
        parameters, _ = hyperbola_profile(acceleration, height, b)
        return (critical_height(acceleration, parameters[0]) - height) / scale

    bracket = starts[max(best - 1, 0)], starts[min(best + 1, STARTS - 1)]
    solution = least_squares(residuals, starts[best], bounds=bracket, jac="3-point", xtol=1e-15, ftol=1e-15, gtol=1e-15)
    parameters, error = hyperbola_profile(acceleration, height, solution.x)
    evaluations = STARTS + 3 * solution.nfev
    history = np.array([[STARTS, errors[best]], [evaluations, error[0]]])
    return Fit(Hyperbola(*map(float, parameters[0])), float(error[0]), evaluations, history)


def fit_hyperbola_by_pymoo(
    acceleration: np.ndarray, height: np.ndarray, bounds: dict[str, tuple[float, float]], seed: int, evaluations: int
) -> Fit:
    """Fit by CMA-ES (Hansen 2016, in pymoo), which learns the direction of the narrow, curved valley.

    ValueError if the data or the bounds cannot be used, ModuleNotFoundError without the extra `fit`.

    Parameters
    ----------
    acceleration, height : data, m/s² and m, shape (n,), n ≥ 3
    bounds : low and high of "A" (m²/s²), "B" (m/s²) and "C" (m); see `fit_hyperbola` for B
    seed : of the random numbers, 0 or above; the same seed gives the same result
    evaluations : largest number of triples to try

    Examples
    --------
    >>> amplitudes = np.linspace(25.0, 50.0, 20)
    >>> heights = critical_height(amplitudes, Hyperbola(5e-3, 1.0, -5e-5))
    >>> bounds = {"A": (1e-3, 1e-2), "B": (-10.0, 10.0), "C": (-1e-4, 0.0)}
    >>> fit = fit_hyperbola_by_pymoo(amplitudes, heights, bounds, seed=1, evaluations=2000)
    >>> round(fit.parameters.A, 6), round(fit.parameters.B, 4)
    (0.005, 1.0)
    """
    # Slow to import.
    from pymoo.algorithms.soo.nonconvex.cmaes import CMAES
    from pymoo.core.problem import Problem
    from pymoo.optimize import minimize

    acceleration, height = check_data(acceleration, height, bounds["B"])
    low, high = np.array([bounds[name] for name in Hyperbola._fields], dtype=np.float64).T
    # In the unit cube and in units of the data's variance, which suit the algorithm's own scales and tolerances.
    unit = np.var(height) or 1.0

    class Error(Problem):
        def __init__(self):
            super().__init__(n_var=3, n_obj=1, xl=0.0, xu=1.0)

        def _evaluate(self, x, out):
            out["F"] = mean_squared_error(acceleration, height, low + x * (high - low)) / unit

    history = []

    def record(algorithm):
        history.append((algorithm.evaluator.n_eval, float(algorithm.opt[0].F[0]) * unit))

    # The strategy draws from NumPy's global generator and takes seed 0 as a request to seed from the clock.
    result = minimize(
        Error(), CMAES(x0=np.full(3, 0.5), sigma=0.3), ("n_eval", evaluations), seed=seed + 1, callback=record
    )
    parameters = low + result.X * (high - low)
    error = float(mean_squared_error(acceleration, height, parameters))
    return Fit(Hyperbola(*map(float, parameters)), error, int(result.algorithm.evaluator.n_eval), np.array(history))


def check_data(
    acceleration: np.ndarray, height: np.ndarray, bounds: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """The data as float64 arrays; ValueError if the data or the bounds of B cannot be used."""
    acceleration, height = np.asarray(acceleration, dtype=np.float64), np.asarray(height, dtype=np.float64)
    if acceleration.ndim != 1 or acceleration.shape != height.shape or len(np.unique(acceleration)) < 3:
        raise ValueError("acceleration and height must have one shape (n,) with at least three different accelerations")
    if not (np.isfinite(acceleration).all() and np.isfinite(height).all()):
        raise ValueError("acceleration and height must be finite")
    low, high = bounds
    if not low < high or (low + acceleration.min()) * (high + acceleration.max()) <= 0.0:
        raise ValueError(f"bounds of B = {bounds!r} m/s² must be ascending and keep B + acceleration from zero")
    return acceleration, height
