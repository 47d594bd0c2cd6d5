"""Excitation cycles until motions settle, as a basis for the limit of the search for attractors."""

import math

import numpy as np

from conveyor import classify
from conveyor_pipeline.common import fields, grid

# m/s²: regular motion, coexisting chaos, windows, chaos.
AMPLITUDES = [40.0, 53.0, 57.0, 61.0, 62.9, 72.97, 73.0, 75.0, 80.0, 83.25]
STARTS = 24  # initial conditions at each amplitude
SEED = 1
CYCLES = 60_000  # after which a motion has not settled: three times solver.settling
HEIGHTS = (0.0, 0.5e-3)  # m, range of the initial heights; phases are drawn from the whole cycle
TABLES = {
    "settling_times": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height"),
        fields.number("psi0", "rad", "initial phase of the excitation"),
        *fields.STATE,
        fields.count("cycles", f"simulated excitation cycles: until the motion settled, or {CYCLES:,}"),
    ),
}


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of settling times, from the section of the config with model and tolerance."""
    starts = max(1, round(settings["effort"] * STARTS))
    _, conveyors = grid.product({"acceleration": AMPLITUDES}, settings["model"])
    parameters = np.repeat(conveyors, starts)
    # Random heights and phases, the same at every amplitude.
    generator = np.random.default_rng(SEED)
    parameters["z0"] = np.tile(generator.uniform(*HEIGHTS, starts), len(AMPLITUDES))
    parameters["psi0"] = np.tile(generator.uniform(0.0, 2.0 * math.pi, starts), len(AMPLITUDES))
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    labels = classify(parameters, cycles=CYCLES, **options)
    return {
        "acceleration": np.repeat(AMPLITUDES, starts),
        "z0": parameters["z0"],
        "psi0": parameters["psi0"],
        "state": labels.state,
        "period": labels.period,
        "cycles": labels.cycles,
    }
