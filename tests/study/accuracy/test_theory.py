"""Closed forms against each other, and the solver's isolated impacts against them."""

import math

import numpy as np
import pytest

from conveyor import Conveyor
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.study.accuracy import closed_forms, theory

MODEL = {"frequency": 50.0, "angle": 0.2, "gravity": 9.81, "mass": 0.7e-3}


def test_an_elastic_ball_has_the_range_of_the_approximate_map():
    assert closed_forms.rigid_range(1.0) == (0.0, 1.0)


def test_a_rising_track_has_the_same_range_in_units_of_gravity_normal_to_it():
    inclined = MODEL | {"inclination": 0.5}
    assert theory.stiff_range(inclined, 1e9, 0.5) == pytest.approx(closed_forms.rigid_range(0.5), rel=1e-3)


def test_the_limit_of_a_polynomial_is_exact():
    places = np.array([0.3, 0.2, 0.1])
    value, error = theory.extrapolate_to_zero(places, 2.0 - 3.0 * places + 4.0 * places**2)
    assert value == pytest.approx(2.0, abs=1e-13)
    assert error == pytest.approx(4.0 * 0.2 * 0.1)  # of the line through the last two places


def test_deepest_point_and_duration_of_an_undamped_impact():
    conveyor, speed = Conveyor(), 0.3
    depth = closed_forms.compression(conveyor, speed)
    assert 0.4 * conveyor.stiffness * depth**2.5 == pytest.approx(0.5 * conveyor.mass * speed**2, rel=1e-12)
    slow = np.linspace(0.0, 1.0, 100_001)[:-1] ** 2  # the speed ends in a root
    time = 2.0 * depth / speed * np.trapezoid(1.0 / np.sqrt(1.0 - (1.0 - slow) ** 2.5 + 1e-300)[1:], slow[1:])
    assert closed_forms.undamped_duration(conveyor, speed) == pytest.approx(time, rel=1e-3)


@pytest.mark.parametrize("ratio", [0.05, 0.5])
def test_the_reduced_equation_of_a_linear_contact_has_a_closed_form(ratio):
    """X'' = -X - 2 ζ X', whose velocity falls by exp(-π ζ/√(1 - ζ²)) in half a period."""
    expected = math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))
    assert closed_forms.reduced_restitution(1.0, 2.0 * ratio) == pytest.approx(expected, rel=1e-11)
    assert closed_forms.damping_ratio(expected) == pytest.approx(ratio)


@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_light_damping_loses_the_work_of_the_damper(exponent):
    loss = (1.0 - closed_forms.reduced_restitution(exponent, 1e-5)) / 1e-5
    assert loss == pytest.approx(closed_forms.light_loss(exponent), rel=1e-4)


def test_an_impact_that_never_ends_is_an_error():
    with pytest.raises(JobError, match="less damping"):
        theory.simulate_impact(Conveyor(damping=100.0), 0.1)


def test_a_plate_with_one_frequency_does_not_move_a_part_that_slides():
    assert closed_forms.two_frequencies(0.0, 0.3) == (pytest.approx(1.0), pytest.approx(0.0, abs=1e-9))


def test_two_frequencies_are_fastest_at_the_ratio_of_the_table():
    """In units of the largest displacement."""

    def speed(ratio, phase):
        stroke, velocity = closed_forms.two_frequencies(ratio, phase)
        return abs(velocity) / stroke

    best = speed(theory.RATIO, theory.PHASES[0])
    assert speed(theory.RATIO, theory.PHASES[1]) == pytest.approx(best)
    others = [speed(r, p) for r in (0.15, 0.24, 0.26, 0.4, 1.0) for p in np.linspace(0.0, 2.0 * np.pi, 25)]
    assert max(others) < best
