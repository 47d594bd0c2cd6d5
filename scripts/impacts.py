"""Rule impacts: the first impact of each start, and the states that the start and its image on the plate lead to."""

import numpy as np

from conveyor import grid, tables
from conveyor.first_impact import first_impacts, on_conveyor
from motions import motions
from rule_log import logged


def columns(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of impacts for the resolved `settings` of an entry of the config."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    impacts = first_impacts(parameters)
    mapped = np.isfinite(impacts.time)
    state = motions(parameters, settings, threads=threads).state
    mapped_state = np.full(len(parameters), None, dtype=object)
    images = on_conveyor(parameters, impacts)[mapped]
    mapped_state[mapped] = motions(images, settings, threads=threads).state
    return {
        **axes,
        "impact_time": impacts.time,
        "impact_velocity": impacts.velocity,
        "impact_phase": impacts.phase,
        "state": state,
        "mapped_state": mapped_state,
    }


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(
            snakemake.output[0],
            "impacts",
            columns(settings, threads=snakemake.threads),
            axes=list(settings["axes"]),
            settings=settings,
        )
