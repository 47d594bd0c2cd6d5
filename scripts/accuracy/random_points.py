"""The solver on many random conveyors and starts; how each run ends and how deep the part gets."""

import numpy as np

from accuracy.random_conveyors import around_the_paper, deepest, deepest_allowed, whole_ranges
from conveyor import ensemble
from conveyor.solver.model import FREQUENCY, PARAMETERS, TENSION, TENSION_MODES
from pipeline import fields

TABLES = {
    "random_points": (
        *fields.AXES.values(),
        fields.text("drawn", "around the paper or over the whole ranges"),
        fields.number("duration", "s", "length of the run"),
        *fields.RESULTS,
        *fields.FEATURES,
        fields.number("max_depth", "m", "largest penetration at the moments that were looked at"),
        fields.number("allowed_depth", "m", "penetration that no run can exceed"),
    ),
}

DRAWS = {"around the paper": around_the_paper, "whole ranges": whole_ranges}


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of random points for the settings of the config."""
    counts = settings["count"]
    parameters = np.concatenate([draw(counts[name], settings["seed"]) for name, draw in DRAWS.items()])
    durations = settings["cycles"] / parameters[:, FREQUENCY]
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    runs = ensemble.run(parameters, duration=durations, **options)
    axes = dict(zip(PARAMETERS, parameters.T, strict=True))
    axes[PARAMETERS[TENSION]] = np.array(TENSION_MODES)[parameters[:, TENSION].astype(int)]
    return {
        **axes,
        "drawn": np.repeat(list(DRAWS), [counts[name] for name in DRAWS]),
        "duration": durations,
        **runs,
        "max_depth": deepest(parameters, durations, **options),
        "allowed_depth": deepest_allowed(parameters, runs["max_gap"]),
    }
