"""The displacement along the track as a random walk: its drift and its diffusion coefficient.

Over many cycles, the displacement of a chaotic motion is a random walk with a drift. Its variance grows as 2 D t, where
the diffusion coefficient D is half the integral of the autocorrelation of the velocity (Green 1954, Kubo 1957). Here
the integral is a sum over excitation cycles: the variance of the displacement in a window of w cycles is
w (C_0 + 2 Σ (1 - k/w) C_k), with the autocovariance C_k of the displacements in single cycles.
"""

from typing import NamedTuple

import numpy as np

# Largest correlation of the displacements in neighbouring windows that counts as none, besides two standard errors.
DECAYED = 0.05
# The window is this many times longer than the shortest one without correlations, because they decay with its length.
LONGER = 4
LEAST_WINDOWS = 8  # in one run
DEFAULT_WINDOW = 2  # cycles, the shortest window: a motion that alternates between two bands has none in one cycle
OK, CORRELATED, NO_FLUCTUATIONS = RANDOM_WALK_STATUS = ("ok", "correlations do not decay", "no fluctuations")


class RandomWalk(NamedTuple):
    """Drift of a random walk and its diffusion coefficient, with standard errors, from several runs.

    The numbers of the diffusion are NaN unless the status is "ok".
    """

    velocity: float  # m/s
    velocity_stderr: float  # m/s
    diffusion: float  # m²/s
    diffusion_stderr: float  # m²/s
    window: int  # cycles after which displacements are uncorrelated; 0 for none
    status: str  # one of RANDOM_WALK_STATUS


def sums_over(displacements: np.ndarray, window: int) -> np.ndarray:
    """Displacements in windows of so many cycles, shape (n, k // window), of runs, shape (n, k)."""
    count = displacements.shape[1] // window
    return displacements[:, : count * window].reshape(len(displacements), count, window).sum(axis=2)


def standard_error(values: np.ndarray) -> float:
    """The standard error of the mean of independent values, shape (n,)."""
    return float(values.std(ddof=1) / np.sqrt(len(values)))


def uncorrelated_window(fluctuations: np.ndarray) -> int:
    """The shortest window above which displacements have no correlations; 0 for none.

    Only windows of DEFAULT_WINDOW times a power of two are tried. Correlations may come back in longer windows: a
    bounded displacement has negative correlations only there.

    fluctuations : displacements in single cycles without their mean, shape (n, k)
    """
    enough = 0
    window = DEFAULT_WINDOW
    while fluctuations.shape[1] // window >= LEAST_WINDOWS:
        sums = sums_over(fluctuations, window)
        neighbours = sums[:, 1:] * sums[:, :-1]
        if abs(neighbours.mean()) > (DECAYED + 2.0 / np.sqrt(neighbours.size)) * (sums**2).mean():
            enough = 0
        elif enough == 0:
            enough = window
        window *= 2
    return enough if LONGER * enough < window else 0


def random_walk(displacements: np.ndarray, period: float) -> RandomWalk:
    """The drift and the diffusion coefficient of a motion.

    Parameters
    ----------
    displacements : along the track in each excitation cycle, m, of n > 1 independent runs over k cycles, shape (n, k)
    period : of the excitation, s

    Returns
    -------
    RandomWalk, whose status says whether a diffusion coefficient exists

    Examples
    --------
    >>> displacements = np.random.default_rng(1).normal(1e-3, 1e-4, (8, 1024))  # m
    >>> walk = random_walk(displacements, period=0.02)
    >>> walk.status, round(float(walk.velocity), 4)  # m/s
    ('ok', 0.05)
    >>> abs(walk.diffusion - 0.5 * 1e-4**2 / 0.02) < 3.0 * walk.diffusion_stderr
    True
    """
    of_run = displacements.mean(axis=1) / period
    mean = displacements.mean()
    walk = RandomWalk(mean / period, standard_error(of_run), np.nan, np.nan, 0, CORRELATED)
    fluctuations = displacements - mean
    # Displacements are differences of positions, which rounding leaves with an error.
    if np.abs(fluctuations).max() <= 1e-9 * np.abs(displacements).max():
        return walk._replace(status=NO_FLUCTUATIONS)
    window = uncorrelated_window(fluctuations)
    if window == 0:
        return walk
    window *= LONGER
    variance = (sums_over(fluctuations, window) ** 2).mean(axis=1)
    diffusion = variance / (2.0 * window * period)
    return walk._replace(
        diffusion=float(diffusion.mean()), diffusion_stderr=standard_error(diffusion), window=window, status=OK
    )


def relative_spread(velocity: float, diffusion: float, length: float, deviations: float) -> float:
    """Spread of transit velocities over a length (m), over their mean, between the quantiles of a normal distribution
    that lie `deviations` standard deviations below and above the mean.

    The time of a random walk with the drift v to the length L has the variance 2 D L/v³.

    velocity, diffusion : drift (m/s) and diffusion coefficient (m²/s), from `random_walk`

    Examples
    --------
    >>> round(float(relative_spread(0.05, 1e-5, length=0.5, deviations=1.0)), 4)
    0.0566
    """
    return 2.0 * deviations * np.sqrt(2.0 * diffusion / (np.abs(velocity) * length))
