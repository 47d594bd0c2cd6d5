"""Uncertainty of maps of basins, compared with sets whose boundaries have a known dimension."""

import math

import numpy as np
import pytest

from conveyor.analysis.basins.uncertainty import basin_entropy, uncertainty_exponent


def cantor(digits: int) -> np.ndarray:
    """Whether the cells of length 3^-digits in [0, 1) belong to the middle-third Cantor set."""
    return np.array(["1" not in np.base_repr(k, 3) for k in range(3**digits)])


def test_exponent_of_a_cantor_set_of_lines():
    """The boundary has the dimension 1 + log 2/log 3, so that α = 1 - log 2/log 3 = 0.369."""
    labels = np.repeat(cantor(8)[:, None], 32, axis=1)
    found = uncertainty_exponent(labels)
    assert found.value == pytest.approx(1.0 - math.log(2.0) / math.log(3.0), abs=0.03)


def test_exponent_of_a_line_of_points():
    assert uncertainty_exponent(cantor(10)).value == pytest.approx(1.0 - math.log(2.0) / math.log(3.0), abs=0.03)


def test_noise_has_no_exponent_and_the_largest_entropy():
    labels = np.random.default_rng(1).integers(0, 3, (300, 300))
    assert uncertainty_exponent(labels).value == pytest.approx(0.0, abs=0.05)
    assert basin_entropy(labels).value == pytest.approx(math.log(3.0), abs=0.01)


def test_a_single_basin_has_no_boundary():
    assert math.isnan(uncertainty_exponent(np.zeros((40, 40), dtype=int)).value)
    found = basin_entropy(np.zeros((40, 40), dtype=int))
    assert found.value == 0.0
    assert math.isnan(found.boundary)


def test_words_count_as_numbers_do():
    words = np.array([["first", "second"], ["second", "chaos"]], dtype=object).repeat(30, axis=0).repeat(30, axis=1)
    numbers = np.array([[0, 1], [1, 2]]).repeat(30, axis=0).repeat(30, axis=1)
    assert basin_entropy(words, 8) == basin_entropy(numbers, 8)


@pytest.mark.parametrize("labels", [1.0, [1, 2], np.zeros((40, 3), dtype=int), np.zeros((40, 40))])
def test_maps_that_are_too_small_or_no_labels_are_named(labels):
    with pytest.raises(ValueError, match="labels must be"):
        uncertainty_exponent(labels)
    with pytest.raises(ValueError, match="labels must be"):
        basin_entropy(labels)
