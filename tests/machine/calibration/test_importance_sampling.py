"""Importance sampling of posteriors with known moments and evidence, from factors with and without noise."""

import math

import numpy as np
import pytest

from conveyor_pipeline.machine.calibration import importance_sampling
from conveyor_pipeline.machine.calibration.importance_sampling import (
    Sample,
    effective_number,
    flattened,
    monte_carlo_error,
    pooled,
    sample,
)

BOUNDS = np.array([[-5.0, -5.0, -5.0], [5.0, 5.0, 5.0]])
OPTIONS = {"first": 500, "points": 500, "rounds": 3, "enough": math.inf, "seed": 1}
# A narrow valley: the standard deviations are 1, 0.1 and 0.5, and the first two parameters are correlated.
COVARIANCE = np.array([[1.0, 0.09, 0.0], [0.09, 0.01, 0.0], [0.0, 0.0, 0.25]])
MEAN = np.array([0.5, -1.0, 2.0])


@pytest.fixture
def exact(monkeypatch):
    """Factors that are known without noise are not averaged over neighbours."""
    monkeypatch.setattr(importance_sampling, "WIDTHS", (0.0,))


def one_factor(log_density):
    """The factors of a likelihood with this logarithm."""
    return lambda points: log_density(points)[None, :, None]


def valley(x):
    y = x - MEAN
    return -0.5 * np.einsum("ni,ij,nj->n", y, np.linalg.inv(COVARIANCE), y)


@pytest.mark.usefixtures("exact")
def test_moments_and_evidence_of_a_narrow_valley():
    found = sample(one_factor(valley), BOUNDS, **OPTIONS)
    assert found.size > 500
    mean = found.weights @ found.points
    assert mean == pytest.approx(MEAN, abs=0.1)
    y = found.points - mean
    assert (found.weights[:, None] * y).T @ y == pytest.approx(COVARIANCE, abs=0.1)
    volume = np.sqrt((2.0 * np.pi) ** 3 * np.linalg.det(COVARIANCE))
    assert np.exp(found.log_evidence) == pytest.approx(volume / 1e3, rel=0.1)


@pytest.mark.long  # twelve searches
@pytest.mark.usefixtures("exact")
def test_searches_reach_the_narrow_end_of_a_bent_valley():
    """The first parameter is normal with the standard deviation 0.4; the others follow it in ever wider valleys."""
    bounds = np.array([[-1.5, -1.5, -1.5], [1.5, 1.5, 1.5]])

    def bent(points):
        x, y, z = points.T
        width = 0.012 * np.exp(x)
        across = ((y - 0.8 * x + 0.1 * x**2) / width) ** 2 + ((z - 0.8 * x) / 0.03) ** 2
        return -0.5 * ((x / 0.4) ** 2 + across) - np.log(width)

    options = OPTIONS | {"first": 1000, "points": 1000, "rounds": 3}
    found = pooled([sample(one_factor(bent), bounds, **options | {"seed": [0, seed]}) for seed in range(12)])
    for side in (-1.0, 1.0):
        is_beyond = side * found.points[:, 0] > 0.4 * 1.96
        assert found.weights[is_beyond].sum() == pytest.approx(0.025, abs=0.006)


@pytest.mark.usefixtures("exact")
def test_both_of_two_distant_modes_are_found_with_their_shares():
    def modes(x):
        one, other = ((x - centre) ** 2 @ np.full(3, 50.0) for centre in (-3.0, 3.0))
        return np.logaddexp(-one + np.log(0.25), -other + np.log(0.75))

    searches = [
        sample(one_factor(modes), BOUNDS, **OPTIONS | {"first": 1000, "points": 1000, "seed": seed})
        for seed in range(8)
    ]
    found = pooled(searches)

    def share(weights):
        return weights[found.points[:, 0] < 0.0].sum()

    error = monte_carlo_error(found.weights, found.search, share)
    assert 0.01 < error < 0.05
    assert share(found.weights) == pytest.approx(0.25, abs=4.0 * error)


def test_the_monte_carlo_error_of_a_mean_is_its_standard_error():
    """Four searches of equal weight: the standard deviation of their means over the root of their number."""
    values, search = np.random.default_rng(6).normal(size=40), np.repeat(np.arange(4), 10)
    found = Sample(values[:, None], np.zeros(40), np.full(40, 1 / 40), 0.0, 40.0, search)
    means = values.reshape(4, 10).mean(axis=1)
    assert monte_carlo_error(found.weights, found.search, lambda weights: weights @ values) == pytest.approx(
        means.std(ddof=1) / 2.0
    )


@pytest.mark.usefixtures("exact")
def test_searches_count_with_their_evidence():
    """Of two searches for one peak, one has found half of the bounds impossible: it has half of the evidence."""

    def half(x):
        return np.where(x[:, 0] > 0.0, 0.0, -np.inf)

    whole = sample(one_factor(lambda x: np.zeros(len(x))), BOUNDS, **OPTIONS)
    found = pooled([whole, sample(one_factor(half), BOUNDS, **OPTIONS)])
    assert found.weights[found.search == 0].sum() == pytest.approx(2.0 / 3.0, abs=0.02)
    assert found.weights.sum() == pytest.approx(1.0)
    assert math.exp(found.log_evidence) == pytest.approx(0.75, abs=0.03)


@pytest.mark.usefixtures("exact")
def test_no_point_lies_beyond_the_bounds():
    def rising(x):
        assert ((x >= BOUNDS[0]) & (x <= BOUNDS[1])).all()
        return 2.0 * x[:, 0] - 0.5 * x[:, 1] ** 2

    assert len(sample(one_factor(rising), BOUNDS, **OPTIONS).points) > 1000


