"""Rule classify: the shards of a sweep below each other, and the state of motion that each of its runs leads to."""

import numpy as np
import pandas as pd

from conveyor import grid, tables
from motions import motions_after
from rule_log import logged


def columns(
    runs: pd.DataFrame, settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of a table of sweeps from its table of runs."""
    _, parameters = grid.product(settings["axes"], settings["model"])
    ok = (runs.status == "ok").to_numpy()
    state = np.full(len(runs), "undecided")
    period, flight = np.zeros(len(runs), dtype=np.int64), np.full(len(runs), np.nan)
    ends = runs.z_end.to_numpy()[ok], runs.vz_end.to_numpy()[ok]
    found = motions_after(parameters[ok], *ends, settings, threads=threads, progress=progress)
    state[ok], period[ok], flight[ok] = found.state, found.period, found.longest_flight
    columns = {name: runs[name].to_numpy() for name in runs}
    return columns | {"state": state, "period": period, "longest_flight": flight}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        runs = pd.concat([tables.read(shard, "runs") for shard in snakemake.input], ignore_index=True)
        tables.write(
            snakemake.output[0],
            "sweeps",
            columns(runs, settings, threads=snakemake.threads, progress=f"states of {snakemake.wildcards.name}"),
            axes=list(settings["axes"]),
            settings=settings,
        )
