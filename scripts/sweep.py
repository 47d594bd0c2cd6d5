"""Rule sweep: one trajectory for each point of a product of axes."""

import numpy as np

from conveyor import grid, states, sweep, tables
from rule_log import logged


def columns(settings: dict, *, rows=None, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of sweeps for the resolved `settings` of an entry of the config, or some rows of them."""
    options = {
        name: settings[name] for name in ("duration", "method", "tolerance", "step", "needs") if name in settings
    }
    axes, parameters = grid.product(settings["axes"], settings["model"], rows)
    runs = sweep.run(parameters, **options, threads=threads, progress=progress)
    state = np.full(len(parameters), "undecided")
    period = np.zeros(len(parameters), dtype=np.int64)
    ok = runs["status"] == "ok"
    later = states.continued(parameters[ok], runs["z_end"][ok], runs["vz_end"][ok], settings["duration"])
    state[ok], period[ok] = states.classify(later, threads=threads, progress=progress and f"{progress}: states")
    return {**axes, **runs, "state": state, "period": period}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(
            snakemake.output[0],
            "sweeps",
            columns(
                settings,
                rows=snakemake.params.get("rows"),
                threads=snakemake.threads,
                progress=snakemake.wildcards.name,
            ),
            axes=list(settings["axes"]),
            settings=settings,
        )