@pytest.mark.usefixtures("exact")
def test_equal_seeds_give_equal_samples():
    one, same, other = (sample(one_factor(valley), BOUNDS, **OPTIONS | {"seed": seed}) for seed in (1, 1, 2))
    assert np.array_equal(one.points, same.points) and np.array_equal(one.weights, same.weights)
    assert not np.array_equal(one.points, other.points[: len(one.points)])


@pytest.mark.usefixtures("exact")
def test_impossible_points_have_no_weight():
    found = sample(one_factor(lambda x: np.where(x[:, 0] > 0.0, 0.0, -np.inf)), BOUNDS, **OPTIONS)
    assert found.weights[found.points[:, 0] <= 0.0].sum() == 0.0
    assert np.exp(found.log_evidence) == pytest.approx(0.5, abs=0.03)
    with pytest.raises(ValueError, match="no point"):
        sample(one_factor(lambda x: np.full(len(x), -np.inf)), BOUNDS, **OPTIONS)


FEW = {"first": 200, "points": 100, "rounds": 12, "enough": 150, "seed": 1}
FACTORS = 20
# Each factor limits a combination of two parameters; the sum of their precisions is the inverse of this covariance.
DIRECTIONS = np.random.default_rng(5).normal(size=(FACTORS, 2)) * 3.0
OF_FACTORS = np.linalg.inv(DIRECTIONS.T @ DIRECTIONS)


def factors(points, noise=None):
    """Logarithms of normal factors for three inflations of their standard deviation, shape (3, n, 20)."""
    squares = ((points - MEAN[:2]) @ DIRECTIONS.T) ** 2
    logs = np.array([-0.5 * squares / inflation**2 for inflation in (1.0, 3.0, 10.0)])
    return logs if noise is None else logs + noise.normal(-0.5 * 0.6**2, 0.6, squares.shape)


@pytest.mark.parametrize("noisy", [False, True])
def test_the_sample_has_the_moments_of_the_posterior_also_if_factors_are_noisy(noisy):
    noise = np.random.default_rng(3) if noisy else None
    found = sample(lambda points: factors(points, noise), BOUNDS[:, :2], **FEW)
    assert found.size >= 150
    assert found.weights @ found.points == pytest.approx(MEAN[:2], abs=0.1)
    centred = found.points - found.weights @ found.points
    covariance = (found.weights[:, None] * centred).T @ centred
    assert np.diag(covariance) == pytest.approx(np.diag(OF_FACTORS), rel=0.5)
    evidence = math.log(2.0 * math.pi / 100.0) + 0.5 * math.log(np.linalg.det(OF_FACTORS))
    assert found.log_evidence == pytest.approx(evidence, abs=0.7 if noisy else 0.3)


def test_the_search_ends_without_enough_samples_after_the_last_round():
    assert sample(factors, BOUNDS[:, :2], **FEW | {"rounds": 1, "enough": 1e6}).size < 1e6


@pytest.mark.usefixtures("exact")
def test_a_search_that_has_not_enough_samples_goes_on_for_as_many_rounds_again():
    """A peak that a search of three rounds has only just reached."""
    calls = []

    def peak(x):
        calls.append(len(x))
        return -0.5 * np.sum(((x - MEAN) / 0.1) ** 2, axis=1)

    options = {"first": 100, "points": 100, "rounds": 3, "seed": 1}
    found = sample(one_factor(peak), BOUNDS, **options, enough=40.0)
    assert found.size >= 40.0 and 1 + options["rounds"] < len(calls) <= 1 + 2 * options["rounds"]


@pytest.mark.usefixtures("exact")
def test_points_of_a_related_posterior_lead_to_a_narrow_one():
    """A peak that fills 3e-8 of the bounds, found from its projection on three of four parameters."""

    def peak(x):
        return -0.5 * np.sum(((x - [*MEAN, 0.3]) / [0.02, 0.02, 0.02, 1.0]) ** 2, axis=1)

    bounds = np.column_stack([BOUNDS, [-5.0, 5.0]])
    random = np.random.default_rng(2)
    near = np.column_stack([random.normal(MEAN, 0.02, (200, 3)), random.uniform(-5.0, 5.0, 200)])
    options = OPTIONS | {"first": 200, "points": 200, "rounds": 2}
    found = sample(one_factor(peak), bounds, **options, near=(near, np.ones(len(near))))
    evidence = math.log(4.0 * math.pi**2 * 0.02**3 / 1e4)
    assert found.log_evidence == pytest.approx(evidence, abs=0.3)
    assert sample(one_factor(peak), bounds, **options).size < 10.0 < found.size


def test_a_density_is_flattened_also_if_few_points_were_drawn_where_it_is():
    """A point counts with the reciprocal of the proposal, which varies by a factor of e^40."""
    mixture = np.linspace(-40.0, 0.0, 100)
    weights = flattened(lambda place: np.full(100, -place), 3, mixture, 20.0, is_even=False)
    assert effective_number(weights) >= 20.0 and weights.argmax() == 0
    # No more than half of the possible points are demanded.
    impossible = np.where(np.arange(100) < 10, 0.0, -np.inf)
    weights = flattened(lambda place: impossible, 3, mixture, 20.0, is_even=False)
    assert 5.0 <= effective_number(weights) <= 10.0 and weights[10:].sum() == 0.0
