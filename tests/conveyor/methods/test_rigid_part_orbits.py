"""Orbit of the rigid part with one impact per cycle: closed forms, and comparison with the bouncing part."""

import math

import numpy as np
import pytest

from conveyor.methods import rigid_part_motion
from conveyor.methods.rigid_part_orbits import rigid_orbit
from conveyor.solver.model import ACCELERATION, Conveyor, Start, pack


@pytest.mark.parametrize("e", [0.3, 0.7, 0.95])
def test_one_coefficient(e):
    """a_z = π g (1 - e)/(1 + e) at the fold; with it, 2 g (1 + e²)/(1 + e)² at the doubling."""
    conveyor = Conveyor()
    found = rigid_orbit(conveyor, lambda speed: e)
    vertical, g = math.sin(conveyor.angle), conveyor.gravity
    fold = math.pi * g * (1.0 - e) / (1.0 + e)
    assert found.speed == pytest.approx(g / conveyor.frequency / (1.0 + e), rel=1e-12)
    assert found.fold == pytest.approx(fold / vertical, rel=1e-12)
    assert found.doubling == pytest.approx(
        math.hypot(fold, 2.0 * g * (1.0 + e * e) / (1.0 + e) ** 2) / vertical, rel=1e-9
    )


def test_a_coefficient_that_falls_with_the_speed_moves_the_doubling():
    speeds = np.geomspace(1e-3, 1.0, 400)
    coefficients = np.maximum(0.9 - 1.5 * speeds, 0.0)
    conveyor = Conveyor()
    found = rigid_orbit(conveyor, lambda speed: 0.9 - 1.5 * speed)

    def returns(acceleration: float, period: int) -> float:
        """Distance of the part from its place `period` cycles before, in units of its jump, after a long run."""
        row = pack(conveyor, Start(0.3e-3))
        row[ACCELERATION] = acceleration
        times = 60.0 - np.array([0, period]) / conveyor.frequency
        height = rigid_part_motion.sample(row, np.append(times, times[0] - 0.01), (speeds, coefficients))["z"]
        return abs(height[1] - height[0]) / abs(height[2] - height[0])

    assert returns(found.doubling - 0.1, 1) < 1e-6
    assert returns(found.doubling + 0.1, 1) > 1e-2
    assert returns(found.doubling + 0.1, 2) < 1e-6
    assert abs(found.doubling - rigid_orbit(conveyor, lambda speed: found.restitution).doubling) > 0.2
