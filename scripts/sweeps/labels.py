"""The shards of a sweep below each other, and the state of motion that each of its runs leads to."""

import numpy as np
import pandas as pd

from pipeline import fields, grid
from pipeline.motions import motions_after

TABLES = {
    "sweeps": (
        *fields.RESULTS,
        *fields.STATE,
        *fields.FEATURES,
        fields.number(
            "longest_flight", "1", "of that motion, in excitation cycles; tells motions of one state apart; else null"
        ),
    ),
}


def make(
    runs: list[pd.DataFrame], settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of a table of sweeps from its tables of runs, in the order of their rows."""
    runs = pd.concat(runs, ignore_index=True)
    _, parameters = grid.product(settings["axes"], settings["model"])
    ok = (runs.status == "ok").to_numpy()
    state = np.full(len(runs), "undecided")
    period, flight = np.zeros(len(runs), dtype=np.int64), np.full(len(runs), np.nan)
    ends = runs.z_end.to_numpy()[ok], runs.vz_end.to_numpy()[ok]
    found = motions_after(parameters[ok], *ends, settings, threads=threads, progress=progress)
    state[ok], period[ok], flight[ok] = found.state, found.period, found.longest_flight
    columns = {name: runs[name].to_numpy() for name in runs}
    return columns | {"state": state, "period": period, "longest_flight": flight}
