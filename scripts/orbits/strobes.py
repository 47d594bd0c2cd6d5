"""Stroboscopic states of the attractors over the amplitude, swept up and down, with their states of motion."""

import numpy as np

from conveyor.analysis import stroboscopic_map
from conveyor.analysis.attractors import labels
from conveyor.analysis.bifurcations import bifurcation_diagram
from conveyor.solver.parallel import for_each_chunk
from pipeline import fields, grid

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
            found = bifurcation_diagram.follow_attractor(
                upwards[orders[k]], transient=settings["transient"], strobes=count, tolerance=tolerance
            )
            swept[k] = [column[orders[k]] for column in found]

    for_each_chunk(work, len(BRANCHES), threads=threads, chunk=1)
    points, status = (np.stack(columns) for columns in zip(*swept, strict=True))
    rows = len(BRANCHES) * len(amplitudes)
    last = stroboscopic_map.pack_states(np.tile(upwards, (2, 1)), points[:, :, -1].reshape(rows, 2), tolerance)
    found = labels.classify(last, cycles=settings["settling"], tolerance=tolerance, threads=threads, progress=progress)
    return {
        "branch": np.repeat(BRANCHES, len(amplitudes) * count),
        "acceleration": np.tile(np.repeat(amplitudes, count), 2),
        "cycle": np.tile(np.arange(count), rows),
        "delta": points[..., 0].ravel(),
        "v": points[..., 1].ravel(),
        "state": np.repeat(found.state, count),
        "period": np.repeat(found.period, count),
        "status": np.repeat(status.ravel(), count),
    }
