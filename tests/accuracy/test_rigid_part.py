"""A rigid part in place of the contact: its state of motion and its period."""

import numpy as np
import pytest

from accuracy import rigid_part
from conveyor import Conveyor, parameter_table


def test_states_of_parts_that_move_along_jump_and_jump_without_end():
    found = rigid_part.sweep(
        {"axes": {"acceleration": [15.0, 40.0, 90.0]}, "model": {"z0": 0.3e-3}, "duration": 0.1}, cycles=400
    )
    assert found.state.tolist() == ["first", "second", "undecided"]
    assert (found.mean_velocity > 0.0).all()


def test_rest_on_the_plate_is_no_flight():
    """In each cycle, this part makes some small bounces and rests for more than half of the cycle."""
    axes = {"acceleration": [48.0], "z0": [0.0]}
    found = rigid_part.sweep({"axes": axes, "model": {}, "duration": 0.1}, cycles=400)
    assert found.state.tolist() == ["first"]


@pytest.mark.parametrize(("period", "found"), [(1, 1), (3, 3), (5, 0)])
def test_the_period_is_the_first_after_which_heights_repeat(period, found):
    times = rigid_part.sample_times(parameter_table(Conveyor()), 10.0, 4)
    jumps = np.sin(100.0 * np.pi * times / period) + 0.1 * np.sin(100.0 * np.pi * times)
    assert rigid_part.find_period(jumps, range(1, 5)) == found
