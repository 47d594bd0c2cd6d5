"""A synthetic accelerometer file for the example: a drive with two harmonics, a tilted sensor, and noise."""

import math

import numpy as np

from conveyor_pipeline.machine.excitation.reading import STANDARD_GRAVITY

# A linear feeder whose electromagnet pulls with the square of the current: order 2. Its springs stiffen: order 3.
ACCELERATION, FREQUENCY, ANGLE, PHASE_SHIFT = 36.0, 50.0, 0.22, 0.12  # m/s², Hz, rad, rad
HARMONICS = ((2, 0.045, 1.4, 0.06, 1.6), (3, 0.012, -0.6, 0.015, 2.4))  # order, along, its phase, normal, its phase
MOUNT, OFFSETS = 0.1, (0.1, 0.995)  # rad, g: gravity
DRIFT = 0.01  # relative change of the amplitude during the recording
SEED = 3
SAMPLES, RATE, JITTER = 1600, 1600.0, 0.2  # samples per second; of the times, relative to the interval
NOISE, STEP = 0.02, 0.001  # g


def make() -> str:
    """The text of the file."""
    random = np.random.default_rng(SEED)
    time = (np.arange(SAMPLES) + JITTER * random.uniform(-0.5, 0.5, SAMPLES)).round(3) / RATE
    theta = 2.0 * math.pi * FREQUENCY * time + random.uniform(0.0, 2.0 * math.pi)
    along, normal = np.cos(theta + PHASE_SHIFT), np.cos(theta)
    for order, share_along, phase_along, share_normal, phase_normal in HARMONICS:
        along = along + share_along * np.cos(order * theta + phase_along)
        normal = normal + share_normal * np.cos(order * theta + phase_normal)
    size = ACCELERATION / STANDARD_GRAVITY * (1.0 + DRIFT * (time / time[-1] - 0.5))
    along, normal = size * math.cos(ANGLE) * along, size * math.sin(ANGLE) * normal
    sensor = np.array(
        [along * math.cos(MOUNT) + normal * math.sin(MOUNT), -along * math.sin(MOUNT) + normal * math.cos(MOUNT)]
    )
    readings = sensor + np.array(OFFSETS)[:, None] + NOISE * random.standard_normal(sensor.shape)
    readings = STEP * np.round(readings / STEP)
    rows = [f"{at:.7f},{x:.3f},{z:.3f}" for at, (x, z) in zip(time, readings.T, strict=True)]
    made_by = "snakemake --force config/examples/accelerometer.csv"
    return "\n".join([f"# Synthetic, not measured: made by `{made_by}`, in g", "time,x,z", *rows, ""])
