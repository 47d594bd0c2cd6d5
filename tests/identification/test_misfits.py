"""Distances from the paper's numbers, in half accepted intervals."""

import numpy as np
import pytest

from identification import findings
from identification.misfits import Number, Numbers, misfit, root_mean_square, smallest_widening


def test_the_ends_of_the_accepted_interval_are_one_apart_from_its_middle():
    number = Number(49.0, 51.0)
    assert misfit(np.array([49.0, 50.0, 51.0, 53.0]), number).tolist() == [-1.0, 0.0, 1.0, 3.0]


def test_a_mean_squared_error_counts_by_its_root():
    number = Number(None, 4e-11)
    assert misfit(np.array([0.0, 1e-11, 4e-11, 16e-11]), number) == pytest.approx([0.0, 0.5, 1.0, 2.0])


def test_shifts_are_added_before_numbers_are_compared():
    numbers = Numbers({"a": Number(1.0, 3.0), "b": Number(0.0, 4.0)}, {"b": 2.0})
    found = numbers.misfits({"a": np.array([2.0, 3.0]), "b": np.array([0.0, 2.0]), "unused": np.array([9.0, 9.0])})
    assert found.tolist() == [[0.0, 0.0], [1.0, 1.0]]
    assert root_mean_square(np.array([[3.0, 4.0]])) == pytest.approx(np.sqrt(12.5))


def test_two_numbers_of_one_quantity():
    """50 ± 1 and 47 ± 0.5 meet at 48 if both are twice as wide, and at no other value if less."""
    one, other = Number(49.0, 51.0), Number(46.5, 47.5)
    factor = smallest_widening(one, other)
    assert factor == pytest.approx(2.0)
    x = np.linspace(45.0, 52.0, 7001)
    worst = np.maximum(np.abs(misfit(x, one)), np.abs(misfit(x, other)))
    assert worst.min() == pytest.approx(factor)
    told = {
        findings.UP_ALONE: {"low": one.low, "high": one.high},
        findings.DOWN_ALONE: {"low": other.low, "high": other.high},
    }
    assert findings.contradiction(told) == factor
