"""One trajectory for each point of a product of axes, or for some rows of it."""

import numpy as np

from conveyor import ensemble
from pipeline import fields, grid

TABLES = {
    "runs": fields.RESULTS + fields.FEATURES,
}


def make(
    settings: dict, rows: tuple[int, int], *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of a table of runs for the resolved `settings` of an entry of the config."""
    options = {
        name: settings[name] for name in ("duration", "method", "tolerance", "step", "needs") if name in settings
    }
    axes, parameters = grid.product(settings["axes"], settings["model"], rows)
    return axes | ensemble.run(parameters, **options, threads=threads, progress=progress)
