"""Box counts compared with sets of boxes and with exact numbers."""

import numpy as np
import pytest

from conveyor.analysis.fractals import box_counting


def counts_of(points, scales, *arguments, step=None):
    """Box counts of points in one part, at independent scales."""
    samples = box_counting.Samples(points, np.zeros(len(points), np.int64), scales, step or len(scales))
    return box_counting.box_counts(samples, *arguments)[0]


def test_box_counts_are_exact():
    """The Cantor set occupies 2^k boxes of 1/3^k, a square occupies 4^k boxes of 1/2^k."""
    unshifted = np.zeros((1, 2))
    left_ends = np.zeros(1)
    for k in range(1, 9):
        left_ends = np.concatenate([left_ends, left_ends + 2.0 / 3.0**k])
    inside = np.column_stack([left_ends + 0.5 / 3.0**8, np.zeros(2**8)])
    counts = counts_of(inside, 1.0 / 3.0 ** np.arange(1, 9), unshifted, 0.0)
    assert counts.tolist() == [2.0**k for k in range(1, 9)]

    middles = (np.arange(64) + 0.5) / 64
    grid = np.column_stack([np.repeat(middles, 64), np.tile(middles, 64)])
    counts = counts_of(grid, 0.5 ** np.arange(1, 7), unshifted, 0.0)
    assert counts.tolist() == [4.0**k for k in range(1, 7)]


def test_box_counts_agree_with_sets_of_boxes():
    rng = np.random.default_rng(3)
    points, scales, shifts = rng.random((500, 2)) ** 2, np.array([0.3, 0.1, 0.01, 1e-6]), rng.random((3, 2))
    expected = [np.mean([len(np.unique(np.floor(points / e + s), axis=0)) for s in shifts]) for e in scales]
    assert counts_of(points, scales, shifts, 0.0) == pytest.approx(expected, abs=1e-12)


def test_grids_within_each_other_agree_with_sets_of_boxes():
    """The coarsest grid of an octave chain has the given shift; the finer grids halve its boxes."""
    rng = np.random.default_rng(5)
    points, shifts, step = rng.random((500, 2)) ** 2, rng.random((3, 2)), 2
    scales = 0.3 * 0.5 ** (np.arange(9) / step)
    expected = [
        np.mean([len(np.unique(np.floor(points / e + s * 2.0 ** (k // step)), axis=0)) for s in shifts])
        for k, e in enumerate(scales)
    ]
    assert counts_of(points, scales, shifts, 0.0, step=step) == pytest.approx(expected, abs=1e-12)


def test_points_at_the_rim_have_boxes_of_their_own_at_the_finest_size():
    corners = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0]])
    scales = 0.5 ** np.arange(1, 31)
    assert counts_of(corners, scales, np.zeros((1, 2)), 0.0).tolist() == [5.0] * 30


@pytest.mark.parametrize(
    ("scales", "step"), [(np.array([0.3, 0.1, 0.05, 0.02, 0.01, 1e-3, 1e-6]), 7), (0.3 * 0.5 ** (np.arange(41) / 2), 2)]
)
def test_parts_are_counted_as_if_alone(scales, step):
    rng = np.random.default_rng(4)
    points, shifts = rng.random((3000, 2)) ** 2, rng.random((3, 2))
    halvings = rng.integers(0, 3, 3000)
    found = box_counting.box_counts(box_counting.Samples(points, halvings, scales, step), shifts, 5.0)
    for part in range(3):
        alone = counts_of(points[halvings >= part], scales, shifts, 5.0 / 2**part, step=step)
        resolved = found[part] > 0.0
        assert resolved.any()
        assert not resolved.all()
        assert found[part, resolved].tolist() == alone[resolved].tolist()
        # The search ends at scales at which boxes of the whole set are empty by chance.
        assert (alone[~resolved] == 0.0).all() or (found[0, ~resolved] == 0.0).all()
