"""The textbook theory of throw conveyors: closed forms, and the equations of motion followed step by step."""

import math

import numpy as np
import pytest

from conveyor.analysis import throw_theory

PAPER = {"angle": math.radians(12.0), "frequency": 50.0, "gravity": 9.81}


def velocity_by_steps(acceleration, *, angle, frequency, gravity, inclination=0.0, phase_shift=0.0, steps=200_000):
    """Mean velocity of one cycle from take-off, from positions of plate and part at small time steps."""
    omega = 2.0 * math.pi * frequency
    a_x, a_z = acceleration * math.cos(angle), acceleration * math.sin(angle)
    phase = np.linspace(0.0, 2.0 * math.pi, steps + 1)
    pushes = a_z * np.cos(phase) + gravity * math.cos(inclination)
    begin = phase[np.flatnonzero((pushes[:-1] >= 0.0) & (pushes[1:] < 0.0))[0]]
    times = (phase - phase[0]) / omega
    theta = begin + omega * times
    plate_z = -a_z / omega**2 * np.cos(theta)
    plate_x = -a_x / omega**2 * np.cos(theta + phase_shift)
    part_z = plate_z[0] + a_z / omega * math.sin(begin) * times - 0.5 * gravity * math.cos(inclination) * times**2
    lands = np.flatnonzero(part_z[100:] <= plate_z[100:])[0] + 100
    flight = times[lands]
    in_flight = a_x / omega * math.sin(begin + phase_shift) * flight
    in_flight -= 0.5 * gravity * math.sin(inclination) * flight**2
    return frequency * (in_flight + plate_x[-1] - plate_x[lands])


def test_the_level_straight_line_drive_has_the_textbook_velocity():
    """v = g n² cot φ/(2 f)."""
    amplitudes = np.linspace(48.0, 155.0, 50)
    cycles = throw_theory.flight_cycles(throw_theory.throw_number(amplitudes, **PAPER))
    textbook = 9.81 * cycles**2 / (math.tan(PAPER["angle"]) * 2.0 * 50.0)
    assert throw_theory.throw_velocity(amplitudes, **PAPER) == pytest.approx(textbook, rel=1e-9)


def test_numbers_of_the_papers_conveyor():
    throw = throw_theory.throw_number(60.0, **PAPER)
    assert throw == pytest.approx(1.27, abs=5e-3)
    assert throw_theory.flight_cycles(throw) == pytest.approx(0.438, abs=5e-4)
    assert throw_theory.throw_velocity(60.0, **PAPER) == pytest.approx(0.089, abs=5e-4)


@pytest.mark.parametrize(("inclination", "phase_shift"), [(0.0, 0.0), (0.05, 0.0), (0.0, 1.0), (0.08, -0.7)])
def test_the_general_form_agrees_with_the_motion_step_by_step(inclination, phase_shift):
    shape = {**PAPER, "inclination": inclination, "phase_shift": phase_shift}
    for acceleration in (55.0, 80.0, 130.0):
        expected = velocity_by_steps(acceleration, **shape)
        assert throw_theory.throw_velocity(acceleration, **shape) == pytest.approx(expected, abs=2e-4)


def test_there_is_no_throw_up_to_one_and_no_theory_for_longer_flights():
    cycles = throw_theory.flight_cycles([0.0, 0.5, 1.0, 1.0 + 1e-8, throw_theory.LONGEST_THROW, 3.3])
    assert cycles[:3].tolist() == [0.0, 0.0, 0.0]
    assert cycles[3] == pytest.approx(math.sqrt(32.0 * 1e-8) / (2.0 * math.pi), rel=1e-4)  # Γ = 1 + N²/32 + …
    assert cycles[4] == pytest.approx(1.0)
    assert np.isnan(cycles[5])
    assert throw_theory.throw_velocity([10.0, 160.0], **PAPER).tolist() == pytest.approx([0.0, np.nan], nan_ok=True)


def test_throw_number_of_a_flight_is_smooth_where_the_series_takes_over():
    border = 2.0 * throw_theory.SHORT / (2.0 * math.pi)
    below, above = throw_theory.throw_number_of_flight(border * np.array([1.0 - 1e-9, 1.0 + 1e-9])) - 1.0
    assert below == pytest.approx(above, rel=1e-8)
