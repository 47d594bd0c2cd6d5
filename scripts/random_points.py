"""Rule random_points: the solver on many random conveyors and starts; how each run ends and how deep the part gets."""

import numpy as np

from conveyor import sweep, tables
from conveyor.model import PARAMETERS, TENSION, TENSION_MODES
from conveyor.random_points import deepest, deepest_allowed, random_points
from rule_log import logged

# Moments of a run at which the penetration is looked at.
MOMENTS = 401


def columns(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of random points for the settings of the config."""
    parameters = random_points(settings["count"], settings["seed"])
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    runs = sweep.run(parameters, duration=settings["duration"], **options)
    axes = dict(zip(PARAMETERS, parameters.T, strict=True))
    axes[PARAMETERS[TENSION]] = np.array(TENSION_MODES)[parameters[:, TENSION].astype(int)]
    times = np.linspace(0.0, settings["duration"], MOMENTS)
    depths = {"max_depth": deepest(parameters, times, **options), "allowed_depth": deepest_allowed(parameters)}
    return axes | runs | depths


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(
            snakemake.output[0],
            "random_points",
            columns(settings, threads=snakemake.threads, progress="random points"),
            axes=PARAMETERS,
            settings=settings,
        )
