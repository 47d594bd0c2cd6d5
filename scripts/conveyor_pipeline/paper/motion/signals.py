"""Trajectories of a few parts and of their conveyors over time."""

import numpy as np

from conveyor import Run, plate_motion
from conveyor_pipeline.common import fields
from conveyor_pipeline.paper.motion.simulated_entries import simulate_entry

TABLES = {
    "signals": (
        *fields.STATE,
        fields.number("time", "s", "time since the start"),
        fields.number("x", "m", "horizontal position of the part"),
        fields.number("vx", "m/s", "horizontal velocity of the part"),
        fields.number("z", "m", "height of the part"),
        fields.number("vz", "m/s", "vertical velocity of the part"),
        fields.number("contact_force", "N", "vertical force of the plate on the part (Eq. 9)"),
        fields.number("friction_force", "N", "horizontal force of the plate on the part (Eq. 11)"),
        fields.number("plate_x", "m", "horizontal position of the plate"),
        fields.number("plate_vx", "m/s", "horizontal velocity of the plate (Eq. 10)"),
        fields.number("plate_z", "m", "height of the plate (Eq. 4)"),
        fields.number("plate_vz", "m/s", "vertical velocity of the plate (Eq. 3)"),
    ),
}


def sample(run: Run, times: np.ndarray) -> dict[str, np.ndarray]:
    """The motion of one part and of its plate at `times` (s)."""
    plate = {f"plate_{name}": values for name, values in plate_motion(run.conveyor, times).items()}
    return {"time": times, **run.sample(times), **plate}


def make(settings: dict) -> dict[str, np.ndarray]:
    """The columns of a table of signals for the resolved `settings` of an entry of the config."""
    times = np.linspace(**settings["times"])
    axes, runs, states = simulate_entry(settings)
    labels = {**axes, "state": states.state, "period": states.period}
    samples = [sample(run, times) for run in runs]
    repeated = {name: np.repeat(values, len(times)) for name, values in labels.items()}
    return repeated | {name: np.concatenate([sampled[name] for sampled in samples]) for name in samples[0]}
