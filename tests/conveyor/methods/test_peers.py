"""Other integrators on the same model: what is said of their runs."""

import numpy as np
import pytest
from project import read_config

from conveyor.methods import peers
from pipeline import grid

CONFIG = read_config()


def scene(name):
    """The packed parameters of a scene of the config."""
    return grid.packed(CONFIG["model"] | CONFIG["precision"]["scenes"][name])


def test_a_run_that_finds_the_same_event_for_ever_says_so(monkeypatch):
    """Whether SciPy finds an event again depends on last digits, so an integrator that always does takes its place."""
    monkeypatch.setattr(peers, "leg_of_scipy", lambda rates, t, end, state, options: (max(t, 0.1), state, peers.gap_of))
    run = peers.run(scene("riding"), 1.0, "DOP853", "events", 1e-8, 200_000)
    assert run.status == peers.STUCK
    assert np.isnan(run.mean_velocity)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_run_with_modes_meets_no_event_twice(tolerance):
    assert peers.run(scene("riding"), 1.0, "DOP853", "modes", tolerance, 200_000).status == peers.OK


def test_a_run_that_takes_too_many_steps_gives_up():
    run = peers.run(scene("jumping"), 1.0, "DOP853", "sign", 1e-8, 2000)
    assert (run.status, run.evaluations) == (peers.GAVE_UP, 2000)
