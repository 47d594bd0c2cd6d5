"""Vertical runs in lanes: bit for bit equal to single runs, for any neighbours."""

import numpy as np
import pytest
from random_conveyors import for_lanes, on_map

from conveyor import Conveyor, Start
from conveyor.solver import repeated_steps, trajectory, vertical_lanes
from conveyor.solver.horizontal import CONTACT_FORCE, VZ, Z
from conveyor.solver.model import STIFFNESS, pack

TOLERANCE = 1e-8
COUNTED = [trajectory.CODE, trajectory.IMPACTS, trajectory.CONTACT_TIME, trajectory.MAX_GAP]
COUNTED += [trajectory.IMPACT_SPEED, trajectory.PEAK_FORCE]


def last_quarters(durations):
    return np.column_stack([0.75 * durations, durations])


def one_by_one(parameters, durations):
    times = last_quarters(durations)
    samples, results = trajectory.integrate(parameters, times, tolerance=TOLERANCE, feeding=False)
    return samples[:, 1, [Z, VZ, CONTACT_FORCE]], results[:, COUNTED]


def together(parameters, durations):
    times = last_quarters(durations)
    samples, results = vertical_lanes.integrate(parameters, times, tolerance=TOLERANCE)
    return samples[:, [Z, VZ, CONTACT_FORCE]], results[:, COUNTED]


def assert_same(found, wanted, rows=slice(None)):
    for array, expected in zip(found, wanted, strict=True):
        np.testing.assert_array_equal(array[rows], expected[rows])


def random_runs(count, seed):
    """Packed parameters and durations (s)."""
    return for_lanes(count, seed), 10.0 ** np.random.default_rng(seed).uniform(-5.0, 0.0, count)


def runs_of_map(acceleration):
    """Initial conditions of one conveyor, and a duration (s) in which most of them settle."""
    return on_map(acceleration, 24), np.full(24, 1.0)


def test_bits_of_random_runs():
    runs = random_runs(80, seed=1)
    assert_same(together(*runs), one_by_one(*runs))


@pytest.mark.parametrize("acceleration", [30.0, 40.0, 47.0, 80.0])
def test_bits_of_maps(acceleration):
    """At 30, 40 and 47 m/s² runs end within repeated steps, in contact or in flight, and chaos repeats none."""
    runs = runs_of_map(acceleration)
    assert_same(together(*runs), one_by_one(*runs))


def test_bits_of_settled_cycles_with_more_steps_than_are_kept():
    conveyor = Conveyor(acceleration=30.0, frequency=10.0, stiffness=3e6, damping=1.0)
    parameters = np.array([pack(conveyor, Start(z0)) for z0 in np.linspace(0.0, 1e-4, 16)])
    _, results = trajectory.integrate(parameters, np.ones((16, 1)), tolerance=TOLERANCE, feeding=False)
    assert (results[:, trajectory.REPEATS] > 0).all()
    assert (results[:, [trajectory.STEPS, trajectory.REPEATS]].sum(axis=1) > 10 * repeated_steps.PLACES).all()
    runs = parameters, np.full(16, 1.0)
    assert_same(together(*runs), one_by_one(*runs))


@pytest.mark.parametrize("count", [0, 1, 7, 8, 9, 17])
def test_runs_may_be_fewer_than_lanes_and_in_any_order(count):
    parameters, durations = random_runs(count, seed=2)
    wanted = together(parameters, durations)
    backwards = together(parameters[::-1].copy(), durations[::-1].copy())
    assert_same([array[::-1] for array in backwards], wanted)


def test_failures_keep_their_row_and_disturb_nobody():
    calm = runs_of_map(40.0)
    parameters = calm[0].copy()
    parameters[[0, 5], 0] = np.nan
    parameters[7, STIFFNESS] = 1e300
    parameters[9] = pack(Conveyor(damping=1e6, stiffness=1e15), Start())
    bad = [0, 5, 7, 9]
    found = together(parameters, calm[1])
    assert_same(found, one_by_one(parameters, calm[1]))
    assert (found[1][bad, 0] != trajectory.OK).all()
    assert_same(found, one_by_one(*calm), np.setdiff1d(np.arange(24), bad))
