"""Dimensions of sets that are known exactly, or within a range in the literature."""

import numpy as np
import pytest

from conveyor.analysis.fractals import box_counting, correlation_sum
from conveyor_pipeline.paper.orbits.reference_sets import cantor, circle, sierpinski, square

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


@pytest.mark.parametrize(
    ("points", "truth"), [(cantor, CANTOR), (sierpinski, SIERPINSKI), (circle, 1.0), (square, 2.0)]
)
@pytest.mark.parametrize(
    "estimate", [box_counting.box_dimension, lambda p: correlation_sum.correlation_dimension(p, 0)]
)
def test_error_covers_the_exact_dimension(estimate, points, truth):
    found = estimate(points(np.random.default_rng(1), 100_000))
    assert abs(found.value - truth) <= found.error <= LARGEST_ERROR


def test_henon_box_dimension_lies_in_the_literature_band():
    """1.261 ± 0.003 by box counting: Russell, Hanson, Ott, Phys. Rev. Lett. 45 (1980) 1175."""
    found = box_counting.box_dimension(henon(np.random.default_rng(1), 100_000))
    assert abs(found.value - 1.261) <= found.error <= LARGEST_ERROR


def test_henon_correlation_dimension_lies_in_the_literature_band():
    """1.21 ± 0.01 to 1.25 ± 0.02: Grassberger and Procaccia, Physica D 9 (1983) 189, by two embeddings."""
    found = correlation_sum.correlation_dimension(henon(np.random.default_rng(1), 100_000), 0)
    assert found.value - found.error <= 1.22 <= found.value + found.error
    assert found.error <= 0.06


def test_theiler_window_removes_neighbours_in_time():
    """Short lines in a square: if samples of one line count as neighbours, the dimension is one, otherwise two."""
    rng = np.random.default_rng(5)
    start, angle = rng.random((1_000, 1, 2)), rng.uniform(0.0, 2 * np.pi, 1_000)
    along = np.column_stack([np.cos(angle), np.sin(angle)])[:, None] * 0.001 * np.arange(20)[:, None]
    points = (start + along).reshape(-1, 2)
    with_window = correlation_sum.correlation_dimension(points, 20)
    without = correlation_sum.correlation_dimension(points, 0)
    assert abs(with_window.value - 2.0) <= with_window.error <= 0.1
    assert without.value + without.error < 1.7


def test_a_series_whose_parts_differ_has_a_larger_error():
    """A line and then a square: each part of the series sees a slope of its own; in random order all see the same."""
    rng = np.random.default_rng(1)
    series = np.concatenate([np.column_stack([rng.random(4000), np.full(4000, 0.5)]), square(rng, 4000)])
    ordered = correlation_sum.correlation_dimension(series, 0)
    mixed = correlation_sum.correlation_dimension(rng.permutation(series), 0)
    assert ordered.error > 3.0 * mixed.error


def test_more_points_narrow_the_error():
    points = np.random.default_rng(0).permutation(sierpinski(np.random.default_rng(6), 100_000))
    found = [box_counting.box_dimension(points[:number]) for number in (3_000, 10_000, 100_000)]
    errors = [estimate.error for estimate in found]
    assert errors == sorted(errors, reverse=True)
    assert all(abs(estimate.value - SIERPINSKI) <= estimate.error for estimate in found)
    assert found[0].scale_low > found[-1].scale_low


@pytest.mark.parametrize(
    "points", [np.zeros((1_000, 2)), np.tile(np.eye(2), (500, 1)), np.random.default_rng(0).random((20, 2))]
)
def test_too_few_distinct_points_give_no_number(points):
    assert np.isnan(box_counting.box_dimension(points).value)
    assert np.isnan(correlation_sum.correlation_dimension(points, 0).value)


def test_estimates_do_not_depend_on_units():
    points = sierpinski(np.random.default_rng(8), 5_000)
    scaled = points * np.array([2.0**-12, 2.0**5])
    assert box_counting.box_dimension(points).value == box_counting.box_dimension(scaled).value
    assert (
        correlation_sum.correlation_dimension(points, 3).value == correlation_sum.correlation_dimension(scaled, 3).value
    )


@pytest.mark.parametrize("points", [np.zeros(5), np.zeros((5, 3)), np.zeros((0, 2)), np.array([[0.0, np.nan]])])
def test_points_are_checked(points):
    with pytest.raises(ValueError, match="points"):
        box_counting.box_dimension(points)


def test_positions_of_grids_are_the_same_at_each_scale():
    doubled = np.round(np.modf(2.0 * box_counting.SHIFTS)[0] * 13) % 13
    assert {tuple(one) for one in doubled} == {tuple(one) for one in np.round(box_counting.SHIFTS * 13)}
