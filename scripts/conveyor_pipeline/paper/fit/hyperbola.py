"""The critical initial height over the amplitude as a hyperbola, z0 = A / (B + â) + C (Eq. 13)."""

from typing import NamedTuple

import numpy as np


class Hyperbola(NamedTuple):
    """Parameters of Eq. 13: A (m²/s²), B (m/s²), C (m)."""

    A: float
    B: float
    C: float


def critical_height(acceleration: np.ndarray, parameters: Hyperbola | np.ndarray) -> np.ndarray:
    """z0 in m by Eq. 13 at `acceleration` (m/s², shape (n,)); `parameters` of shape (…, 3) give shape (…, n)."""
    a, b, c = np.moveaxis(np.asarray(parameters, dtype=np.float64)[..., None], -2, 0)
    return a / (b + acceleration) + c


def mean_squared_error(acceleration: np.ndarray, height: np.ndarray, parameters: Hyperbola | np.ndarray) -> np.ndarray:
    """Mean squared error of Eq. 13 in m², shape (…) for `parameters` of shape (…, 3).

    acceleration, height : data, m/s² and m, shape (n,)
    """
    return np.mean((critical_height(acceleration, parameters) - height) ** 2, axis=-1)
