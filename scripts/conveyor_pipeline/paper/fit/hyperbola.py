"""The critical initial height over the amplitude as a hyperbola, z0 = A / (B + â) + C (Eq. 13)."""

from typing import NamedTuple

import numpy as np


class Hyperbola(NamedTuple):
    """Parameters of Eq. 13: A (m²/s²), B (m/s²), C (m)."""

    A: float
    B: float
    C: float


def critical_height(acceleration: np.ndarray, parameters: Hyperbola | np.ndarray) -> np.ndarray:
    """z0 in m by Eq. 13 at `acceleration` (m/s², shape (n,)); `parameters` of shape (…, 3) give shape (…, n).

    Examples
    --------
    >>> critical_height(np.array([30.0, 40.0]), Hyperbola(A=5e-3, B=1.0, C=-5e-5)).round(7).tolist()  # m
    [0.0001113, 7.2e-05]
    """
    a, b, c = np.moveaxis(np.asarray(parameters, dtype=np.float64)[..., None], -2, 0)
    return a / (b + acceleration) + c


def mean_squared_error(acceleration: np.ndarray, height: np.ndarray, parameters: Hyperbola | np.ndarray) -> np.ndarray:
    """Mean squared error of Eq. 13 in m², shape (…) for `parameters` of shape (…, 3).

    acceleration, height : data, m/s² and m, shape (n,)

    Examples
    --------
    >>> amplitudes, hyperbola = np.array([30.0, 40.0]), Hyperbola(A=5e-3, B=1.0, C=-5e-5)
    >>> error = mean_squared_error(amplitudes, critical_height(amplitudes, hyperbola) + 1e-6, hyperbola)
    >>> f"{error:.1e}"  # m²
    '1.0e-12'
    """
    return np.mean((critical_height(acceleration, parameters) - height) ** 2, axis=-1)
