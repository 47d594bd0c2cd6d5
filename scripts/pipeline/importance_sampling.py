"""Adaptive importance sampling of the posterior of a few parameters.

The first points fill the bounds evenly. Each further round draws from a kernel density estimate of the posterior of all
points so far (population Monte Carlo). All points count, each with the density over the mean density of all proposals
(deterministic mixture weights: Owen and Zhou 2000; Cornuet et al. 2012). The even first round bounds the weights.
Because estimates are evaluated at their own points, too, the evidence comes out a few percent too low.

The likelihood is a product of factors. If each of them is estimated from a few simulated parts, two things are added:

- The estimates are noisy, above all in chaos, and a product of many of them would be decided by luck. Therefore each
  factor is averaged over neighbouring points before the product is taken. The average of densities is the density of
  the parts of all neighbours together. It hardly loses information, because a single measurement limits the parameters
  much less than all of them. As little of this is done as needed, because it blurs what few measurements say.
- The search begins with measurements that count as less accurate than they are. A density that is narrow from the
  beginning would be found only by chance.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist
from scipy.special import logsumexp
from scipy.stats import gaussian_kde, qmc

# Standard deviations of the average over neighbours, in units of the standard deviation of the posterior. The narrowest
# one that gives enough effective points counts; wider ones are only tried after more rounds. The second ones are those
# of factors that are known without noise.
NOISY, EXACT = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5), (0.0,)
# Effective points, for each parameter, that the density of a proposal keeps, and the factor by which its power falls if
# even the flattest density keeps fewer.
LEAST, FLATTER = 6.0, 0.8
CENTRES = 500  # most points of a proposal; the time grows with their number
SAME_VOLUME = 0.1  # change of the logarithm of the squared volume of a sample that counts as none
TINY = 1e-300  # density whose logarithm is finite
LIGHT = 1e-6  # share of the largest weight below which a point does not count in a proposal


class Sample(NamedTuple):
    """A weighted sample of a posterior.

    Attributes
    ----------
    points : shape (n, d)
    log_density : logarithm of the density that was sampled, shape (n,)
    weights : shares of the posterior, shape (n,), with the sum 1
    log_evidence : logarithm of the mean density over the bounds
    size : effective number of points
    """

    points: np.ndarray
    log_density: np.ndarray
    weights: np.ndarray
    log_evidence: float
    size: float


def effective_number(weights: np.ndarray) -> float:
    """Effective number of points with these weights, whose sum is 1 (Kish)."""
    return 1.0 / float(np.sum(weights**2))


def normalize(logs: np.ndarray) -> tuple[np.ndarray, float]:
    """Weights with the sum 1 from their logarithms, shape (n,), and their effective number."""
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    return weights, effective_number(weights)


def smoothed(factors: np.ndarray, points: np.ndarray, weights: np.ndarray, width: float) -> np.ndarray:
    """Logarithms of the product of factors after averaging each over neighbouring points, shape (m, n).

    factors : logarithms, shape (m, n, r), for m densities and r factors
    points, weights : shape (n, d) and (n,); the covariance of this sample is the unit of distances
    width : of the neighbourhood in this unit; 0 for no average
    """
    if width == 0.0:
        return factors.sum(axis=-1)
    centred = points - weights @ points
    covariance = (weights[:, None] * centred).T @ centred
    scale = np.linalg.cholesky(covariance + 1e-12 * np.eye(points.shape[1]))
    z = np.linalg.solve(scale, points.T).T / width
    near = np.exp(-0.5 * cdist(z, z, "sqeuclidean"))
    near /= near.sum(axis=1, keepdims=True)
    return np.array([np.log(np.maximum(near @ np.exp(one), TINY)).sum(axis=1) for one in factors])


def flattened(values: np.ndarray, mixture: np.ndarray, least: float) -> np.ndarray:
    """Weights of the first of several densities, shape (m, n), that keeps enough effective points, shape (n,)."""
    for one in values:
        weights, size = normalize(one - mixture)
        if size >= least:
            return weights
    power = 1.0
    while size < least:
        power *= FLATTER
        weights, size = normalize(power * values[-1] - mixture)
    return weights


def settle(
    factors: np.ndarray, points: np.ndarray, mixture: np.ndarray, weights: np.ndarray, width: float, enough: float
) -> Sample:
    """The sample after smoothing in units of its own standard deviation.

    Smoothing in units of a wider sample gives a sample that is too wide, but narrower than that one. The repetition
    ends when the volume hardly changes, or when there are not enough effective points for it.
    """
    volume = math.inf
    while True:
        (values,) = smoothed(factors, points, weights, width)
        weights, size = normalize(values - mixture)
        before, volume = volume, np.linalg.slogdet(np.atleast_2d(np.cov(points.T, aweights=weights, ddof=0)))[1]
        if width == 0.0 or size < enough or not volume < before - SAME_VOLUME:
            return Sample(points, values, weights, float(logsumexp(values - mixture)), size)


def sample(
    log_factors: Callable[[np.ndarray], np.ndarray],
    bounds: np.ndarray,
    *,
    first: int,
    points: int,
    rounds: int,
    enough: float,
    seed: int,
    widths: tuple[float, ...] = NOISY,
    near: np.ndarray | None = None,
) -> Sample:
    """A sample of the posterior with a constant prior within the bounds.

    Parameters
    ----------
    log_factors : function from points, shape (n, d), to logarithms of the factors of the likelihood, shape (m, n, r),
        for the measurements as they are and for m - 1 ever larger inflations of their errors; -inf for what is
        impossible; called once per round
    bounds : lower and upper bounds, shape (2, d)
    first : number of points of the first round
    points : number of points of each further round; those beyond the bounds are dropped
    rounds : largest number of further rounds
    enough : effective number of points at which the search ends
    seed : of the random numbers
    widths : NOISY or EXACT, for factors with and without noise
    near : points of a related posterior, shape (k, d), near which the first of the further rounds draws

    Raises
    ------
    ValueError
        if all points of the first round are impossible
    """
    random = np.random.default_rng(seed)
    low, high = bounds
    volume, dimensions = np.log(high - low).sum(), len(low)
    x = qmc.scale(qmc.Halton(dimensions, rng=random).random(first), low, high)
    factors = log_factors(x)
    if not np.isfinite(factors.sum(axis=-1)).any():
        raise ValueError("no point within the bounds is possible")
    even = np.log(first / points)
    mixture = np.full(first, even)  # logarithm of the sum of all proposals over the even one
    known = flattened(factors.sum(axis=-1), mixture, LEAST * dimensions)
    values = smoothed(factors, x, known, widths[-1])
    proposals: list[gaussian_kde] = []
    while True:
        for width in widths:
            settled = settle(factors[:1], x, mixture, known, width, enough)
            if settled.size >= enough or width >= widths[-1] * len(proposals) / rounds:
                break
        if settled.size >= enough or len(proposals) == rounds:
            # A proposal counts as one in `mixture`, and stands for as many points as a round has.
            return settled._replace(log_evidence=settled.log_evidence - math.log(points))
        if near is not None and not proposals:
            proposals.append(gaussian_kde(near.T))
        else:
            known = flattened(values, mixture, LEAST * dimensions)
            centres = np.flatnonzero(known > LIGHT * known.max())
            if len(centres) > CENTRES:
                centres = random.permutation(centres)[:CENTRES]
            proposals.append(gaussian_kde(x[centres].T, weights=known[centres]))
        new = proposals[-1].resample(points, seed=random).T
        new = new[((new >= low) & (new <= high)).all(axis=1)]
        of_new = [np.full(len(new), even), *(volume + proposal.logpdf(new.T) for proposal in proposals)]
        mixture = np.append(np.logaddexp(mixture, volume + proposals[-1].logpdf(x.T)), logsumexp(of_new, axis=0))
        x, factors = np.vstack([x, new]), np.concatenate([factors, log_factors(new)], axis=1)
        known = flattened(
            smoothed(factors, x, np.append(known, np.zeros(len(new))), widths[-1]), mixture, LEAST * dimensions
        )
        values = smoothed(factors, x, known, widths[-1])
