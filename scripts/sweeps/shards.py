"""Some rows of a sweep: a trajectory for each point of a product of axes, and the state of motion that it leads to."""

from collections.abc import Iterator

import numpy as np

from conveyor import ensemble
from pipeline import fields, grid
from pipeline.motions import motions_after, search_beside

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


# Rows that are computed at a time: some hundred megabytes.
BLOCK = 1 << 18


def make(
    settings: dict, rows: tuple[int, int], *, threads: int = 1, progress: str | None = None
) -> Iterator[dict[str, np.ndarray]]:
    """The `columns` of some rows of a table of sweeps, in blocks."""
    blocks = range(*rows, BLOCK)
    for number, begin in enumerate(blocks, start=1):
        label = progress and (f"{progress} ({number} of {len(blocks)})" if len(blocks) > 1 else progress)
        yield columns(settings, (begin, min(begin + BLOCK, rows[1])), threads=threads, progress=label)


def columns(
    settings: dict, rows: tuple[int, int] | None = None, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of a table of sweeps for the resolved `settings` of an entry of the config.

    Parameters
    ----------
    settings : of the entry
    rows : the first one and the one behind the last, in the order of the product of the axes; None for all
    threads, progress : as in conveyor.ensemble.run
    """
    options = {
        name: settings[name] for name in ("duration", "method", "tolerance", "step", "needs") if name in settings
    }
    axes, parameters = grid.product(settings["axes"], settings["model"], rows)
    search = search_beside(parameters, settings, threads)
    runs = ensemble.run(parameters, **options, threads=threads, beside=search, progress=progress)
    known = search and search()
    ok = runs["status"] == "ok"
    state = np.full(len(ok), "undecided")
    period, flight = np.zeros(len(ok), dtype=np.int64), np.full(len(ok), np.nan)
    if ok.all():
        ok = slice(None)  # no copies
    ends = runs["z_end"][ok], runs["vz_end"][ok]
    found = motions_after(parameters[ok], *ends, settings, known=known, threads=threads, progress=progress)
    state[ok], period[ok], flight[ok] = found.state, found.period, found.longest_flight
    return axes | runs | {"state": state, "period": period, "longest_flight": flight}
