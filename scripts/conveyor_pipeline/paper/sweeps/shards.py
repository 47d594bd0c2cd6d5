"""Shards of sweeps: a trajectory for each point of a product of axes, and the state of motion that it leads to."""

from collections.abc import Iterator

import numpy as np

from conveyor import restart, sweep
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.axes import count_points
from conveyor_pipeline.common.labelling import label_entry

# Rows per block; one block takes a few hundred MB.
BLOCK = 1 << 18
TABLES = {
    "sweeps": (
        *fields.RESULTS,
        *fields.STATE,
        *fields.FEATURES,
        fields.number("longest_flight", "1", "longest flight of this motion in excitation cycles; null for none"),
    ),
}


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> Iterator[dict[str, np.ndarray]]:
    """The `columns` of a table of sweeps, in blocks of rows; the settings of a shard have its `rows`."""
    first, end = settings.get("rows", (0, count_points(settings["axes"])))
    blocks = range(first, end, BLOCK)
    for number, begin in enumerate(blocks, start=1):
        label = progress and (f"{progress} ({number} of {len(blocks)})" if len(blocks) > 1 else progress)
        yield columns(settings, (begin, min(begin + BLOCK, end)), threads=threads, progress=label)


def columns(
    settings: dict, rows: tuple[int, int] | None = None, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of a table of sweeps for the resolved `settings` of an entry of the config.

    rows : the first row and the row after the last one, in the order of the product of the axes; None for all
    """
    names = ("duration", "method", "tolerance", "step", "needs")
    options = {name: settings[name] for name in names if name in settings}
    axes, parameters = grid.product(settings["axes"], settings["model"], rows)
    runs = sweep(parameters, **options, threads=threads, progress=progress)
    ok = runs["status"] == "ok"
    selected = slice(None) if ok.all() else ok  # a slice makes no copy
    ends = runs["z_end"][selected], runs["vz_end"][selected]
    parameters = restart(parameters[selected], *ends, settings["duration"])
    labels = label_entry(parameters, settings, threads=threads, progress=progress)
    state, period, flight = (
        fill_missing(ok, values, missing)
        for values, missing in ((labels.state, "undecided"), (labels.period, 0), (labels.longest_flight, np.nan))
    )
    return {**axes, **runs, "state": state, "period": period, "longest_flight": flight}


def fill_missing(ok: np.ndarray, values: np.ndarray, missing: str | float) -> np.ndarray:
    """An array with `values` where `ok`, shape (n,), is true, and `missing` elsewhere."""
    if len(values) == len(ok):
        return values
    filled = np.full(len(ok), missing, dtype=values.dtype)
    filled[ok] = values
    return filled
