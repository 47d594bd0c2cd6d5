"""Fixed steps in lanes: sine and cosine, and bits that do not depend on the number of lanes."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.methods import fixed_step
from conveyor.methods.fixed_step_lanes import CHECK
from conveyor.methods.scheme import (
    EULER,
    EVENTS,
    FORCE_EVALUATIONS,
    IMPACTS,
    STATUS,
)
from conveyor.methods.sine import sine_and_cosine
from conveyor.solver.jit import compiled
from conveyor.solver.model import (
    FREQUENCY,
    FRICTION,
    GRAVITY,
    PHASE_SHIFT,
    PSI0,
    STATIC_FRICTION,
    TENSION_MODES,
    VZ0,
    Z0,
    pack,
)
from conveyor.solver.status import NOT_FINITE, OK

STEP = 1e-3 / 64
INDICES = np.array([0, 1, 1, 255, 256, 257, 1000, 3700, 5000])
TILTED = {"inclination": 0.1, "phase_shift": -0.8, "friction": 0.3, "static_friction": 0.9}


def follow(parameters, step=STEP, n_steps=5000, indices=INDICES, n_events=20, method=EULER):
    """Samples, events and results of trajectories; NaN where nothing was written."""
    method = fixed_step.METHODS[method]
    results, samples, events = fixed_step.follow(parameters, step, n_steps, method, indices, n_events)
    return samples, events, results


def bits(found):
    """The bits of the arrays that `follow` returns, a row for each trajectory. Every NaN counts as the same."""
    row = np.concatenate([array.reshape(len(array), -1) for array in found], axis=1)
    return np.where(np.isnan(row), math.nan, row).view(np.int64)


def random_parameters(n, seed, orders=()):
    """Random conveyors; parts that start in, on or above the plate; every fifth part leaves the range of numbers.

    orders : of the harmonics of the plates
    """
    rng = np.random.default_rng(seed)
    rows = []
    for k in range(n):
        exponent = [1.0, 1.5, 2.0, rng.uniform(1.0, 3.0), 1.5][rng.integers(5)]
        conveyor = Conveyor(
            acceleration=rng.uniform(0.0, 90.0),
            angle=rng.uniform(0.0, 0.5),
            frequency=rng.uniform(20.0, 100.0),
            psi0=rng.uniform(-12.0, 12.0),
            stiffness=10.0 ** rng.uniform(3.5, 6.0),
            damping=rng.uniform(0.0, 1.0),
            exponent=exponent,
            tension=TENSION_MODES[rng.integers(3)],
            harmonics=[{"order": k, "along": 0.2, "normal": rng.uniform(0.0, 0.3), "along_phase": 1.0} for k in orders],
            **(TILTED if k % 3 == 1 else {"friction": rng.uniform(0.0, 0.5)}),
        )
        height = [rng.uniform(-1e-4, 0.0), rng.uniform(0.0, 1e-3), "conveyor"][rng.integers(3)]
        rows.append(pack(conveyor, Start(height, rng.uniform(-0.2, 0.2))))
        if k % 10 == 3:  # far too deep, at once
            rows[k][GRAVITY] = 1e308
        if k % 10 == 8:  # far too fast, upwards, in the course of the run
            rows[k][[GRAVITY, Z0, VZ0]] = -1e308, 1e-3, rng.uniform(1.6e308, 1.79e308)
    return np.array(rows)


@compiled
def fill(phases, values):
    for i in range(len(phases)):
        values[i, 0], values[i, 1] = sine_and_cosine(phases[i])


@pytest.mark.parametrize("size", [1.0, 1e3, 1e6, 1e9])
def test_sine_and_cosine(size):
    """Within two units in the last place of the C library, which itself errs by half a unit."""
    rng = np.random.default_rng(1)
    quarters = np.round(rng.uniform(-size, size, 3000)) * (0.5 * math.pi)
    phases = np.concatenate([rng.uniform(-size, size, 20_000), quarters, np.nextafter(quarters, 0.0)])
    values = np.empty((len(phases), 2))
    fill(phases, values)
    exact = np.array([(math.sin(phase), math.cos(phase)) for phase in phases])
    assert (np.abs(values - exact) <= 2.0 * np.spacing(np.abs(exact))).all()
    assert (values == exact).mean() > 0.75


def test_sine_and_cosine_of_zero_are_exact():
    values = np.empty((1, 2))
    fill(np.zeros(1), values)
    assert values.tolist() == [[0.0, 1.0]]


@pytest.mark.parametrize("orders", [(), pytest.param((2, 5), marks=pytest.mark.long)])
@pytest.mark.parametrize("method", range(len(fixed_step.METHODS)))
def test_a_group_agrees_with_single_runs(method, orders):
    """For one, two, four, eight and any other number of trajectories side by side."""
    parameters = random_parameters(17, 100, orders)
    single = np.concatenate([bits(follow(parameters[[k]], method=method)) for k in range(17)])
    for n in (1, 2, 3, 4, 7, 8, 9, 17):
        found = follow(parameters[:n], method=method)
        np.testing.assert_array_equal(bits(found), single[:n])
    # The comparison is meaningful.
    evaluations, status = found[2][:, FORCE_EVALUATIONS], found[2][:, STATUS]
    assert (found[2][:, IMPACTS] > 1).sum() > 5
    assert set(status) == {OK, NOT_FINITE}
    assert len(set(evaluations)) > 1


def test_plates_of_a_group_have_harmonics_of_the_same_orders():
    parameters = np.concatenate([random_parameters(1, 100, orders) for orders in ((2, 5), (2, 4))])
    with pytest.raises(ValueError, match="same orders"):
        follow(parameters)


@pytest.mark.long
def test_plates_that_differ_only_in_their_harmonics_are_not_alike():
    parameters = random_parameters(17, 100, orders=(2, 5))
    parameters[:, [FREQUENCY, PSI0, PHASE_SHIFT]] = parameters[0, [FREQUENCY, PSI0, PHASE_SHIFT]]
    single = np.concatenate([bits(follow(parameters[[k]])) for k in range(17)])
    np.testing.assert_array_equal(bits(follow(parameters)), single)


def test_a_state_that_is_not_finite():
    """Only the row that leaves the range of numbers ends, at the next check, with a status."""
    calm, lost = random_parameters(1, seed=5)[0], pack(Conveyor(), Start(1e-3))
    lost[[GRAVITY, VZ0]] = -1e308, 1.77e308
    samples, _, results = follow(np.array([calm, lost, calm]))
    np.testing.assert_array_equal(results[0], results[2])
    assert results[:, STATUS].tolist() == [OK, NOT_FINITE, OK]
    assert results[:, FORCE_EVALUATIONS].tolist() == [5000, 3 * CHECK, 5000]
    assert np.isfinite(samples[1, :6]).all()
    assert np.isnan(samples[1, 6:]).all()
    assert np.isfinite(samples[[0, 2]]).all()


def test_events_of_a_trajectory_end_where_it_is_lost():
    """Friction without bounds loses the velocity along the track; the gap of this part still opens and closes."""
    calm = pack(Conveyor(), Start(1e-4))
    lost = calm.copy()
    lost[[FRICTION, STATIC_FRICTION]] = 1e308
    _, events, results = follow(np.array([lost, calm]))
    assert results[:, STATUS].tolist() == [NOT_FINITE, OK]
    seen = int(results[0, EVENTS])
    assert 0 < seen < results[1, EVENTS]
    np.testing.assert_array_equal(events[0, :seen], events[1, :seen])
    assert np.isnan(events[0, seen:]).all()
