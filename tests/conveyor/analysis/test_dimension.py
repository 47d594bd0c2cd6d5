"""Dimensions of sets that are known exactly, or by a band in the literature."""

import numpy as np
import pytest

from conveyor.analysis import dimension
from conveyor.analysis.known_sets import cantor, circle, sierpinski, square

CANTOR = np.log(2) / np.log(3)
SIERPINSKI = np.log(3) / np.log(2)
LARGEST_ERROR = 0.05


def henon(rng, n):
    x, y = rng.uniform(-0.1, 0.1, 2)
    orbit = np.empty((n + 100, 2))
    for i in range(len(orbit)):
        x, y = 1.0 - 1.4 * x * x + y, 0.3 * x
        orbit[i] = x, y
    return orbit[100:]


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("points", "truth"), [(cantor, CANTOR), (sierpinski, SIERPINSKI), (circle, 1.0), (square, 2.0)]
)
@pytest.mark.parametrize("estimate", [dimension.box_dimension, lambda p: dimension.correlation_dimension(p, 0)])
def test_error_covers_the_exact_dimension(estimate, points, truth, seed):
    found = estimate(points(np.random.default_rng(seed), 100_000))
    assert abs(found.value - truth) <= found.error <= LARGEST_ERROR


@pytest.mark.parametrize("seed", [1, 2])
def test_henon_box_dimension_lies_in_the_literature_band(seed):
    """1.261 ± 0.003 by box counting: Russell, Hanson, Ott, Phys. Rev. Lett. 45 (1980) 1175."""
    found = dimension.box_dimension(henon(np.random.default_rng(seed), 100_000))
    assert abs(found.value - 1.261) <= found.error <= LARGEST_ERROR


@pytest.mark.parametrize("seed", [1, 2])
def test_henon_correlation_dimension_lies_in_the_literature_band(seed):
    """1.21 ± 0.01 to 1.25 ± 0.02: Grassberger and Procaccia, Physica D 9 (1983) 189, by two embeddings."""
    found = dimension.correlation_dimension(henon(np.random.default_rng(seed), 100_000), 0)
    assert found.value - found.error <= 1.22 <= found.value + found.error
    assert found.error <= 0.06


def box_counts(points, scales, *arguments, step=None):
    """Box counts of points without parts, of scales that need not be related."""
    return dimension.box_counts(points, np.zeros(len(points), np.int64), scales, step or len(scales), *arguments)[0]


def test_box_counts_are_exact():
    """Boxes of 1/3^k hold the Cantor set's 2^k intervals, boxes of 1/2^k all of a square's 4^k."""
    unshifted = np.zeros((1, 2))
    left_ends = np.zeros(1)
    for k in range(1, 9):
        left_ends = np.concatenate([left_ends, left_ends + 2.0 / 3.0**k])
    inside = np.column_stack([left_ends + 0.5 / 3.0**8, np.zeros(2**8)])
    counts = box_counts(inside, 1.0 / 3.0 ** np.arange(1, 9), unshifted, 0.0)
    assert counts.tolist() == [2.0**k for k in range(1, 9)]

    middles = (np.arange(64) + 0.5) / 64
    grid = np.column_stack([np.repeat(middles, 64), np.tile(middles, 64)])
    counts = box_counts(grid, 0.5 ** np.arange(1, 7), unshifted, 0.0)
    assert counts.tolist() == [4.0**k for k in range(1, 7)]


def test_box_counts_agree_with_sets_of_boxes():
    rng = np.random.default_rng(3)
    points, scales, shifts = rng.random((500, 2)) ** 2, np.array([0.3, 0.1, 0.01, 1e-6]), rng.random((3, 2))
    expected = [np.mean([len(np.unique(np.floor(points / e + s), axis=0)) for s in shifts]) for e in scales]
    assert box_counts(points, scales, shifts, 0.0) == pytest.approx(expected, abs=1e-12)


