"""Rule critical: the initial heights at which the state of motion changes, over the axes of an entry of the config."""

import numpy as np

from conveyor import critical, grid, states, sweep, tables
from rule_log import logged


def decide(parameters: np.ndarray, settings: dict, threads: int) -> np.ndarray:
    """The state of motion that each start leads to.

    A fixed-step method is followed for the duration, as the paper does; the state that it has reached by then decides.
    """
    if settings["method"] == "event":
        return states.classify(parameters, tolerance=settings["tolerance"], threads=threads)[0]
    options = {name: settings[name] for name in ("duration", "method", "step")}
    runs = sweep.run(parameters, needs="vertical", chunk=8, threads=threads, **options)
    ends = states.continued(parameters, runs["z_end"], runs["vz_end"], settings["duration"])
    return states.classify(ends, threads=threads)[0]


def columns(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of critical heights for the resolved `settings` of an entry of the config.

    A conveyor with one state of motion over the whole scan has no row.
    """
    axes, parameters = grid.product(settings["axes"], settings["model"])
    heights = grid.axis_values("z0", settings["scan"])
    found = critical.crossings(
        parameters, heights, lambda rows: decide(rows, settings, threads), settings["resolution"]
    )
    first_row = np.searchsorted(found.point, found.point)
    return {
        **{name: values[found.point] for name, values in axes.items()},
        "z0": found.height,
        "crossing": np.arange(len(found.point)) - first_row + 1,
        "state_below": found.below,
        "state_above": found.above,
        "is_critical": critical.critical(found),
    }


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(
            snakemake.output[0],
            "critical",
            columns(settings, threads=snakemake.threads),
            axes=list(settings["axes"]),
            settings=settings,
        )
