"""Initial heights at which the state of motion changes, over the axes of an entry of the config."""

from functools import partial

import numpy as np

from conveyor import classify, restart, sweep
from conveyor.analysis.attractors.attractor_table import AttractorTable
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.labelling import search_options, shared_attractors
from conveyor_pipeline.paper.motion.boundary_scan import find_crossings, select_critical
from conveyor_pipeline.paper.motion.limits import RESOLUTION

NOT_LOCATED = "between two heights of the scan"
TABLES = {
    "critical": (
        fields.number("z0", "m", "initial height at which the state of motion changes"),
        fields.count("crossing", "number of the change at this conveyor, from below, beginning with 1"),
        fields.text("state_below", "state of motion just below this height"),
        fields.text("state_above", "state of motion just above this height"),
        fields.flag("is_critical", "whether this is the lowest change out of the first state, into a known state"),
        fields.text("status", f"ok, or {NOT_LOCATED}: bisection locates only some of many changes at one conveyor"),
    ),
}


def find_states(parameters: np.ndarray, settings: dict, known: AttractorTable, threads: int) -> np.ndarray:
    """The state of motion that each initial condition leads to, str, shape (n,), for a table of parameters.

    A fixed-step method runs for the duration, as in the paper, and the converged solution continues from its end.
    """
    if settings["method"] != "event":
        run = {name: settings[name] for name in ("duration", "method", "step")}
        runs = sweep(parameters, needs="vertical", chunk=8, threads=threads, **run)
        parameters = restart(parameters, runs["z_end"], runs["vz_end"], settings["duration"])
    return classify(parameters, attractors=known, **search_options(settings), threads=threads).state


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of critical heights for the resolved `settings` of an entry of the config.

    A conveyor with a single state of motion over the whole scan has no row.
    """
    axes, parameters = grid.product(settings["axes"], settings["model"])
    heights = grid.axis_values("z0", settings["scan"])
    known = shared_attractors(parameters, len(heights), settings, threads=threads)
    resolution = RESOLUTION * (heights[-1] - heights[0])
    decide = partial(find_states, settings=settings, known=known, threads=threads)
    crossings = find_crossings(parameters, heights, decide, resolution)
    first_row = np.searchsorted(crossings.point, crossings.point)
    return {
        **{name: values[crossings.point] for name, values in axes.items()},
        "z0": crossings.height,
        "crossing": np.arange(len(crossings.point)) - first_row + 1,
        "state_below": crossings.below,
        "state_above": crossings.above,
        "is_critical": select_critical(crossings.point, crossings.below) & (crossings.above != "undecided"),
        "status": np.where(crossings.located, "ok", NOT_LOCATED),
    }
