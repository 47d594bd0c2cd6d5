"""The 0-1 test for chaos of Gottwald and Melbourne, SIAM J. Appl. Dyn. Syst. 8 (2009) 129, for deterministic series."""

import numpy as np

from ...solver.jit import compiled

FREQUENCIES = 100  # random c; the median over them ignores the few that resonate with the series
LARGEST_LAG = 0.1  # share of the series over which the mean square displacement is taken


def zero_one(series: np.ndarray, seed: int, resolution: float = 0.0) -> float:
    """0-1 test of a scalar series: K, near 0 for regular and near 1 for chaotic motion.

    Best is a series of stroboscopic samples, because oversampled motion looks regular. The series drives
    z(n + 1) = z(n) + φ(n) e^(icn) in the plane, for random c in (π/5, 4π/5). Regular motion leaves z bounded, chaos
    makes it diffuse. K is the median over c of K_c, the correlation of the mean square displacement with the lag. φ is
    centred, which removes the oscillating term V_osc of the paper (its Eq. 2.8) where it arises. ValueError if the
    series is not one-dimensional, too short or not finite.

    Parameters
    ----------
    series : float64, shape (n,), at least 100 samples
    seed : of the random c
    resolution : a series that varies by no more than this is constant, K = 0; give the accuracy of the samples

    Examples
    --------
    >>> rows = parameter_table(Conveyor(), acceleration=[40.0, 80.0], z0=3e-4)
    >>> [round(zero_one(strobes(row, 600, 1e-10)[200:, 0], 1, 1e-12)) for row in rows]
    [0, 1]
    """
    series = np.asarray(series, dtype=np.float64)
    if series.ndim != 1 or len(series) < 100 or not np.isfinite(series).all():
        raise ValueError(f"series must be finite and of shape (n,) with n >= 100, got shape {series.shape}")
    if np.ptp(series) <= resolution:
        return 0.0
    c = np.random.default_rng(seed).uniform(np.pi / 5, 4 * np.pi / 5, FREQUENCIES)
    centred = (series - series.mean()) / series.std()
    displacement = mean_square_displacement(centred, c, int(LARGEST_LAG * len(series)))
    displacement -= displacement.mean(axis=1, keepdims=True)
    lags = np.arange(displacement.shape[1]) - 0.5 * (displacement.shape[1] - 1)
    growth = np.sum(displacement * lags, axis=1) / np.sqrt(np.sum(displacement**2, axis=1) * np.sum(lags**2))
    return float(np.percentile(growth, 50))


@compiled
def mean_square_displacement(series, c, lags):
    """Mean over j < n - lags of |z(j + k) - z(j)|² for k = 1 … lags and each c, float64, shape (len(c), lags).

    Each square is the sum of cos(c l) φ(i) φ(i + l) over all pairs of samples between the two times. All c share the
    products of samples.
    """
    windows = len(series) - lags
    sums = np.zeros((lags, len(c)))
    for lag in range(lags):
        weights = (2.0 if lag > 0 else 1.0) * np.cos(lag * c)
        # Sums over j: of the pairs that begin with the sample number `first` between the two times, and of all up
        # to that one.
        products = pairs = 0.0
        for j in range(windows):
            products += series[j + 1] * series[j + 1 + lag]
        for first in range(lags - lag):
            if first > 0:
                old, new = first, first + windows
                products += series[new] * series[new + lag] - series[old] * series[old + lag]
            pairs += products
            for i in range(len(c)):
                sums[first + lag, i] += weights[i] * pairs
    return sums.T / windows
