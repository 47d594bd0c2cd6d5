"""Misfits, contradictions and accepted frictions."""

import numpy as np
import pandas as pd
import pytest

from calibration import paper_findings as findings
from calibration.paper_findings import misfit


def test_the_ends_of_the_accepted_interval_are_one_apart_from_its_middle():
    number = {"low": 49.0, "high": 51.0}
    assert misfit(np.array([49.0, 50.0, 51.0, 53.0]), number).tolist() == [-1.0, 0.0, 1.0, 3.0]


def test_a_mean_squared_error_counts_by_its_root():
    number = {"low": None, "high": 4e-11}
    assert misfit(np.array([0.0, 1e-11, 4e-11, 16e-11]), number) == pytest.approx([0.0, 0.5, 1.0, 2.0])


def test_two_numbers_of_one_quantity():
    """50 ± 1 and 47 ± 0.5 touch at 48 if both are twice as wide."""
    one, other = {"low": 49.0, "high": 51.0}, {"low": 46.5, "high": 47.5}
    factor = findings.contradiction({findings.UP_ALONE: one, findings.DOWN_ALONE: other})
    assert factor == pytest.approx(2.0)
    x = np.linspace(45.0, 52.0, 7001)
    worst = np.maximum(np.abs(misfit(x, one)), np.abs(misfit(x, other)))
    assert worst.min() == pytest.approx(factor)


NUMBERS = {
    "C05.velocity_at_lower_end": {"low": 1.0, "high": 1.2},
    "C05.velocity_at_upper_end": {"low": 1.9, "high": 2.1},
    "C06.fall": {"low": 0.3, "high": 0.5},
}


@pytest.mark.parametrize(
    ("fall", "of_fall", "of_all"),
    [(2.0, (0.15, 0.25), (0.2, 0.21)), (1.5, (0.2, 1 / 3), (0.2, 0.21)), (4.0, (0.075, 0.125), None)],
)
def test_accepted_frictions(fall, of_fall, of_all):
    """Velocities are proportional to friction."""
    friction = np.linspace(0.0, 0.4, 41)
    grown = {"friction": friction, "first_low": 5.0 * friction, "first_high": 10.0 * friction, "fall": fall * friction}
    accepted = findings.accepted_frictions(pd.DataFrame(grown), NUMBERS)
    assert accepted["first_low"] == pytest.approx((0.2, 0.24))
    assert accepted["first_high"] == pytest.approx((0.19, 0.21))
    assert accepted["fall"] == pytest.approx(of_fall)
    assert accepted["all"] == (of_all and pytest.approx(of_all))
