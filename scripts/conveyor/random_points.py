"""Random conveyors and starts, to find out whether any of them breaks the solver."""

import math

import numpy as np

from . import model
from .lyapunov import sample_points
from .model import Conveyor, Start, unpack
from .parallel import for_each_chunk
from .trajectory import SAMPLES


def random_points(count: int, seed: int) -> np.ndarray:
    """Packed parameters, shape (count, 13): log-uniform over two decades around the defaults where that has a meaning.

    Amplitudes reach 150 m/s², frequencies 5 to 500 Hz, exponents all of [1, 3] with the usual ones more often; every
    tenth start lies on the plate.
    """
    generator = np.random.default_rng(seed)
    default = Conveyor()

    def around(value):
        return value * 10.0 ** generator.uniform(-1.0, 1.0, count)

    points = np.empty((count, len(model.PARAMETERS)))
    points[:, model.ACCELERATION] = np.minimum(around(default.acceleration), 150.0)
    points[:, model.ANGLE] = np.minimum(around(default.angle), 0.5 * math.pi)
    points[:, model.FREQUENCY] = around(default.frequency)
    points[:, model.PSI0] = generator.uniform(0.0, 2.0 * math.pi, count)
    points[:, model.STIFFNESS] = around(default.stiffness)
    points[:, model.DAMPING] = around(default.damping)
    points[:, model.FRICTION] = around(default.friction)
    points[:, model.MASS] = around(default.mass)
    usual = generator.choice([1.0, 1.5, 1.5, 2.0, 3.0], count)
    points[:, model.EXPONENT] = np.where(generator.random(count) < 0.5, usual, generator.uniform(1.0, 3.0, count))
    points[:, model.GRAVITY] = default.gravity
    points[:, model.TENSION] = generator.integers(len(model.TENSION_MODES), size=count)
    points[:, model.Z0] = np.where(generator.random(count) < 0.1, np.nan, generator.uniform(-1e-4, 5e-3, count))
    points[:, model.VZ0] = generator.normal(0.0, 0.2, count)
    return points


def deepest(
    parameters: np.ndarray,
    times: np.ndarray,
    tolerance: float,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> np.ndarray:
    """Largest penetration (m) at `times` (s, ascending, shape (k,)) of the runs of `parameters`, shape (n, 13).

    Shape (n,); NaN for a run that does not reach the last time. The other parameters are those of sweep.run.
    """
    depths = np.empty(len(parameters))

    def work(begin, end):
        rows = parameters[begin:end]
        heights = np.empty((len(rows), len(times)))
        sample_points(rows, times, tolerance, SAMPLES.index("z"), False, heights)
        omega = 2.0 * math.pi * rows[:, model.FREQUENCY, None]
        stroke = rows[:, model.ACCELERATION, None] * np.sin(rows[:, model.ANGLE, None]) / omega**2
        plates = -stroke * np.cos(omega * times + rows[:, model.PSI0, None])
        depths[begin:end] = np.max(plates - heights, axis=1)

    for_each_chunk(work, len(parameters), threads=threads, progress=progress)
    return depths


def deepest_allowed(parameters: np.ndarray) -> np.ndarray:
    """`deepest_possible` for each row of `parameters`, shape (n, 13): m, shape (n,)."""
    return np.array([deepest_possible(*unpack(row)) for row in parameters])


def deepest_possible(conveyor: Conveyor, start: Start) -> float:
    """A penetration (m) that no run can exceed: the spring has taken up all energy that there can be.

    In the frame of the plate the part starts with the speed |v| ≤ |ż0| + a_z/ω above the plate by at most h; each
    flight can add up to the plate's own speed to it. The bound takes the speed after falling from the highest point
    that repeated throws without loss reach, generously: twice the sum of all speeds, and the pull of gravity and plate.
    """
    omega = 2.0 * math.pi * conveyor.frequency
    a_z = conveyor.acceleration * math.sin(conveyor.angle)
    height = 0.0 if start.z == "conveyor" else abs(start.z)
    throws = 2.0 + 0.2 * conveyor.frequency
    speed = abs(start.vz) + 2.0 * throws * a_z / omega + math.sqrt(2.0 * conveyor.gravity * (height + a_z / omega**2))
    power = conveyor.exponent + 1.0
    kinetic = (power * conveyor.mass * speed**2 / (2.0 * conveyor.stiffness)) ** (1.0 / power)
    static = (power * conveyor.mass * (conveyor.gravity + a_z) / conveyor.stiffness) ** (1.0 / conveyor.exponent)
    inside = max(-start.z - a_z / omega**2, 0.0) if start.z != "conveyor" else 0.0
    return 2.0 * (kinetic + static) + 2.0 * (inside + height + a_z / omega**2)
