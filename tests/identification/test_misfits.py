"""Misfits: distances from the paper's numbers, in half accepted intervals."""

import numpy as np
import pandas as pd
import pytest

from identification import findings
from identification.fronts import distance
from identification.misfits import misfit, misfits, root_mean_square
from identification.profiles import shifts_of
from identification.search_space import PARAMETERS


def test_the_ends_of_the_accepted_interval_are_one_apart_from_its_middle():
    number = {"low": 49.0, "high": 51.0}
    assert misfit(np.array([49.0, 50.0, 51.0, 53.0]), number).tolist() == [-1.0, 0.0, 1.0, 3.0]


def test_a_mean_squared_error_counts_by_its_root():
    number = {"low": None, "high": 4e-11}
    assert misfit(np.array([0.0, 1e-11, 4e-11, 16e-11]), number) == pytest.approx([0.0, 0.5, 1.0, 2.0])


def test_shifts_are_added_before_numbers_are_compared():
    numbers = {"a": {"low": 1.0, "high": 3.0}, "b": {"low": 0.0, "high": 4.0}}
    found = {"a": np.array([2.0, 3.0]), "b": np.array([0.0, 2.0]), "unused": np.array([9.0, 9.0])}
    assert misfits(found, numbers, {"b": 2.0}).tolist() == [[0.0, 0.0], [1.0, 1.0]]
    assert root_mean_square(np.array([[3.0, 4.0]])) == pytest.approx(np.sqrt(12.5))


def test_two_numbers_of_one_quantity():
    """50 ± 1 and 47 ± 0.5 touch at 48 if both are twice as wide."""
    one, other = {"low": 49.0, "high": 51.0}, {"low": 46.5, "high": 47.5}
    factor = findings.contradiction({findings.UP_ALONE: one, findings.DOWN_ALONE: other})
    assert factor == pytest.approx(2.0)
    x = np.linspace(45.0, 52.0, 7001)
    worst = np.maximum(np.abs(misfit(x, one)), np.abs(misfit(x, other)))
    assert worst.min() == pytest.approx(factor)


def test_intervals_end_where_the_lowest_profile_has_risen():
    """Parabolas about 1 for two tension modes, of which the lower one counts; the minimum lies between two values."""
    x = np.array([0.4, 0.7, 1.2, 1.5])
    profiles = pd.concat(
        (
            pd.DataFrame(
                {"evidence": "all", "parameter": name, "tension": tension, "total": 5.0 + above + k * (x - 1.0) ** 2}
                | dict.fromkeys(PARAMETERS, 1.0)
                | {name: x, "status": "ok"}
            )
            for k, name in enumerate(PARAMETERS, start=50)
            for tension, above in (("allow", 0.0), ("clip", 100.0))
        ),
        ignore_index=True,
    )
    optima = pd.DataFrame(
        {"evidence": "all", "tension": ["allow", "clip"], "total": [5.0, 105.0], "rise": 3.0, "status": "ok"}
        | dict.fromkeys(PARAMETERS, 1.0)
    )
    found = findings.intervals(profiles, optima, "all")
    assert list(found) == list(PARAMETERS)
    for k, name in enumerate(PARAMETERS, start=50):
        low, high = found[name]
        # Linear interpolation between (1, 5) or (0.7, 5 + 0.09 k) and the next value.
        assert low.value == pytest.approx(1.0 - 0.3 * 3.0 / (0.09 * k))
        at, there = (1.2, 0.04 * k) if 0.04 * k <= 3.0 else (1.0, 0.0)
        ahead, beyond = (1.5, 0.25 * k) if at == 1.2 else (1.2, 0.04 * k)
        assert high.value == pytest.approx(at + (ahead - at) * (3.0 - there) / (beyond - there))
        assert (low.held, high.held) == (False, False)


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


def test_a_table_of_few_contacts_is_coarse():
    assert findings.is_coarse({"contacts": {"loss": 4, "stiffness": 4}})
    assert not findings.is_coarse({"contacts": {"loss": 9, "stiffness": 9}})


def test_the_distance_of_fronts_counts_members_of_both():
    one, other = np.zeros((1, 2)), np.array([[0.0, 0.0], [1.0, 0.5]])
    assert distance(one, other) == distance(other, one) == 0.25


def test_shifts_are_the_differences_of_the_paper_method():
    rows = [("printed", "euler", "a", 3.0), ("printed", "converged", "a", 1.0), ("other", "euler", "a", 9.0)]
    assert shifts_of(pd.DataFrame(rows, columns=["set", "method", "number", "value"])) == {"a": 2.0}
