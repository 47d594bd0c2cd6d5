"""Stroboscopic states of the attractors over the amplitude, swept up and down, with their states of motion."""

import numpy as np

from conveyor import BEGIN_OF_CYCLE, Columns, classify, follow_attractor, for_each_chunk, replace_parameters, start_at
from pipeline import fields, grid
from pipeline.labelling import mean_limit

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


def label_motions(parameters: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> Columns:
    """The label of each motion in `parameters`, shape (n,), each with a conveyor of its own.

    All searches together take at most as many cycles as those for a map: motions that have not settled after the mean
    share what is left. Exponents label motions that have not settled then, too.
    """
    mean, most = int(mean_limit(len(parameters), settings)), settings["settling"]
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    if mean >= most:
        return classify(parameters, cycles=most, **options)
    labels = classify(parameters, cycles=mean, exponents=False, **options)
    late = np.flatnonzero(labels.cycles >= mean)
    if len(late):
        left = (mean * len(parameters) - int(labels.cycles.sum())) // len(late)
        states = np.column_stack([labels.delta, labels.v])[late]
        at_top = replace_parameters(parameters[late], psi0=BEGIN_OF_CYCLE)
        rows = start_at(at_top, states, settings["tolerance"])
        later = classify(rows, cycles=min(most - mean, left), **options)
        for name, values in later.items():
            labels[name][late] = values
    return labels


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table for the settings of the config, with rows by branch, amplitude and cycle."""
    amplitudes = grid.axis_values("acceleration", settings["acceleration"])
    _, upwards = grid.product({"acceleration": list(amplitudes)}, settings["model"])
    count, tolerance = settings["strobes"], settings["tolerance"]
    orders = slice(None), slice(None, None, -1)
    swept = [None] * len(BRANCHES)

    def work(begin, end):
        for k in range(begin, end):
            orbit_states = follow_attractor(
                upwards[orders[k]], transient=settings["transient"], strobes=count, tolerance=tolerance
            )
            swept[k] = [column[orders[k]] for column in orbit_states]

    for_each_chunk(work, len(BRANCHES), threads=threads, chunk=1)
    points, status = (np.stack(columns) for columns in zip(*swept, strict=True))
    rows = len(BRANCHES) * len(amplitudes)
    last = start_at(np.tile(upwards, 2), points[:, :, -1].reshape(rows, 2), tolerance)
    labels = label_motions(last, settings, threads=threads, progress=progress)
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
