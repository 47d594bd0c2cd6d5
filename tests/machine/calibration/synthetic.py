"""Synthetic measurements from the library: parts whose parameters are known, measured with noise.

`simulate` follows each part by itself, with a tighter tolerance than the calibration uses.
"""

from collections.abc import Sequence

import numpy as np

from conveyor import Conveyor, Start, parameter_table, simulate
from conveyor.analysis.map_states import plate_heights
from conveyor_pipeline.machine.calibration.measurements import DEFAULTS

TOLERANCE = 1e-9
FORMAT = ".4g"


def true_velocity(
    model: dict, acceleration: float, box: dict, random: np.random.Generator, duration: float = DEFAULTS["duration"]
) -> float:
    """Mean velocity (m/s) of one part with a random initial condition from the box.

    duration : s over which the velocity is measured, and time on the track before
    """
    height, vz, phase = (float(random.uniform(*box[name])) for name in ("height", "vz0", "psi0"))
    conveyor = Conveyor(**{**model, "acceleration": acceleration, "psi0": phase})
    start = Start(float(height + plate_heights(parameter_table(conveyor).reshape(1))[0]), vz)
    run = simulate(conveyor, start, duration=2.0 * duration, tolerance=TOLERANCE)
    x = run.sample(np.array([duration, 2.0 * duration]))["x"]
    return float((x[1] - x[0]) / duration)


def measure(
    model: dict, accelerations: Sequence[float], box: dict, noise: float, random: np.random.Generator, **options: float
) -> list[tuple[float, float]]:
    """Amplitude (m/s²) and velocity (m/s) of one part for each amplitude, with a relative `noise` of the velocity."""
    rows = []
    for acceleration in accelerations:
        velocity = true_velocity(model, float(acceleration), box, random, **options)
        rows.append((float(acceleration), velocity * (1.0 + noise * float(random.standard_normal()))))
    return rows


def csv_text(rows: Sequence[tuple[float, float]], comment: str, **others: float) -> str:
    """A file of measurements that begins with a comment; `others` are further columns, equal in all rows."""
    lines = [f"# {comment}", ",".join(["acceleration", "velocity", *others])]
    for acceleration, velocity in rows:
        lines.append(",".join([f"{acceleration:.5g}", f"{velocity:{FORMAT}}", *map(str, others.values())]))
    return "\n".join([*lines, ""])
