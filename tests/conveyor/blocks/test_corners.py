"""Frictions of the corners of a block."""

import numpy as np
import pytest

from conveyor.blocks.corners import (
    CORNERS,
    FORCE,
    FREE,
    MODE,
    OX,
    OZ,
    REGULAR,
    ROWS,
    RUB,
    SPIN,
    STATE,
    STICK,
    Body,
    hold,
)


@pytest.mark.parametrize("height", [1e-4, 1e-3, 5e-3])
@pytest.mark.parametrize("heights", [(-1.0, -0.7, 0.7, 1.0), (-1.0, -1.0, 1.0, 1.0)])
@pytest.mark.parametrize("sticking", [(0,), (0, 1), (1, 2), (0, 1, 2), (0, 1, 2, 3)])
def test_corners_that_stick_share_the_friction_that_holds_them(sticking, heights, height):
    """Against the linear equations: no slip velocity changes, but for a slip in proportion to f/N."""
    random, sticking = np.random.default_rng(len(sticking)), list(sticking)
    body = Body(2.5e-3, 0.5 * height, (5e-3**2 + height**2) / 12.0, 0.0, None)
    state, now = np.zeros(STATE), np.zeros((ROWS, CORNERS))
    now[MODE] = FREE
    now[MODE, sticking] = STICK
    now[OX] = body.half_length * np.array([-1.0, 1.0, -1.0, 1.0])
    now[OZ] = body.half_height * np.array(heights)
    now[FORCE] = random.uniform(5.0, 50.0, CORNERS)
    state[SPIN], free, turn = random.uniform(0.5, 1.0, 3) / [1.0, 1.0, height]
    hold(body, state, now, free, turn)
    z, x, force = now[OZ, sticking], now[OX, sticking], now[FORCE, sticking]
    rates = 1.0 + np.outer(z, z) / body.inertia
    # A single corner is held without a slip.
    slips = REGULAR * np.trace(rates) / len(z) * force.sum() / force if len(z) > 1 else np.zeros(1)
    wanted = np.linalg.solve(rates + np.diag(slips), free + turn * z + state[SPIN] ** 2 * x)
    assert now[RUB, sticking] == pytest.approx(wanted, rel=1e-4, abs=1e-4 * np.abs(wanted).max())
