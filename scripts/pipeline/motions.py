"""Attractors that initial conditions lead to, with the settings of an entry of the config."""

import math

import numpy as np

from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS, AttractorTable, distinct_conveyors
from conveyor.analysis.attractors.labels import Labels, classify, continued
from conveyor.analysis.attractors.search import find_attractors
from conveyor.simulation import DEFAULT_TOLERANCE
from conveyor.solver.model import PARAMETERS, PSI0, VZ0, Z0
from pipeline import grid
from pipeline.sizes import CHAOS_SHARED, CYCLES_SHARED, ORBITS_SHARED

INITIAL_CONDITIONS = {PARAMETERS[k] for k in (PSI0, Z0, VZ0)}
# Conveyors per batch: the attractors of a conveyor take some 30 kB of memory.
CONVEYORS = 2000


def search_tolerance(settings: dict) -> float:
    """Tolerance of the contact steps in the search; the default for entries of fixed-step methods, which have none."""
    return settings.get("tolerance", DEFAULT_TOLERANCE)


def shared_attractors(
    parameters: np.ndarray, starts: int, settings: dict, *, threads: int = 1, progress: str | None = None
) -> AttractorTable:
    """The attractors that many initial conditions share, for parameters of shape (n, 16).

    Which attractors are worth a search depends on `starts`, the number of initial conditions of each conveyor.
    """
    if starts < CHAOS_SHARED or starts * settings["settling"] < CYCLES_SHARED:
        return NO_ATTRACTORS
    options = {"cycles": settings["settling"], "tolerance": search_tolerance(settings), "threads": threads}
    progress = progress and f"{progress}: attractors"
    return find_attractors(parameters, orbits=starts >= ORBITS_SHARED, **options, progress=progress)


def batches_by_conveyor(parameters: np.ndarray) -> list[np.ndarray]:
    """Rows of `parameters`, shape (n, 16), in batches; all initial conditions of a conveyor are in one batch."""
    _, conveyor = distinct_conveyors(parameters)
    order = np.argsort(conveyor, kind="stable")
    batch = conveyor[order] // CONVEYORS
    return np.split(order, np.flatnonzero(np.diff(batch)) + 1)


def motions_of_starts(
    parameters: np.ndarray, settings: dict, *, starts: int, threads: int = 1, progress: str | None = None
) -> Labels:
    """The attractors that initial conditions lead to. Attractors that many of them share are found first.

    parameters : float64, shape (n, 16)
    settings : `settling`, `tolerance` if it is not the default, and `exponents` if not as in labels.classify
    starts : number of initial conditions of each conveyor, in all batches and shards
    """
    options = {"cycles": settings["settling"], "tolerance": search_tolerance(settings), "threads": threads}
    batches = batches_by_conveyor(parameters)
    parts = []
    for number, rows in enumerate(batches, start=1):
        label = progress and (f"{progress} ({number} of {len(batches)})" if len(batches) > 1 else progress)
        known = shared_attractors(parameters[rows], starts, settings, threads=threads, progress=label)
        exponents = settings.get("exponents", True)
        parts.append(classify(parameters[rows], attractors=known, exponents=exponents, **options, progress=label))
    order = np.argsort(np.concatenate(batches))
    return Labels(*(np.concatenate(column)[order] for column in zip(*parts, strict=True)))


def motions(parameters: np.ndarray, settings: dict, **options) -> Labels:
    """The attractors that `parameters`, shape (n, 16), lead to, with the settings of their entry of the config.

    options : `threads` and `progress`, as in motions_of_starts
    """
    axes = settings["axes"].items()
    starts = math.prod(grid.count_values(axis) for name, axis in axes if name in INITIAL_CONDITIONS)
    return motions_of_starts(parameters, settings, starts=starts, **options)


def motions_after(parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, settings: dict, **options) -> Labels:
    """The attractors that runs of `parameters` lead to; the converged solution continues from their ends (m, m/s)."""
    return motions(continued(parameters, z_end, vz_end, settings["duration"]), settings, **options)
