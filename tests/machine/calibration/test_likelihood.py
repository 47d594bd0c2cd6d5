"""Densities of measured velocities: one velocity, several, chaos, outliers; and the searched parameters."""

import math

import numpy as np
import pytest
from scipy.stats import norm

from conveyor import Conveyor, Start, simulate
from conveyor_pipeline.machine.calibration.likelihood import (
    FIRST,
    OUTLIERS,
    conditions_of,
    is_known,
    log_densities,
    velocities,
    widths,
)
from conveyor_pipeline.machine.calibration.measurements import Measurement
from conveyor_pipeline.machine.calibration.search_space import bounds_of, values_at

NOISE = 0.02
BOX = {"height": [0.0, 5e-4], "vz0": [-0.2, 0.2], "psi0": [0.0, 2.0 * math.pi], "static_friction": 0.0}
MODEL = {"frequency": 50.0, "angle": 0.2094, "mass": 0.7e-3, "gravity": 9.81, "inclination": 0.0, "phase_shift": 0.0}
CONTACT = {"friction": 0.15, "damping": 0.3, "stiffness": 5e5}
PLATE = np.array([0.13])


def density(measured, parts, sd=math.nan):
    return np.exp(log_densities(np.array([measured]), np.array([parts]), np.array([sd]), PLATE, NOISE))[0]


def test_parts_with_one_velocity_give_a_normal_density():
    wanted = (1.0 - OUTLIERS) * norm.pdf(0.051, 0.05, math.hypot(0.02 * 0.05, 5e-4 * 0.13)) + OUTLIERS * 0.5 / 0.13
    assert density(0.051, np.full(24, 0.05)) == pytest.approx(wanted, rel=1e-6)
    wanted = (1.0 - OUTLIERS) * norm.pdf(0.051, 0.05, math.hypot(0.003, 5e-4 * 0.13)) + OUTLIERS * 0.5 / 0.13
    assert density(0.051, np.full(24, 0.05), sd=0.003) == pytest.approx(wanted, rel=1e-6)


def test_nothing_lies_between_two_coexisting_velocities():
    parts = np.repeat([0.01, 0.08], [6, 18])
    one, both = density(0.08, np.full(24, 0.08)), density(0.08, parts)
    assert both == pytest.approx(0.75 * one, rel=0.02)
    assert density(0.045, parts) == pytest.approx(OUTLIERS * 0.5 / 0.13, rel=1e-6)


def test_chaos_gives_a_smooth_density():
    parts = np.random.default_rng(1).normal(0.05, 0.01, 24)
    grid = np.linspace(0.035, 0.065, 61)
    found = np.array([density(one, parts) for one in grid])
    assert found.min() > 0.2 * norm.pdf(0.035, 0.05, 0.01)
    assert np.sum(found) * (grid[1] - grid[0]) == pytest.approx(0.9, abs=0.15)


def test_widths_are_distances_to_the_fourth_neighbour_in_any_order():
    values = np.random.default_rng(2).random((3, 24))
    values[0, 5:9] = np.nan
    found = widths(values)
    for row, own in zip(values, found, strict=True):
        known = row[~np.isnan(row)]
        most = 0.4 * known.std()
        for value, width in zip(row, own, strict=True):
            if not np.isnan(value):
                assert width == pytest.approx(min(1.5 * np.sort(np.abs(known - value))[4], most))


@pytest.mark.filterwarnings("error")
def test_parts_that_cannot_be_followed_do_not_support_a_velocity():
    parts = np.full(24, 0.05)
    half = np.where(np.arange(24) < 12, np.nan, parts)
    assert density(0.05, half) == pytest.approx(0.5 * density(0.05, parts), rel=0.02)
    assert density(0.05, np.full(24, np.nan)) == pytest.approx(OUTLIERS * 0.5 / 0.13)


def test_velocities_are_those_of_single_runs():
    row = Measurement(1, 40.0, 0.05, None, 0.5, 0.25, {"z0": 3e-4, "vz0": 0.0, "psi0": 0.5})
    conditions, of = conditions_of([row, row._replace(line=2, velocity=0.06)], MODEL)
    assert list(of) == [0, 0]
    values = {name: np.array([value]) for name, value in CONTACT.items()}
    found = velocities(values, conditions, BOX, parts=8, seed=1)
    run = simulate(Conveyor(acceleration=40.0, psi0=0.5, **MODEL, **CONTACT), Start(3e-4, 0.0), duration=0.75)
    x = run.sample(np.array([0.25, 0.75]))["x"]
    assert found == pytest.approx(np.full((1, 1, 8), (x[1] - x[0]) / 0.5), rel=1e-3)


