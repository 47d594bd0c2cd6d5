"""Adaptive importance sampling of the posterior of a few parameters, by several independent searches.

The first points of a search fill the bounds evenly, or lie near a related posterior. Each further round draws from a
kernel density estimate of the posterior of all points so far (population Monte Carlo). All points count, each with the
density over the mean density of all proposals (deterministic mixture weights: Owen and Zhou 2000; Cornuet et al. 2012).
An even first round bounds the weights. Because estimates are evaluated at their own points, too, the evidence comes out
a few percent too low.

The likelihood is a product of factors. If each of them is estimated from a few simulated parts, two things are added:

- The estimates are noisy, above all in chaos, and a product of many of them would be decided by luck. Therefore each
  factor is averaged over neighbouring points before the product is taken. The average of densities is the density of
  the parts of all neighbours together. It hardly loses information, because a single measurement limits the parameters
  much less than all of them. As little of this is done as needed, because it blurs what few measurements say.
- The search begins with measurements that count as less accurate than they are. A density that is narrow from the
  beginning would be found only by chance.

What one search misses, or finds by luck, another one with other random numbers shows. The samples of all searches
together are the posterior, and the difference that each search makes gives the Monte Carlo error of any summary.

No sum depends on the processor (see conveyor.linear_algebra), because its last digit would decide which points are
drawn next. `einsum` runs without BLAS, and in one order, as long as it is not told to optimise.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist
from scipy.stats import qmc

from conveyor.elementary import exp, log
from conveyor.linear_algebra import cholesky, product, solve

# Standard deviations of the average over neighbours, in units of the standard deviation of the posterior. The narrowest
# one that gives enough effective points counts; wider ones are only tried after more rounds.
WIDTHS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
# A search that does not have enough effective points after its rounds goes on for up to this multiple of them, with the
# widest average. It may have found a narrow maximum late, which the others have missed.
LONGER = 2
# Effective points that the density of a proposal keeps, for each parameter and as a share of a round, and the factor by
# which its power falls if even the flattest density keeps fewer. With fewer points, searches in a narrow valley all
# miss its ends, so that the difference between them does not show it.
LEAST, LEAST_SHARE, FLATTER = 6.0, 0.18, 0.8
CENTRES = 500  # most points of a proposal; the time grows with their number
SAME_VOLUME = 0.1  # change of the logarithm of the squared volume of a sample that counts as none
TINY = 1e-300  # density whose logarithm is finite
LIGHT = 1e-6  # share of the largest weight below which a point does not count in a proposal
RIDGE = 1e-12  # added to variances, so that equal points have a covariance of full rank


class Sample(NamedTuple):
    """A weighted sample of a posterior.

    Attributes
    ----------
    points : shape (n, d)
    log_density : logarithm of the density that was sampled, shape (n,)
    weights : shares of the posterior, shape (n,), with the sum 1
    log_evidence : logarithm of the mean density over the bounds
    size : effective number of points
    search : number of the search in which each point was found, shape (n,)
    """

    points: np.ndarray
    log_density: np.ndarray
    weights: np.ndarray
    log_evidence: float
    size: float
    search: np.ndarray


class Kernels(NamedTuple):
    """A kernel density estimate: normal densities of one covariance L Lᵀ around weighted centres."""

    centres: np.ndarray  # shape (k, d)
    weights: np.ndarray  # shape (k,), with the sum 1
    lower: np.ndarray  # L, shape (d, d)


def effective_number(weights: np.ndarray) -> float:
    """Effective number of points with these weights, whose sum is 1 (Kish)."""
    return 1.0 / float(np.sum(weights**2))


def log_sum(logs: np.ndarray) -> np.ndarray:
    """Logarithm of the sum along the last axis of numbers that are given by their logarithms."""
    largest = logs.max(axis=-1)
    shift = np.where(np.isfinite(largest), largest, 0.0)
    return log(np.sum(exp(logs - shift[..., None]), axis=-1)) + shift


def normalize(logs: np.ndarray) -> tuple[np.ndarray, float]:
    """Weights with the sum 1 from their logarithms, shape (n,), and their effective number."""
    weights = exp(logs - logs.max())
    weights /= weights.sum()
    return weights, effective_number(weights)


def covariance(points: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Covariance of weighted points, shape (d, d)."""
    centred = points - product(weights, points)
    return product((weights[:, None] * centred).T, centred)


def whitened(points: np.ndarray, lower: np.ndarray) -> np.ndarray:
    """Points, shape (n, d), in coordinates in which a covariance L Lᵀ is the unit matrix."""
    return solve(lower, points.T).T


