"""Which motions starts end in, for the stages whose entries of the config say how to find that out."""

import math

import numpy as np

from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS, AttractorTable, distinct_conveyors
from conveyor.analysis.attractors.labels import Labels, classify, continued
from conveyor.analysis.attractors.search import find_attractors
from conveyor.simulation import DEFAULT_TOLERANCE
from conveyor.solver.model import PARAMETERS, PSI0, VZ0, Z0
from pipeline import grid
from pipeline.shared_searches import CHAOS_SHARED, CYCLES_SHARED, ORBITS_SHARED

STARTS = {PARAMETERS[k] for k in (PSI0, Z0, VZ0)}
# So many conveyors have their attractors in memory at a time, some 30 kB each.
CONVEYORS = 2000


def starts_per_conveyor(axes: dict) -> int:
    """Number of starts of each conveyor in the product of some axes."""
    return math.prod(grid.count_values(axis) for name, axis in axes.items() if name in STARTS)


def tolerance_of(settings: dict) -> float:
    """Of the contact steps in the search; what a fixed-step method leaves is followed on at the default."""
    return settings.get("tolerance", DEFAULT_TOLERANCE)


def shared_attractors(
    parameters: np.ndarray, starts: int, settings: dict, *, threads: int = 1, progress: str | None = None
) -> AttractorTable:
    """The attractors of conveyors, shape (n, 16), that are worth finding for so many starts of each of them."""
    if starts < CHAOS_SHARED or starts * settings["settling"] < CYCLES_SHARED:
        return NO_ATTRACTORS
    options = {"cycles": settings["settling"], "tolerance": tolerance_of(settings), "threads": threads}
    progress = progress and f"{progress}: attractors"
    return find_attractors(parameters, orbits=starts >= ORBITS_SHARED, **options, progress=progress)


def batches_by_conveyor(parameters: np.ndarray) -> list[np.ndarray]:
    """Rows of `parameters`, shape (n, 16), in batches that hold all starts of their conveyors."""
    _, conveyor = distinct_conveyors(parameters)
    order = np.argsort(conveyor, kind="stable")
    batch = conveyor[order] // CONVEYORS
    return np.split(order, np.flatnonzero(np.diff(batch)) + 1)


def motions_of_starts(
    parameters: np.ndarray,
    settings: dict,
    *,
    starts: int,
    threads: int = 1,
    progress: str | None = None,
) -> Labels:
    """The motions that starts end in; what those of a conveyor share is found first if they are many.

    Parameters
    ----------
    parameters : float64, shape (n, 16)
    settings : `settling`, and `tolerance` if it is not the default
    starts : of each conveyor, in all batches and shards
    """
    options = {"cycles": settings["settling"], "tolerance": tolerance_of(settings), "threads": threads}
    batches = batches_by_conveyor(parameters)
    parts = []
    for number, rows in enumerate(batches, start=1):
        label = progress and (f"{progress} ({number} of {len(batches)})" if len(batches) > 1 else progress)
        known = shared_attractors(parameters[rows], starts, settings, threads=threads, progress=label)
        parts.append(classify(parameters[rows], attractors=known, **options, progress=label))
    order = np.argsort(np.concatenate(batches))
    return Labels(*(np.concatenate(column)[order] for column in zip(*parts, strict=True)))


def motions(parameters: np.ndarray, settings: dict, **options) -> Labels:
    """The motions that the starts of `parameters`, shape (n, 16), end in; `settings` are those of their entry.

    options : `threads` and `progress`, as in motions_of_starts
    """
    return motions_of_starts(parameters, settings, starts=starts_per_conveyor(settings["axes"]), **options)


def motions_after(parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, settings: dict, **options) -> Labels:
    """The motions that runs of `parameters` with these ends (m, m/s) go on to, by whichever method they were made."""
    return motions(continued(parameters, z_end, vz_end, settings["duration"]), settings, **options)
