"""Pareto fronts of few points."""

import numpy as np
import pytest

from conveyor_pipeline.machine.operating import pareto


def test_the_front_keeps_the_non_dominated_points():
    objectives = np.array([[1.0, 2.0, 3.0], [1.0, 2.0, 4.0], [0.0, 3.0, 3.0], [1.0, 2.0, 3.0]])
    points = np.arange(16.0).reshape(4, 4)
    kept, best = pareto.best_of(points, objectives)
    assert best.tolist() == [[0.0, 3.0, 3.0], [1.0, 2.0, 3.0]]
    assert kept.tolist() == points[[2, 0]].tolist()
    assert pareto.hypervolume(best[1:], np.array([2.0, 4.0, 6.0])) == pytest.approx(1.0 * 2.0 * 3.0)
    assert pareto.hypervolume(np.empty((0, 3)), np.ones(3)) == 0.0
