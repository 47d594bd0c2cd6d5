"""Numbers of pairs against all distances."""

import numpy as np
import pytest

from conveyor.analysis.fractals import scaling_region
from conveyor.analysis.fractals.correlation_sum import pair_counts


@pytest.mark.parametrize(
    "squares",
    [
        np.array([0.5, 0.2, 0.05]) ** 2,
        scaling_region.SCALES**2,
        1.07 ** -np.arange(40.0),  # as close to each other as they may be
    ],
)
def test_pair_counts_agree_with_all_distances(squares):
    rng = np.random.default_rng(4)
    points = rng.random((700, 2)) * rng.choice([1.0, 1e-2, 1e-5], (700, 1))
    points[::7] = points[0]
    distance = ((points[:, None] - points) ** 2).sum(axis=2)
    apart = np.abs(np.subtract.outer(np.arange(700), np.arange(700))) > 7
    closer, pairs = pair_counts(points, np.arange(700), 7, squares)
    assert pairs == np.count_nonzero(apart)
    assert closer.tolist() == [np.count_nonzero(apart & (distance < one)) for one in squares]


def test_a_distance_equal_to_a_radius_is_not_closer():
    points = np.array([[0.0, 0.0], [0.25, 0.0], [0.0, 0.5]])
    closer, pairs = pair_counts(points, np.array([0]), 0, np.array([0.5**2, 0.25**2, 0.125**2]))
    assert (closer.tolist(), pairs) == ([1, 0, 0], 2)
