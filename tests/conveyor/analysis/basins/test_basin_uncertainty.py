"""Uncertainty of maps of basins, compared with sets whose boundaries have a known dimension."""

import math

import numpy as np
import pytest

from conveyor.analysis.basins.basin_uncertainty import basin_entropy, uncertainty_exponent


def gaps(x: np.ndarray) -> np.ndarray:
    """Whether points lie in gaps of even or odd level of the middle-third Cantor set, which is the boundary."""
    levels, inside, x = np.zeros(len(x), dtype=int), np.zeros(len(x), dtype=bool), x.copy()
    for level in range(40):
        digits = np.floor(3.0 * x)
        x = 3.0 * x - digits
        levels[~inside & (digits == 1)] = level % 2
        inside |= digits == 1
    return levels


@pytest.mark.parametrize("count", [100, 300, 20_000])
def test_exponent_of_a_cantor_set(count):
    """The boundary has the dimension log 2/log 3, so that α = 1 - log 2/log 3 = 0.369."""
    found = uncertainty_exponent(gaps((np.arange(count) + 0.5) / count))
    assert found.value == pytest.approx(1.0 - math.log(2.0) / math.log(3.0), abs=0.04)


def test_exponent_of_a_cantor_set_of_lines():
    """One more axis raises the dimension of boundary and map by one."""
    labels = np.repeat(gaps((np.arange(300) + 0.5) / 300)[:, None], 300, axis=1)
    assert uncertainty_exponent(labels).value == pytest.approx(1.0 - math.log(2.0) / math.log(3.0), abs=0.04)


def test_noise_has_no_exponent_and_the_largest_entropy():
    labels = np.random.default_rng(1).integers(0, 3, (300, 300))
    assert uncertainty_exponent(labels).value == pytest.approx(0.0, abs=0.05)
    assert basin_entropy(labels).value == pytest.approx(math.log(3.0), abs=0.01)


def test_a_single_basin_has_no_boundary():
    assert math.isnan(uncertainty_exponent(np.zeros((40, 40), dtype=int)).value)
    found = basin_entropy(np.zeros((40, 40), dtype=int))
    assert found.value == 0.0
    assert math.isnan(found.boundary)


def test_boxes_cover_maps_that_their_size_does_not_divide():
    """Overlapping boxes of 20 points begin at 0, 20 and 39 of 59 points, and count all labels at the end of an axis."""
    for axis in (0, 1):
        labels = np.moveaxis(np.zeros((40, 59), dtype=int), 0, axis)
        np.moveaxis(labels, axis, 0)[:, 49:] = 1
        assert labels.sum() == 400
        assert basin_entropy(labels, 20) == pytest.approx((math.log(2.0) / 3.0, math.log(2.0)))


def test_boxes_that_divide_a_map_do_not_overlap():
    labels = np.random.default_rng(2).integers(0, 3, (60, 40))
    boxes = [labels[i : i + 20, j : j + 20] for i in (0, 20, 40) for j in (0, 20)]
    shares = np.array([[np.mean(box == label) for label in range(3)] for box in boxes])
    assert basin_entropy(labels, 20).value == pytest.approx(-(shares * np.log(shares)).sum(axis=1).mean(), rel=1e-12)


def test_words_count_as_numbers_do():
    words = np.array([["first", "second"], ["second", "chaos"]], dtype=object).repeat(30, axis=0).repeat(30, axis=1)
    numbers = np.array([[0, 1], [1, 2]]).repeat(30, axis=0).repeat(30, axis=1)
    assert basin_entropy(words, 8) == basin_entropy(numbers, 8)


@pytest.mark.parametrize("labels", [1.0, [1, 2], np.zeros((40, 3), dtype=int), np.zeros((60, 60))])
def test_maps_that_are_too_small_or_no_labels_are_named(labels):
    with pytest.raises(ValueError, match="labels must be"):
        uncertainty_exponent(labels)
    with pytest.raises(ValueError, match="labels must be"):
        basin_entropy(labels)