def smoothed(factors: np.ndarray, points: np.ndarray, weights: np.ndarray, width: float) -> np.ndarray:
    """Logarithm of the product of factors after averaging each over neighbouring points, shape (n,).

    factors : logarithms, shape (n, r), for r factors
    points, weights : shape (n, d) and (n,); the covariance of this sample is the unit of distances
    width : of the neighbourhood in this unit; 0 for no average
    """
    if width == 0.0:
        return factors.sum(axis=-1)
    lower = cholesky(covariance(points, weights) + RIDGE * np.eye(points.shape[1]))
    z = whitened(points, lower) / width
    near = exp(-0.5 * cdist(z, z, "sqeuclidean"))
    near /= near.sum(axis=1, keepdims=True)
    return log(np.maximum(np.einsum("ij,jr->ir", near, exp(factors)), TINY)).sum(axis=1)


def flattened(
    densities: Callable[[int], np.ndarray], count: int, mixture: np.ndarray, enough: float, is_even: bool
) -> np.ndarray:
    """Weights, shape (n,), of the first of several densities that keeps enough effective points.

    If none does, the one that keeps most is flattened further. A power of the density keeps enough points if some of
    them fill the bounds evenly. Otherwise a power of the ratio of density and proposals is taken, which leads from the
    proposals to the density; a power of 0 keeps all points, so that at most half of the possible ones are demanded.

    densities : function from 0 … count - 1 to logarithms of a density, shape (n,), each flatter than the one before
    mixture : logarithm of the proposals, shape (n,)
    is_even : whether the first proposal fills the bounds evenly
    """
    largest_size = 0.0
    for place in range(count):
        density = densities(place)
        weights, size = normalize(density - mixture)
        if size >= enough:
            return weights
        if size > largest_size:
            largest_size, best_density = size, density
    if not is_even:
        enough = min(enough, 0.5 * np.isfinite(best_density).sum())
    power = 1.0
    while size < enough:
        power *= FLATTER
        weights, size = normalize(power * best_density - mixture if is_even else power * (best_density - mixture))
    return weights


def settle(
    factors: np.ndarray, points: np.ndarray, mixture: np.ndarray, weights: np.ndarray, width: float, enough: float
) -> Sample:
    """The sample after smoothing in units of its own standard deviation.

    Smoothing in units of a wider sample gives a sample that is too wide, but narrower than that one. The repetition
    ends when the volume hardly changes, or when there are not enough effective points for it.
    """
    volume = math.inf
    ridge = RIDGE * np.eye(points.shape[1])
    while True:
        values = smoothed(factors, points, weights, width)
        weights, size = normalize(values - mixture)
        before = volume
        volume = 2.0 * float(np.sum(log(np.diagonal(cholesky(covariance(points, weights) + ridge)))))
        if width == 0.0 or size < enough or not volume < before - SAME_VOLUME:
            none = np.zeros(len(points), dtype=np.int64)
            return Sample(points, values, weights, float(log_sum(values - mixture)), size, none)


def kernels(points: np.ndarray, weights: np.ndarray) -> Kernels:
    """The kernel density estimate of weighted points, with Scott's width."""
    weights = weights / weights.sum()
    size, dimensions = effective_number(weights), points.shape[1]
    factor = size ** (-1.0 / (dimensions + 4.0))
    spread = covariance(points, weights) / (1.0 - 1.0 / size) if size > 1.0 else np.zeros((dimensions, dimensions))
    return Kernels(points, weights, factor * cholesky(spread + RIDGE * np.eye(dimensions)))


def draw_from(density: Kernels, count: int, random: np.random.Generator) -> np.ndarray:
    """Points drawn from a kernel density estimate, shape (count, d)."""
    chosen = random.choice(len(density.weights), count, p=density.weights)
    steps = random.standard_normal((count, density.centres.shape[1]))
    return density.centres[chosen] + product(steps, density.lower.T)


def log_kernels(density: Kernels, points: np.ndarray) -> np.ndarray:
    """Logarithm of a kernel density estimate at points of shape (n, d), shape (n,)."""
    distances = cdist(*(whitened(vectors, density.lower) for vectors in (points, density.centres)), "sqeuclidean")
    scale = float(np.sum(log(np.diagonal(density.lower)))) + 0.5 * len(density.lower) * math.log(2.0 * math.pi)
    return log_sum(log(density.weights) - 0.5 * distances) - scale


