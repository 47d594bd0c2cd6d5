"""The 0-1 test for chaos of Gottwald and Melbourne, SIAM J. Appl. Dyn. Syst. 8 (2009) 129, for deterministic series."""

from typing import NamedTuple

import numpy as np
from scipy import fft

FREQUENCIES = 100  # random c; the median over them ignores the few that resonate with the series
LARGEST_LAG = 0.1  # share of the series over which the mean square displacement is taken


class ZeroOne(NamedTuple):
    """Result of the 0-1 test.

    Attributes
    ----------
    value : median of the growth rates, near 0 for regular and near 1 for chaotic series
    error : half the distance between their quartiles
    growth : growth rate K_c for each random c, float64, shape (FREQUENCIES,)
    """

    value: float
    error: float
    growth: np.ndarray


def zero_one(series: np.ndarray, seed: int, resolution: float = 0.0) -> ZeroOne:
    """0-1 test of a scalar series, best of stroboscopic samples: oversampled motion looks regular.

    The series drives z(n + 1) = z(n) + φ(n) e^(icn) in the plane, for random c in (π/5, 4π/5). Regular motion leaves z
    bounded, chaos makes it diffuse: K_c is the correlation of the mean square displacement with the lag. φ is centred,
    which removes the oscillating term V_osc of the paper (its Eq. 2.8) where it arises.

    Parameters
    ----------
    series : at least 100 samples
    seed : of the random c
    resolution : a series that varies by no more than this is constant, K = 0; give the accuracy of the samples

    Raises
    ------
    ValueError
        if the series is not one-dimensional, too short or not finite
    """
    series = np.asarray(series, dtype=np.float64)
    if series.ndim != 1 or len(series) < 100 or not np.isfinite(series).all():
        raise ValueError(f"series must be finite and of shape (n,) with n >= 100, got shape {series.shape}")
    if np.ptp(series) <= resolution:
        return ZeroOne(0.0, 0.0, np.zeros(FREQUENCIES))
    c = np.random.default_rng(seed).uniform(np.pi / 5, 4 * np.pi / 5, FREQUENCIES)
    centred = (series - series.mean()) / series.std()
    path = np.cumsum(centred * np.exp(1j * c[:, None] * np.arange(1, len(series) + 1)), axis=1)
    displacement = mean_square_displacement(path, int(LARGEST_LAG * len(series)))
    displacement -= displacement.mean(axis=1, keepdims=True)
    lags = np.arange(displacement.shape[1]) - 0.5 * (displacement.shape[1] - 1)
    growth = displacement @ lags / np.sqrt(np.sum(displacement**2, axis=1) * np.sum(lags**2))
    lower, median, upper = np.percentile(growth, (25, 50, 75))
    return ZeroOne(float(median), float(0.5 * (upper - lower)), growth)


def mean_square_displacement(path: np.ndarray, lags: int) -> np.ndarray:
    """Mean over j < n - lags of |path[:, j + k] - path[:, j]|² for k = 1 … lags; complex (c, n) → float64 (c, lags).

    The mixed terms are a correlation, computed by fast Fourier transform.
    """
    n = path.shape[1]
    length = fft.next_fast_len(n + lags)
    head = fft.fft(path[:, : n - lags], length, axis=1)
    mixed = fft.ifft(fft.fft(path, length, axis=1) * head.conj(), axis=1)[:, 1 : lags + 1].real
    total = np.cumsum(np.abs(path) ** 2, axis=1)
    moved = total[:, n - lags :] - total[:, :lags]
    return (moved + total[:, n - lags - 1, None] - 2.0 * mixed) / (n - lags)
