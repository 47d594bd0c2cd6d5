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


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_a_run_that_finds_the_same_events_for_ever_says_so_at_once(tolerance):
    run = peers.run(scene("riding"), 1.0, "DOP853", "events", tolerance, 200_000)
    assert run.status == peers.STUCK
    assert np.isnan(run.mean_velocity)
    # Three events until the one that ends where it begins, and twice that one.
    assert run.evaluations < 2000
    beside = peers.run(scene("riding"), 1.0, "DOP853", "modes", tolerance, 200_000)
    assert beside.status == peers.OK


def test_a_run_that_takes_too_many_steps_gives_up():
    run = peers.run(scene("jumping"), 1.0, "DOP853", "sign", 1e-8, 2000)
    assert (run.status, run.evaluations) == (peers.GAVE_UP, 2000)
