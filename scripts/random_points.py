"""Rule random_points: the solver on many random conveyors and starts; how each run ends and how deep the part gets."""

import numpy as np

from conveyor import sweep, tables
from conveyor.model import FREQUENCY, PARAMETERS, TENSION, TENSION_MODES
from conveyor.random_points import around_the_paper, deepest, deepest_allowed, whole_ranges
from rule_log import logged

DRAWS = {"around the paper": around_the_paper, "whole ranges": whole_ranges}


def columns(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of random points for the settings of the config."""
    counts = settings["count"]
    parameters = np.concatenate([draw(counts[name], settings["seed"]) for name, draw in DRAWS.items()])
    durations = settings["cycles"] / parameters[:, FREQUENCY]
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    runs = sweep.run(parameters, duration=durations, **options)
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
