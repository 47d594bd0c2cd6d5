"""Stroboscopic states over the amplitude, swept up and down, with the states of motion."""

import numpy as np

from conveyor.analysis import attractors, states, stroboscope
from pipeline import fields, grid

TABLES = {
    "strobes": (
        fields.text("branch", "up: the amplitude grew step by step; down: it fell"),
        fields.ORBIT[1],
        fields.count("cycle", "number of the recorded cycle"),
        *fields.STROBE,
        *fields.STATE,
        fields.text("status", "ok, or why there is no result"),
    ),
}

BRANCHES = ("up", "down")


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table for the settings of the config; rows by branch, amplitude, cycle."""
    amplitudes = grid.axis_values("acceleration", settings["acceleration"])
    parts = []
    for branch, order in zip(BRANCHES, (slice(None), slice(None, None, -1)), strict=True):
        _, parameters = grid.product({"acceleration": list(amplitudes[order])}, settings["model"])
        points, status = attractors.sweep(
            parameters, transient=settings["transient"], strobes=settings["strobes"], tolerance=settings["tolerance"]
        )
        starts = stroboscope.starts_of_states(parameters, points[:, -1], settings["tolerance"])
        found = states.classify(
            starts,
            cycles=settings["settling"],
            tolerance=settings["tolerance"],
            threads=threads,
            progress=progress and f"{progress}, {branch}",
        )
        count = settings["strobes"]
        parts.append(
            {
                "branch": np.full(points[order].shape[:2], branch).ravel(),
                "acceleration": np.repeat(amplitudes, count),
                "cycle": np.tile(np.arange(count), len(amplitudes)),
                "delta": points[order, :, 0].ravel(),
                "v": points[order, :, 1].ravel(),
                "state": np.repeat(found.state[order], count),
                "period": np.repeat(found.period[order], count),
                "status": np.repeat(status[order], count),
            }
        )
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
