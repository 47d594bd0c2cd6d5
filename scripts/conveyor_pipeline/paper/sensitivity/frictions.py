"""Velocity and state of motion over the friction: at which friction the paper's velocities of both states come out."""

import numpy as np

from conveyor import classify, restart, sweep
from conveyor_pipeline.common import fields, grid

TABLES = {
    "frictions": (
        fields.number("friction", "1", "friction, sliding and static"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity over the last quarter of the run"),
        *fields.STATE,
    ),
}
AXES = {
    "friction": {"start": 0.05, "stop": 0.7, "num": 131},  # in steps of 0.005
    # m/s²: the ends of the interval of two states, Sect. 3.2, and about the critical amplitude of Fig. 3.
    "acceleration": [29.0, 47.0, 49.0, 49.25, 49.5, 49.75, 50.0],
    "z0": [0.0, 0.4e-3],  # m, below and above the critical heights of Fig. 9
}
DURATION = 1.0  # s
TOLERANCE = 1e-8
CYCLES = 2000  # excitation cycles, after which these motions have settled


def make(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table, for the model of the settings."""
    # The static friction follows the friction.
    model = {name: value for name, value in settings["model"].items() if name != "static_friction"}
    axes, parameters = grid.product(AXES, model)
    options = {"tolerance": TOLERANCE, "progress": progress}
    runs = sweep(parameters, duration=DURATION, **options)
    ends = restart(parameters, runs["z_end"], runs["vz_end"], DURATION)
    labels = classify(ends, cycles=CYCLES, **options)
    return {**axes, "mean_velocity": runs["mean_velocity"], "state": labels.state, "period": labels.period}
