"""Importance sampling of posteriors with known moments, evidence and ends."""

import numpy as np
import pytest
from scipy.stats import norm

from pipeline.importance_sampling import interval, sample

BOUNDS = np.array([[-5.0, -5.0, -5.0], [5.0, 5.0, 5.0]])
OPTIONS = {"points": 500, "rounds": 6, "seed": 1}
# A narrow valley: the standard deviations are 1, 0.1 and 0.5, and the first two parameters are correlated.
COVARIANCE = np.array([[1.0, 0.09, 0.0], [0.09, 0.01, 0.0], [0.0, 0.0, 0.25]])
MEAN = np.array([0.5, -1.0, 2.0])


def valley(x):
    y = x - MEAN
    return -0.5 * np.einsum("ni,ij,nj->n", y, np.linalg.inv(COVARIANCE), y)


def test_moments_and_evidence_of_a_narrow_valley():
    found = sample(valley, BOUNDS, **OPTIONS)
    assert found.size > 500
    mean = found.weights @ found.points
    assert mean == pytest.approx(MEAN, abs=0.1)
    y = found.points - mean
    assert (found.weights[:, None] * y).T @ y == pytest.approx(COVARIANCE, abs=0.1)
    volume = np.sqrt((2.0 * np.pi) ** 3 * np.linalg.det(COVARIANCE))
    assert np.exp(found.log_evidence) == pytest.approx(volume / 1e3, rel=0.1)


def test_both_of_two_distant_modes_are_found_with_their_shares():
    def modes(x):
        one, other = ((x - centre) ** 2 @ np.full(3, 50.0) for centre in (-3.0, 3.0))
        return np.logaddexp(-one + np.log(0.25), -other + np.log(0.75))

    found = sample(modes, BOUNDS, **OPTIONS | {"points": 1000})
    assert found.weights[found.points[:, 0] < 0.0].sum() == pytest.approx(0.25, abs=0.05)


def test_no_point_lies_beyond_the_bounds_and_intervals_are_open_there():
    def rising(x):
        assert ((x >= BOUNDS[0]) & (x <= BOUNDS[1])).all()
        return 2.0 * x[:, 0] - 0.5 * x[:, 1] ** 2

    found = sample(rising, BOUNDS, **OPTIONS)
    exponential, normal, even = (interval(found.points[:, k], found.weights, (-5.0, 5.0), 0.95) for k in range(3))
    assert (exponential.open_low, exponential.open_high) == (False, True)
    assert exponential.low == pytest.approx(5.0 + 0.5 * np.log(0.025), abs=0.3)
    assert (normal.open_low, normal.open_high) == (False, False)
    assert (normal.low, normal.high) == pytest.approx(norm.interval(0.95), abs=0.25)
    assert (even.open_low, even.open_high) == (True, True)


def test_equal_seeds_give_equal_samples():
    one, same, other = (sample(valley, BOUNDS, **OPTIONS | {"seed": seed}) for seed in (1, 1, 2))
    assert np.array_equal(one.points, same.points) and np.array_equal(one.weights, same.weights)
    assert not np.array_equal(one.points, other.points[: len(one.points)])


def test_impossible_points_have_no_weight():
    found = sample(lambda x: np.where(x[:, 0] > 0.0, 0.0, -np.inf), BOUNDS, **OPTIONS)
    assert found.weights[found.points[:, 0] <= 0.0].sum() == 0.0
    assert np.exp(found.log_evidence) == pytest.approx(0.5, abs=0.03)
    with pytest.raises(ValueError, match="no point"):
        sample(lambda x: np.full(len(x), -np.inf), BOUNDS, **OPTIONS)