def test_velocities_do_not_depend_on_the_threads_and_differ_where_states_coexist():
    rows = [Measurement(1, one, 0.05, None, 0.2, 0.2, {}) for one in (25.0, 40.0)]
    conditions, _ = conditions_of(rows, MODEL)
    values = {name: np.full(5, value) for name, value in CONTACT.items()}
    options = {"parts": 16, "seed": 3}
    one, two = (velocities(values, conditions, BOX, threads=threads, **options) for threads in (1, 2))
    assert np.array_equal(one, two)
    assert np.ptp(one[:, 1]) > 0.02


def test_a_motion_with_a_small_share_is_not_missed_because_the_first_parts_are_alike():
    rows = [Measurement(1, 43.22, 0.0628, None, 1.0, 1.0, {})]
    conditions, _ = conditions_of(rows, MODEL | {"angle": 0.3, "mass": 1e-3})
    values = {name: np.full(60, value) for name, value in {"friction": 0.25, "damping": 0.3, "stiffness": 3e5}.items()}
    found = velocities(values, conditions, BOX, parts=24, seed=3, worth=lambda few: np.full(few.shape[:2], True))
    rare = found[:, 0] < 0.09
    assert 0.1 < rare.mean() < 0.3
    assert np.count_nonzero(~rare.any(axis=1)) <= 3


def test_static_friction_is_as_stated_or_equal_to_friction():
    measured = [Measurement(1, 20.0, 0.0, None, 0.2, 0.2, {"z0": 0.0}), Measurement(2, 20.0, 0.0, None, 0.2, 0.2, {})]
    conditions, _ = conditions_of(measured, MODEL)
    values = {name: np.full(2, value) for name, value in CONTACT.items()} | {"friction": np.array([0.15, 0.4])}
    free, equal, held = (
        velocities(values, conditions, BOX | {"static_friction": static}, parts=4, seed=3) for static in (0.0, 0.1, 0.4)
    )
    np.testing.assert_array_equal(free, equal)
    np.testing.assert_array_equal(free[1], held[1])
    assert (free[0] != held[0]).any()


def test_no_set_may_be_worth_more_parts():
    conditions, _ = conditions_of([Measurement(1, 40.0, 0.06, None, 0.2, 0.2, {})], MODEL)
    values = {name: np.full(2, value) for name, value in CONTACT.items()}
    first = velocities(values, conditions, BOX, parts=FIRST, seed=3)
    found = velocities(values, conditions, BOX, parts=24, seed=3, worth=lambda few: np.full(few.shape[:2], False))
    np.testing.assert_array_equal(found, np.tile(first, 24 // FIRST))


@pytest.mark.parametrize(
    "parameters", [["friction", "damping", "stiffness"], ["friction", "stiffness", "phase_shift"], ["damping"]]
)
def test_searched_parameters_lie_on_logarithmic_scales_between_their_bounds(parameters):
    ranges = {"friction": [0.1, 1.0], "damping": [0.01, 1.0], "stiffness": [1.0, 100.0], "phase_shift": [-1.0, 1.0]}
    model = MODEL | {name: value for name, value in CONTACT.items() if name not in parameters}
    settings = {"parameters": parameters, "ranges": {name: ranges[name] for name in parameters}, "model": model}
    bounds = bounds_of(settings)
    ends = values_at(bounds, settings)
    middle = values_at(bounds.mean(axis=0)[None], settings)
    assert list(ends) == parameters
    for name in parameters:
        wanted = 0.0 if name == "phase_shift" else math.sqrt(ends[name][0] * ends[name][1])
        assert middle[name][0] == pytest.approx(wanted)
    if "friction" in parameters:
        assert ends["friction"] == pytest.approx([0.1, 1.0])


def test_more_parts_tell_nothing_new_where_the_first_ones_have_the_measured_velocity():
    one, two = np.full(8, 0.1), np.repeat([0.1, 0.2], 4)
    few = np.array([[one, one], [two, one], [one, 2.0 * one]])
    # The first condition was measured twice.
    measured, of = np.array([0.1, 0.101, 0.1]), np.array([0, 0, 1])
    known = is_known(few, measured, of, np.full(3, 0.002))
    assert known.tolist() == [[True, True], [False, True], [True, False]]
    assert not is_known(few * np.nan, measured, of, np.full(3, 0.002)).any()
