"""The solution in arithmetic of many digits: closed forms, and the solver at its tightest tolerance."""

import numpy as np
import pytest

from accuracy import multiprecision
from conveyor import Conveyor, Start, simulate

DIGITS = 26


def test_free_fall_is_a_parabola_that_ends_at_the_root_of_the_gap():
    """A plate at rest: the part lands after √(2 z0/g)."""
    conveyor = Conveyor(acceleration=0.0)
    states, events = multiprecision.simulate(conveyor, Start(z=1e-3), np.array([0.005, 0.0143]), DIGITS)
    assert states[0, 2] == pytest.approx(1e-3 - 0.5 * conveyor.gravity * 0.005**2, rel=1e-14)
    assert events[0] == pytest.approx(np.sqrt(2e-3 / conveyor.gravity), rel=1e-15)


def test_an_undamped_hertz_impact_keeps_its_speed_and_has_the_known_duration():
    """Duration 2.9432 δ/v with δ = (5 m v²/(4 k))^(2/5); the weight is small compared with the spring force."""
    conveyor = Conveyor(acceleration=0.0, damping=0.0, gravity=1e-3)
    speed = 0.3
    states, events = multiprecision.simulate(conveyor, Start(z=1e-6, vz=-speed), np.array([2e-3]), DIGITS)
    depth = (1.25 * conveyor.mass * speed**2 / conveyor.stiffness) ** 0.4
    assert events[1] - events[0] == pytest.approx(2.9432750658 * depth / speed, rel=1e-5)
    assert states[0, 3] == pytest.approx(speed - conveyor.gravity * 2e-3, rel=1e-5)


@pytest.mark.parametrize("other", [{"inclination": 0.1}, {"phase_shift": 0.1}, {"static_friction": 0.2}])
def test_other_tracks_and_drives_are_refused(other):
    with pytest.raises(ValueError, match=next(iter(other))):
        multiprecision.simulate(Conveyor(**other), Start(z=1e-3), np.array([1e-3]), DIGITS)


def test_it_agrees_with_the_solver():
    conveyor, start, times = Conveyor(acceleration=40.0), Start(z=3e-4), np.arange(1, 15) * 7e-3
    states, events = multiprecision.simulate(conveyor, start, times, DIGITS)
    run = simulate(conveyor, start, duration=0.1, tolerance=1e-14)
    own = run.sample(times)
    for column, name in zip(states.T, ("x", "vx", "z", "vz"), strict=True):
        np.testing.assert_allclose(column, own[name], rtol=0.0, atol=1e-14)
    changes = run.events["time"][np.isin(run.events["kind"], ["impact", "separation"])]
    np.testing.assert_allclose(events, changes[: len(events)], rtol=0.0, atol=1e-15)
