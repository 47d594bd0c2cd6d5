"""Rule sweep: one trajectory for each point of a product of axes, or for some rows of it."""

import numpy as np

from conveyor import grid, sweep, tables
from rule_log import logged


def columns(
    settings: dict, rows: tuple[int, int], *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of a table of runs for the resolved `settings` of an entry of the config."""
    options = {
        name: settings[name] for name in ("duration", "method", "tolerance", "step", "needs") if name in settings
    }
    axes, parameters = grid.product(settings["axes"], settings["model"], rows)
    return axes | sweep.run(parameters, **options, threads=threads, progress=progress)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(
            snakemake.output[0],
            "runs",
            columns(
                settings, snakemake.params.rows, threads=snakemake.threads, progress=f"sweep {snakemake.wildcards.name}"
            ),
            axes=list(settings["axes"]),
            settings=settings,
        )
