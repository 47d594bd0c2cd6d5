"""When parts arrive, against parabolas in a flight above an inclined track and against samples."""

import math

import numpy as np
import pytest

from conveyor import Block, Conveyor, Start, block_transits, parameter_table, simulate, simulate_block, transits

BLOCK = Block(5e-3, 1e-3)


def arrivals(conveyor: Conveyor, z0: float, length: float, longest: float = 1.0) -> np.ndarray:
    """Arrival (s) of a point, and of a block without tilt."""
    parameters = parameter_table(conveyor, z0=[z0])
    point = transits(parameters, [length], [longest], begin=0.0).arrival[0, 0]
    block = block_transits(parameters, BLOCK, 0.0, length=length, longest=longest, begin=0.0)
    return np.array([point, block.arrival[0]])


def test_parts_arrive_in_a_flight_down_an_inclined_track():
    conveyor = Conveyor(acceleration=40.0, inclination=-0.3)
    exact = math.sqrt(2.0 * 1e-3 / (conveyor.gravity * math.sin(0.3)))
    assert arrivals(conveyor, 5e-3, 1e-3) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("inclination", [-0.2, 0.0, 0.1])
@pytest.mark.parametrize("length", [2e-3, 1e-2])
def test_arrivals_are_the_first_times_at_which_samples_are_there(inclination, length):
    conveyor = Conveyor(acceleration=70.0, angle=0.5, inclination=inclination, friction=0.3)
    runs = simulate(conveyor, Start(z=5e-4)), simulate_block(conveyor, BLOCK, Start(z=5e-4))
    times = np.linspace(0.0, 1.0, 100_001)
    for arrival, run in zip(arrivals(conveyor, 5e-4, length), runs, strict=True):
        x = run.sample(times)["x"]
        first = int(np.argmax(x >= length))
        assert x[first] >= length
        assert times[first - 1] <= arrival <= times[first] + 1e-6


def test_a_part_that_turns_back_in_a_flight_has_arrived():
    conveyor = Conveyor(acceleration=80.0, angle=0.5, inclination=0.2, friction=0.3)
    times = np.linspace(0.0, 0.3, 300_001)
    parameters = parameter_table(conveyor, z0=[1e-3])
    motion = simulate(conveyor, Start(z=1e-3), duration=0.3).sample(times)
    x = motion["x"]
    top = np.argmax(x)
    assert x[top] > x[-1] and motion["contact_force"][top] == 0.0
    length = x[top] * (1.0 - 1e-6)
    arrival = transits(parameters, [length], [0.3], begin=0.0).arrival[0, 0]
    assert arrival == pytest.approx(times[np.argmax(x >= length)], abs=2e-6)


def test_airtime_ends_with_the_arrival():
    """Parts that are still falling when they arrive have been in the air all the time."""
    conveyor = Conveyor(acceleration=40.0, inclination=-0.3)
    run = block_transits(parameter_table(conveyor, z0=[0.5]), BLOCK, 0.0, length=1e-3, longest=1.0, begin=0.0)
    assert run.airtime == pytest.approx(1.0)
    level = parameter_table(Conveyor(acceleration=90.0), psi0=np.linspace(0.0, 6.0, 100))
    assert block_transits(level, BLOCK, 0.02, length=2e-3, longest=1.0, begin=0.0).airtime.max() <= 1.0


def test_the_peak_force_counts_from_the_beginning_of_the_window():
    """A contact that is open when the last quarter begins, and whose force only falls."""
    conveyor = Conveyor(acceleration=0.0, stiffness=1e4, damping=0.0, exponent=1.0, mass=1e-2, friction=0.0)
    run = simulate_block(conveyor, Block(0.1, 0.01), Start(z=1e-3, vz=-1.0), duration=4e-3)
    depth = -run.sample([3e-3])["z"][0]
    assert run.peak_force == pytest.approx(conveyor.stiffness * depth, rel=1e-6)
