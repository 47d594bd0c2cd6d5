"""Posteriors of a few parameters by adaptive importance sampling.

The first points fill the bounds evenly. Each further round draws from a kernel density estimate of the posterior of all
points so far (population Monte Carlo). All points count, each with the density over the mean density of all proposals
(deterministic mixture weights: Owen and Zhou 2000; Cornuet et al. 2012). The even first round bounds the weights.
Because estimates are evaluated at their own points, too, the evidence comes out a few percent too low.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp
from scipy.stats import gaussian_kde, qmc

# Effective points for a kernel density estimate, for each parameter. Fewer points get a flatter density.
ENOUGH = 10.0
# Points of a kernel density estimate, drawn by their weights; the time grows with their number.
CENTRES = 500
# An interval is open at an end that is nearer to the bound than this share of its length.
NEAR = 0.05

LogDensity = Callable[[np.ndarray], np.ndarray]


class Sample(NamedTuple):
    """A weighted sample of a posterior.

    Attributes
    ----------
    points : shape (n, d)
    log_density : logarithm of the density that was sampled, shape (n,)
    weights : shares of the posterior, shape (n,), with the sum 1
    log_evidence : logarithm of the mean density over the bounds
    size : effective number of points; below about 100, intervals are not reliable
    """

    points: np.ndarray
    log_density: np.ndarray
    weights: np.ndarray
    log_evidence: float
    size: float


class Interval(NamedTuple):
    """A credible interval. An end is open if it lies at a bound, so that only the bound limits it."""

    low: float
    high: float
    open_low: bool
    open_high: bool


def normalize(logs: np.ndarray) -> tuple[np.ndarray, float]:
    """Weights with the sum 1 from their logarithms, shape (n,), and their effective number."""
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    return weights, 1.0 / float(np.sum(weights**2))


def sample(log_density: LogDensity, bounds: np.ndarray, *, points: int, rounds: int, seed: int) -> Sample:
    """A sample of the posterior with a constant prior within the bounds.

    Parameters
    ----------
    log_density : function from points, shape (n, d), to logarithms of the likelihood, shape (n,), -inf for impossible
        points; called once for each round
    bounds : lower and upper bounds, shape (2, d)
    points : number of points of each round; those beyond the bounds are dropped
    rounds : number of rounds after the first one
    seed : of the random numbers

    Raises
    ------
    ValueError
        if all points of the first round are impossible
    """
    random = np.random.default_rng(seed)
    low, high = bounds
    volume, dimensions = np.log(high - low).sum(), len(low)
    x = qmc.scale(qmc.Halton(dimensions, rng=random).random(points), low, high)
    values = log_density(x)
    if not (values > -np.inf).any():
        raise ValueError("no point within the bounds is possible")
    mixture = np.zeros(points)  # logarithm of the sum of all proposals over the even one
    proposals: list[gaussian_kde] = []
    for _ in range(rounds):
        flatness = 1.0
        weights, size = normalize(values - mixture)
        while size < ENOUGH * dimensions:
            flatness *= 0.5
            weights, size = normalize(flatness * values - mixture)
        proposals.append(gaussian_kde(x[random.choice(len(x), CENTRES, p=weights)].T))
        new = proposals[-1].resample(points, seed=random).T
        new = new[((new >= low) & (new <= high)).all(axis=1)]
        of_new = [np.zeros(len(new)), *(volume + proposal.logpdf(new.T) for proposal in proposals)]
        mixture = np.append(np.logaddexp(mixture, volume + proposals[-1].logpdf(x.T)), logsumexp(of_new, axis=0))
        x, values = np.vstack([x, new]), np.append(values, log_density(new))
    weights, size = normalize(values - mixture)
    evidence = logsumexp(values - mixture) - np.log(points)
    return Sample(x, values, weights, float(evidence), size)


def interval(values: np.ndarray, weights: np.ndarray, bounds: tuple[float, float], confidence: float) -> Interval:
    """The central credible interval of one parameter.

    Parameters
    ----------
    values, weights : of the sample, shape (n,)
    bounds : of the parameter, on the scale of the values
    confidence : share of the posterior in the interval
    """
    ends = [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence]
    low, high = np.quantile(values, ends, weights=weights, method="inverted_cdf")
    near = NEAR * (high - low)
    return Interval(float(low), float(high), bool(low - bounds[0] < near), bool(bounds[1] - high < near))