def test_grids_within_each_other_agree_with_sets_of_boxes():
    """The coarsest grid of an octave chain is shifted as asked for; the finer ones are its halves."""
    rng = np.random.default_rng(5)
    points, shifts, step = rng.random((500, 2)) ** 2, rng.random((3, 2)), 2
    scales = 0.3 * 0.5 ** (np.arange(9) / step)
    expected = [
        np.mean([len(np.unique(np.floor(points / e + s * 2.0 ** (k // step)), axis=0)) for s in shifts])
        for k, e in enumerate(scales)
    ]
    assert box_counts(points, scales, shifts, 0.0, step=step) == pytest.approx(expected, abs=1e-12)


def test_positions_of_grids_are_the_same_at_each_scale():
    doubled = np.round(np.modf(2.0 * dimension.SHIFTS)[0] * 13) % 13
    assert {tuple(one) for one in doubled} == {tuple(one) for one in np.round(dimension.SHIFTS * 13)}


def test_a_hash_table_is_cleared_before_its_numbers_end():
    rng = np.random.default_rng(6)
    points, scales = rng.random((200, 2)), np.array([0.2, 0.1, 0.05])
    found = []
    for first in (0, dimension.FRESH + 1):
        owners = np.full(512, np.iinfo(np.int32).max, np.int32) if first else np.full(512, -1, np.int32)
        totals, boxes, deepest = np.zeros((3, 3), np.int64), np.empty(200, np.int64), np.empty(200, np.int8)
        halvings, shift = np.zeros(200, np.int64), np.zeros(2)
        after = dimension.count_chain(points, halvings, scales, 2, 1, shift, owners, first, boxes, deepest, totals)
        found.append((after, totals.tolist()))
    assert found[0] == found[1]


def test_parts_are_counted_as_if_alone():
    rng = np.random.default_rng(4)
    points, shifts = rng.random((3000, 2)) ** 2, rng.random((3, 2))
    halvings = rng.integers(0, 3, 3000)
    scales = np.array([0.3, 0.1, 0.05, 0.02, 0.01, 1e-3, 1e-6])
    found = dimension.box_counts(points, halvings, scales, len(scales), shifts, 5.0)
    for part in range(3):
        alone = box_counts(points[halvings >= part], scales, shifts, 5.0 / 2**part)
        resolved = found[part] > 0.0
        assert resolved.any()
        assert not resolved.all()
        assert found[part, resolved].tolist() == alone[resolved].tolist()
        # The search ends where boxes of the whole set are empty by chance.
        assert (alone[~resolved] == 0.0).all() or (found[0, ~resolved] == 0.0).all()


def test_pair_counts_agree_with_all_distances():
    points = np.random.default_rng(4).random((300, 2))
    radii = np.array([0.5, 0.2, 0.05])
    distance = np.hypot(*(points[:, None] - points).transpose(2, 0, 1))
    apart = np.abs(np.subtract.outer(np.arange(300), np.arange(300))) > 7
    shells, pairs = dimension.pair_counts(points, np.arange(300), 7, radii**2)
    assert pairs == np.count_nonzero(apart)
    assert np.cumsum(shells[::-1])[::-1].tolist() == [np.count_nonzero(apart & (distance < r)) for r in radii]


def test_theiler_window_removes_neighbours_in_time():
    """Short strokes strewn over a square: lines to all who count samples of one stroke as neighbours, else an area."""
    rng = np.random.default_rng(5)
    start, angle = rng.random((1_000, 1, 2)), rng.uniform(0.0, 2 * np.pi, 1_000)
    along = np.column_stack([np.cos(angle), np.sin(angle)])[:, None] * 0.001 * np.arange(20)[:, None]
    points = (start + along).reshape(-1, 2)
    with_window = dimension.correlation_dimension(points, 20)
    without = dimension.correlation_dimension(points, 0)
    assert abs(with_window.value - 2.0) <= with_window.error <= 0.1
    assert without.value + without.error < 1.7


def test_the_paper_s_way_misses_the_dimension_of_a_square_by_more_than_its_error():
    """Its smallest boxes have run out of points, and it does not know."""
    found = dimension.box_dimension_of_paper(square(np.random.default_rng(1), 10_000))
    assert found.value + found.error < 1.9


def test_more_points_narrow_the_error():
    points = np.random.default_rng(0).permutation(sierpinski(np.random.default_rng(6), 100_000))
    found = [dimension.box_dimension(points[:number]) for number in (3_000, 10_000, 100_000)]
    errors = [estimate.error for estimate in found]
    assert errors == sorted(errors, reverse=True)
    assert all(abs(estimate.value - SIERPINSKI) <= estimate.error for estimate in found)
    assert found[0].scale_low > found[-1].scale_low


@pytest.mark.parametrize(
    "points", [np.zeros((1_000, 2)), np.tile(np.eye(2), (500, 1)), np.random.default_rng(0).random((20, 2))]
)
def test_too_few_distinct_points_give_no_number(points):
    assert np.isnan(dimension.box_dimension(points).value)
    assert np.isnan(dimension.correlation_dimension(points, 0).value)


def test_estimates_do_not_depend_on_units():
    points = sierpinski(np.random.default_rng(8), 5_000)
    scaled = points * np.array([2.0**-12, 2.0**5])
    assert dimension.box_dimension(points).value == dimension.box_dimension(scaled).value
    assert dimension.correlation_dimension(points, 3).value == dimension.correlation_dimension(scaled, 3).value


@pytest.mark.parametrize("points", [np.zeros(5), np.zeros((5, 3)), np.zeros((0, 2)), np.array([[0.0, np.nan]])])
def test_points_are_checked(points):
    with pytest.raises(ValueError, match="points must be finite"):
        dimension.box_dimension(points)


def test_points_along_boxes_are_the_same_points_and_lie_box_by_box():
    points = np.random.default_rng(1).random((4096, 2))
    found = points[dimension.along_boxes(points)]
    assert np.array_equal(np.sort(found.view("f8,f8"), axis=0), np.sort(points.view("f8,f8"), axis=0))
    # In a grid of 16 by 16, each box is entered once.
    boxes = (16 * found).astype(int) @ [16, 1]
    assert np.count_nonzero(np.diff(boxes)) + 1 == len(np.unique(boxes)) == 256
