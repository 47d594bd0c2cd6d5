"""Integrators of SciPy on the same model: what is said of their runs."""

import numpy as np
import pytest
from project import read_config

from conveyor import simulate
from conveyor.methods import modes
from conveyor.packing import as_rows
from conveyor_pipeline.common import grid
from conveyor_pipeline.study.accuracy import scipy_integrators
from conveyor_pipeline.study.accuracy.scipy_integrators import EVENT_LOST, GAVE_UP, OK, STUCK, Failed, Leg, Trajectory

CONFIG = read_config()
SCENES = {"jumping": {"acceleration": 40.0, "z0": 0.3e-3}, "riding": {"acceleration": 30.0, "z0": 0.0}}


def scene(name):
    """The packed parameters of a scene."""
    return as_rows(grid.row_of(CONFIG["model"] | SCENES[name]))


def test_a_run_that_finds_the_same_event_for_ever_says_so(monkeypatch):
    """Whether SciPy finds an event again depends on last digits, so an integrator that always does takes its place."""

    def same_event(trajectory, begin, end, state, rtol, atol):
        return Leg(max(begin, 0.1), state.copy(), 0, np.empty((0, 4)), 1)

    monkeypatch.setattr(scipy_integrators, "follow", same_event)
    run = scipy_integrators.run(scene("riding"), 1.0, "DOP853", "events", 1e-8, 200_000)
    assert run.status == STUCK
    assert np.isnan(run.mean_velocity)


def test_a_run_whose_event_is_not_found_says_so_and_counts_its_evaluations(monkeypatch):
    """SciPy raises ValueError where LSODA's interpolant does not change its sign; here its stand-in always does."""

    def lose(rates, span, state, **_):
        for _ in range(7):
            rates(span[0], state)
        raise ValueError("f(a) and f(b) must have different signs")

    monkeypatch.setattr(scipy_integrators, "solve_ivp", lose)
    run = scipy_integrators.run(scene("riding"), 1.0, "LSODA", "events", 1e-8, 1000)
    assert (run.status, run.evaluations) == (EVENT_LOST, 7)


def test_scipy_makes_as_many_evaluations_as_allowed(monkeypatch):
    calls = []

    def counted_rates(derivatives, t, state, parameters, mode):
        calls.append(t)
        parameters[-1] += 1.0
        derivatives[:] = state

    monkeypatch.setattr(modes, "counted_rates", counted_rates)
    trajectory = Trajectory(scene("riding"), "RK45", 100, np.empty(0))
    with pytest.raises(Failed) as failure:
        scipy_integrators.follow(trajectory, 0.0, 1.0, np.ones(4), 1e-12, np.full(4, 1e-12))
    assert len(calls) == 100
    assert failure.value.args == (GAVE_UP, 100)


@pytest.mark.parametrize("mode", [modes.FLIGHT, modes.FORWARD, modes.BACKWARD, modes.STICK])
def test_a_mode_begins_on_its_own_side_of_the_event(mode):
    """A part that leaves or meets the plate has a gap of the right sign, a part that begins to slip has such a slip."""
    parameters, t = scene("riding"), 0.0123
    for ended in (modes.gap_of, modes.slip_of):
        z, _, vx, _ = modes.plate_motion(parameters, t)
        state = np.array([0.0, vx, z, 0.0])
        modes.put_beside(parameters, t, state, ended, mode)
        if ended is modes.gap_of:
            assert np.sign(modes.gap_of(t, state, parameters)) == (1.0 if mode == modes.FLIGHT else -1.0)
            assert state[1] == vx
        else:
            wanted = {modes.FORWARD: 1.0, modes.BACKWARD: -1.0}.get(mode, 0.0)
            assert np.sign(modes.slip_of(t, state, parameters)) == wanted
            assert state[2] == z


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_run_with_modes_meets_no_event_twice(tolerance):
    assert scipy_integrators.run(scene("riding"), 1.0, "DOP853", "modes", tolerance, 200_000).status == OK


def test_a_run_that_takes_too_many_steps_gives_up():
    run = scipy_integrators.run(scene("jumping"), 1.0, "DOP853", "sign", 1e-8, 2000)
    assert (run.status, run.evaluations) == (GAVE_UP, 2000)


@pytest.mark.parametrize("integrator", ["RK45", "DOP853", "Radau", "LSODA"])
def test_an_integrator_meets_the_reference(integrator):
    """At a loose tolerance: velocity, states in between and the times of impacts and separations."""
    conveyor, start = grid.conveyor_and_start(CONFIG["model"] | SCENES["jumping"])
    truth = simulate(conveyor, start, duration=0.1, tolerance=1e-13)
    times = np.arange(1, 14) * 7e-3
    run = scipy_integrators.run(scene("jumping"), 0.1, integrator, "modes", 1e-8, 200_000, times=times)
    assert run.status == OK
    assert run.mean_velocity == pytest.approx(truth.mean_velocity(), rel=1e-3)
    wanted = truth.sample(times)
    np.testing.assert_allclose(run.samples[:, 0], wanted["x"], atol=1e-6)
    np.testing.assert_allclose(run.samples[:, 2], wanted["z"], atol=1e-7)
    events = truth.events[np.isin(truth.events["kind"], ["impact", "separation"])]
    np.testing.assert_allclose(run.events, events["time"], atol=1e-6)
    # States between the events are interpolated.
    alone = scipy_integrators.run(scene("jumping"), 0.1, integrator, "modes", 1e-8, 200_000)
    assert alone.mean_velocity == pytest.approx(run.mean_velocity, rel=1e-13)


def test_plates_with_harmonics_are_refused():
    row = grid.row_of(CONFIG["model"] | {"harmonics": [{"order": 2, "normal": 0.1}]})
    with pytest.raises(ValueError, match="no harmonics"):
        scipy_integrators.run(row, 0.1, "DOP853", "modes", 1e-6, 1000)
