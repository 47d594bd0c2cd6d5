"""Stroboscopic states of the attractors over the amplitude, swept up and down, with their states of motion."""

import numpy as np

from conveyor import bifurcation_diagram, classify, start_at
from conveyor.parallel import for_each_chunk
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.labelling import search_options

TABLES = {
    "strobes": (
        fields.text("branch", "up for increasing amplitude, down for decreasing amplitude"),
        fields.ORBIT[1],
        fields.count("cycle", "number of the recorded cycle"),
        *fields.STROBE,
        *fields.STATE,
        fields.text("status", "ok, or why there is no result"),
    ),
}

BRANCHES = ("up", "down")


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table for the settings of the config, with rows by branch, amplitude and cycle."""
    amplitudes = grid.axis_values("acceleration", settings["acceleration"])
    _, upwards = grid.product({"acceleration": list(amplitudes)}, settings["model"])
    count, tolerance = settings["strobes"], settings["tolerance"]
    orders = slice(None), slice(None, None, -1)
    swept = [None] * len(BRANCHES)

    def work(begin, end):
        for k in range(begin, end):
            orbit_states = bifurcation_diagram(
                upwards[orders[k]], transient=settings["transient"], strobes=count, tolerance=tolerance
            )
            swept[k] = [column[orders[k]] for column in orbit_states]

    for_each_chunk(work, len(BRANCHES), threads=threads, chunk=1)
    points, status = (np.stack(columns) for columns in zip(*swept, strict=True))
    rows = len(BRANCHES) * len(amplitudes)
    last = start_at(np.tile(upwards, 2), points[:, :, -1].reshape(rows, 2), tolerance)
    labels = classify(last, **search_options(settings), threads=threads, progress=progress)
    return {
        "branch": np.repeat(BRANCHES, len(amplitudes) * count),
        "acceleration": np.tile(np.repeat(amplitudes, count), 2),
        "cycle": np.tile(np.arange(count), rows),
        "delta": points[..., 0].ravel(),
        "v": points[..., 1].ravel(),
        "state": np.repeat(labels.state, count),
        "period": np.repeat(labels.period, count),
        "status": np.repeat(status.ravel(), count),
    }
