"""Random conveyors and initial conditions that the solver must handle."""

import math

import numpy as np

from conveyor.parameters import RANGES, TENSION_MODES
from conveyor.solver import model
from conveyor.solver.model import Conveyor, Start, pack

# Shares of the random points with a usual exponent, a part that starts on the plate, a plate at rest, or no damping.
SHARE = 0.1
ALONG_THE_TRACK = ("inclination", "phase_shift", "static_friction")


def tension_and_exponent(points: np.ndarray, generator: np.random.Generator) -> None:
    """Fill the columns of tension and exponent: all modes; exponents in [1, 3], often Hooke, Hertz or integers."""
    count = len(points)
    usual = generator.choice([1.0, 1.5, 1.5, 2.0, 3.0], count)
    low, high = RANGES["exponent"]
    points[:, model.EXPONENT] = np.where(generator.random(count) < 0.5, usual, generator.uniform(low, high, count))
    points[:, model.TENSION] = generator.integers(len(model.TENSION_MODES), size=count)


def level_track(points: np.ndarray) -> None:
    """Fill the columns of ALONG_THE_TRACK as on the paper's conveyor."""
    points[:, [model.INCLINATION, model.PHASE_SHIFT]] = 0.0
    points[:, model.STATIC_FRICTION] = points[:, model.FRICTION]


def tilted(points: np.ndarray, seed: int) -> np.ndarray:
    """The same points on inclined tracks with elliptical drives and, in half of them, a larger static friction."""
    generator, points = np.random.default_rng(seed), points.copy()
    for name in ("inclination", "phase_shift"):
        points[:, model.PARAMETERS.index(name)] = generator.uniform(*RANGES[name], len(points))
    ratio = np.where(generator.random(len(points)) < 0.5, 1.0, generator.uniform(1.0, 3.0, len(points)))
    points[:, model.STATIC_FRICTION] = np.minimum(ratio * points[:, model.FRICTION], RANGES["static_friction"][1])
    return points


def around_the_paper(count: int, seed: int) -> np.ndarray:
    """Packed parameters, shape (count, 13): log-uniform over two decades around the defaults where possible.

    Amplitudes reach 150 m/s², frequencies 5 to 500 Hz; every tenth part starts on the plate.
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
    points[:, model.GRAVITY] = default.gravity
    level_track(points)
    tension_and_exponent(points, generator)
    points[:, model.Z0] = np.where(generator.random(count) < SHARE, np.nan, generator.uniform(-1e-4, 5e-3, count))
    points[:, model.VZ0] = generator.normal(0.0, 0.2, count)
    return points


def for_lanes(count: int, seed: int) -> np.ndarray:
    """Packed parameters, shape (count, 16), of random conveyors; lanes cannot follow every fourth."""
    generator = np.random.default_rng(seed)
    points = []
    for k in range(count):
        conveyor = Conveyor(
            acceleration=generator.uniform(0.0, 90.0) * (generator.random() < 0.9),
            angle=generator.uniform(0.05, 0.5),
            frequency=generator.uniform(20.0, 100.0),
            psi0=generator.choice([generator.uniform(-12.0, 12.0), -np.pi, 0.0]),
            stiffness=10.0 ** generator.uniform(4.0, 6.5),
            damping=generator.uniform(0.0, 1.0),
            exponent=1.0 if k % 8 == 3 else 1.5,
            tension=TENSION_MODES[1 + generator.integers(2)] if k % 8 == 7 else "allow",
        )
        height = [generator.uniform(-1e-4, 0.0), generator.uniform(0.0, 1e-3), "conveyor"][generator.integers(3)]
        points.append(pack(conveyor, Start(height, generator.uniform(-0.2, 0.2))))
    return np.array(points)


def on_map(acceleration: float, count: int) -> np.ndarray:
    """Packed parameters, shape (count, 16): initial conditions of the paper's conveyor as on its maps."""
    generator = np.random.default_rng(int(acceleration))
    points = np.tile(pack(Conveyor(acceleration=acceleration), Start()), (count, 1))
    points[:, model.Z0] = generator.uniform(0.0, 5e-4, count)
    points[:, model.PSI0] = generator.uniform(0.0, 2.0 * np.pi, count)
    return points


def whole_ranges(count: int, seed: int) -> np.ndarray:
    """Packed parameters, shape (count, 16), over all of parameters.RANGES: log-uniform, or uniform for angles.

    What may be zero reaches down to a millionth of its largest value, and is zero in every tenth point; so do heights
    and velocities of either sign, and every tenth start lies on the plate.
    """
    generator = np.random.default_rng(seed)
    points = np.empty((count, len(model.PARAMETERS)))
    for place, name in enumerate(model.PARAMETERS):
        if name not in RANGES or name in ALONG_THE_TRACK:
            continue
        low, high = RANGES[name]
        if name in ("angle", "psi0"):
            points[:, place] = generator.uniform(low, high, count)
            continue
        size = np.exp(generator.uniform(math.log(max(low, 1e-6 * high)), math.log(high), count))
        if low == 0.0:
            size[generator.random(count) < SHARE] = 0.0
        sign = generator.choice([-1.0, 1.0], count) if low < 0.0 else 1.0
        points[:, place] = np.clip(sign * size, low, high)
    level_track(points)
    tension_and_exponent(points, generator)
    points[generator.random(count) < SHARE, model.Z0] = np.nan
    return points


def deepest_allowed(parameters: np.ndarray, max_gap: np.ndarray) -> np.ndarray:
    """Penetration (m), shape (n,), that no run can exceed whose largest gap is `max_gap` (m, shape (n,)).

    Seen from the plate the part is pulled down with g + a_z at most. It hits the plate no faster than it does from the
    largest gap under this pull, the speed of the start added in squares, and is stopped where the spring has taken up
    that energy, the pull's work on the way, and what a start inside the plate has stored. Damping only takes energy.
    While it rides, the pull changes: twice the penetration under the largest one is the most that a part can reach
    without having left the plate in between.
    """
    rows = parameters.T
    omega = 2.0 * math.pi * rows[model.FREQUENCY]
    a_z = rows[model.ACCELERATION] * np.sin(rows[model.ANGLE])
    pull = rows[model.GRAVITY] * np.cos(rows[model.INCLINATION]) + a_z
    start = rows[model.VZ0] - a_z / omega * np.sin(rows[model.PSI0])
    inside = np.fmax(-a_z / omega**2 * np.cos(rows[model.PSI0]) - rows[model.Z0], 0.0)
    power = rows[model.EXPONENT] + 1.0
    spring = rows[model.STIFFNESS] / rows[model.MASS] / power
    energy = 0.5 * start**2 + pull * max_gap + spring * inside**power
    rest = (pull * power / spring / power) ** (1.0 / rows[model.EXPONENT])
    # spring δ^(p+1) = energy + pull δ: the iteration from above falls to its root.
    depth = (2.0 * energy / spring) ** (1.0 / power) + (2.0 * pull / spring) ** (1.0 / rows[model.EXPONENT])
    for _ in range(50):
        depth = ((energy + pull * depth) / spring) ** (1.0 / power)
    return np.fmax(np.fmax(depth, 2.0 * rest), inside)