def sample(
    log_factors: Callable[[np.ndarray], np.ndarray],
    bounds: np.ndarray,
    *,
    first: int,
    points: int,
    rounds: int,
    enough: float,
    seed: int | list[int],
    near: tuple[np.ndarray, np.ndarray] | None = None,
) -> Sample:
    """A sample of the posterior with a constant prior within the bounds, by one search.

    Parameters
    ----------
    log_factors : function from points, shape (n, d), to logarithms of the factors of the likelihood, shape (m, n, r),
        for the measurements as they are and for m - 1 ever larger inflations of their errors; -inf for what is
        impossible; called once per round
    bounds : lower and upper bounds, shape (2, d)
    first : number of points of the first round, which fills the bounds evenly, or lies near a related posterior
    points : number of points of each further round; those beyond the bounds are dropped
    rounds : number of further rounds over which averages become wider; after LONGER times as many, the search ends
    enough : effective number of points at which the search ends
    seed : of the random numbers
    near : points of a related posterior, shape (k, d), and their weights, shape (k,)

    Raises
    ------
    ValueError
        if all points of the first round are impossible
    """
    random = np.random.default_rng(seed)
    low, high = bounds
    volume = float(np.sum(log(high - low)))
    dimensions = len(low)
    proposals: list[Kernels | None] = []  # None: even
    shares: list[float] = []  # logarithms of the numbers of their points, relative to those of a round

    def propose(density: Kernels | None, count: int) -> np.ndarray:
        """New points within the bounds, shape (n, d), with n up to `count`."""
        proposals.append(density)
        shares.append(math.log(count / points))
        if density is None:
            return qmc.scale(qmc.Halton(dimensions, rng=random).random(count), low, high)
        drawn = draw_from(density, count, random)
        return drawn[((drawn >= low) & (drawn <= high)).all(axis=1)]

    def log_proposal(place: int, vectors: np.ndarray) -> np.ndarray:
        """Logarithm of the density of a proposal over the even one, times its share."""
        density = proposals[place]
        return shares[place] + (np.zeros(len(vectors)) if density is None else volume + log_kernels(density, vectors))

    x = propose(None if near is None else kernels(*near), first)
    factors = log_factors(x)
    if not np.isfinite(factors.sum(axis=-1)).any():
        raise ValueError("no point within the bounds is possible")
    mixture = log_proposal(0, x)  # logarithm of the sum of all proposals
    needed = max(LEAST * dimensions, LEAST_SHARE * points)

    def tempered(known: np.ndarray, width: float) -> np.ndarray:
        """Weights of the least inflated density that keeps enough effective points, smoothed in units of `known`."""

        def density(place: int) -> np.ndarray:
            return smoothed(factors[place], x, known, width)

        return flattened(density, len(factors), mixture, needed, near is None)

    known = tempered(np.full(len(x), 1.0 / len(x)), 0.0)
    while True:
        done = len(proposals) - 1
        for width in WIDTHS:
            settled = settle(factors[0], x, mixture, known, width, enough)
            if settled.size >= enough or width >= WIDTHS[-1] * done / rounds:
                break
        if settled.size >= enough or done == LONGER * rounds:
            # A proposal counts as one in `mixture`, and stands for as many points as a round has.
            return settled._replace(log_evidence=settled.log_evidence - math.log(points))
        known = tempered(known, WIDTHS[-1])
        centres = np.flatnonzero(known > LIGHT * known.max())
        if len(centres) > CENTRES:
            centres = random.permutation(centres)[:CENTRES]
        new = propose(kernels(x[centres], known[centres]), points)
        of_old = np.column_stack([mixture, log_proposal(-1, x)])
        of_new = np.column_stack([log_proposal(place, new) for place in range(len(proposals))])
        mixture = np.append(log_sum(of_old), log_sum(of_new))
        x, factors = np.vstack([x, new]), np.concatenate([factors, log_factors(new)], axis=1)
        known = tempered(np.append(known, np.zeros(len(new))), WIDTHS[-1])


def pooled(samples: list[Sample]) -> Sample:
    """One sample from several searches of the same posterior; each counts with its evidence."""
    evidences = np.array([sample.log_evidence for sample in samples])
    shares, _ = normalize(evidences)
    weights = np.concatenate([share * sample.weights for share, sample in zip(shares, samples, strict=True)])
    counts = [len(sample.points) for sample in samples]
    return Sample(
        np.vstack([sample.points for sample in samples]),
        np.concatenate([sample.log_density for sample in samples]),
        weights,
        float(log_sum(evidences)) - math.log(len(samples)),
        effective_number(weights),
        np.repeat(np.arange(len(samples)), counts),
    )


def monte_carlo_error(
    weights: np.ndarray, search: np.ndarray, summary: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """Standard error of a summary by the jackknife over the searches (Efron and Stein 1981), of the summary's shape.

    If one search has all weights, the error is infinite.

    weights, search : of all points, and the number of the search that has found each of them, shape (n,)
    summary : function of the weights
    """
    searches = np.unique(search)
    all_weights = weights
    without = []
    for number in searches:
        weights = np.where(search == number, 0.0, all_weights)
        if weights.sum() == 0.0:
            return np.full_like(summary(all_weights), math.inf)
        without.append(summary(weights / weights.sum()))
    count = len(searches)
    deviations = np.array(without) - np.mean(without, axis=0)
    return np.sqrt((count - 1) / count * np.sum(deviations**2, axis=0))
