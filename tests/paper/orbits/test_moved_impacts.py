"""The mechanism of Fig. 22: fixed steps lock the impacts, so that a shift in time does not stay a shift in time."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start, simulate
from conveyor_pipeline.paper.orbits import moved_impacts


def compare(epsilon: float, **method) -> list[dict]:
    """The rows of a motion with short flights and of its run with a phase that is larger by epsilon (rad)."""
    runs = [simulate(Conveyor(acceleration=55.0, psi0=psi0), Start("conveyor"), **method) for psi0 in (0.0, epsilon)]
    return moved_impacts.compare(*runs, time_shift=epsilon / (2.0 * math.pi * 50.0))


@pytest.mark.parametrize("step", [5e-7, 2.5e-7])
def test_no_impact_of_the_paper_s_method_moves_and_the_difference_grows(step):
    """The differences of all contacts add up: the growth is linear, and has nothing to do with the step."""
    rows = compare(1e-8, method="euler", step=step)
    assert rows[-1]["impacts"] == 50
    assert [row["moved"] for row in rows] == [0] * len(rows)
    growth = np.array([row["difference"] for row in rows]) / 1e-8
    per_cycle = np.diff(growth)[10:]
    np.testing.assert_allclose(per_cycle, per_cycle.mean(), rtol=0.05)
    assert growth[-1] == pytest.approx(1.77, abs=0.01)
