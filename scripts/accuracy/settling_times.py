"""Excitation cycles until motions settle, as a basis for the limit of the search for attractors."""

import math

import numpy as np

from conveyor.analysis.attractors import labels
from conveyor.solver.model import PSI0, Z0
from pipeline import fields, grid

TABLES = {
    "settling_times": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height"),
        fields.number("psi0", "rad", "initial phase of the excitation"),
        *fields.STATE,
        fields.count("cycles", "simulated excitation cycles: until the motion settled, or the limit of the config"),
    ),
}


def draw_initial_conditions(acceleration: float, settings: dict, model: dict) -> np.ndarray:
    """Parameter vectors with random heights and phases, shape (starts, 16), equal for every amplitude (m/s²)."""
    _, parameters = grid.product({"acceleration": [acceleration]}, model)
    rows = np.repeat(parameters, settings["starts"], axis=0)
    generator = np.random.default_rng(settings["seed"])
    rows[:, Z0] = generator.uniform(*settings["z0"], len(rows))
    rows[:, PSI0] = generator.uniform(0.0, 2.0 * math.pi, len(rows))
    return rows


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of settling times, from the section of the config with model and tolerance."""
    amplitudes = settings["acceleration"]
    parameters = np.concatenate(
        [draw_initial_conditions(acceleration, settings, settings["model"]) for acceleration in amplitudes]
    )
    found = labels.classify(
        parameters, cycles=settings["cycles"], tolerance=settings["tolerance"], threads=threads, progress=progress
    )
    return {
        "acceleration": np.repeat(amplitudes, settings["starts"]),
        "z0": parameters[:, Z0],
        "psi0": parameters[:, PSI0],
        "state": found.state,
        "period": found.period,
        "cycles": found.cycles,
    }
