"""Stroboscopic states of the attractors over the amplitude, swept up and down, with their states of motion."""

import numpy as np

from conveyor import bifurcation_diagram, classify, start_at
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
    directions = np.stack([upwards, upwards[::-1]])
    options = {"tolerance": tolerance, "threads": threads}
    swept = bifurcation_diagram(directions, transient=settings["transient"], strobes=count, **options)
    points = np.stack([swept.delta, swept.v], axis=-1)
    status = swept.status
    points[1], status[1] = points[1, ::-1].copy(), status[1, ::-1].copy()
    rows = len(BRANCHES) * len(amplitudes)
    last = start_at(np.tile(upwards, 2), points[:, :, -1].reshape(rows, 2), tolerance=tolerance)
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
