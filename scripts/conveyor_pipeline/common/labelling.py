"""Labels of initial conditions, with the settings of an entry of the config."""

import math

import numpy as np

from conveyor import DEFAULT_TOLERANCE, Columns, classify, restart
from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS, AttractorTable, distinct_conveyors
from conveyor.analysis.attractors.search import find_attractors
from conveyor.parameters import INITIAL_CONDITION
from conveyor_pipeline.common.axes import count_values

# Conveyors per batch: the attractors of a conveyor take some 30 kB of memory.
CONVEYORS = 2000
# From this number of initial conditions, it costs less to find the conveyor's chaotic sets first, and then the
# neighbourhoods of its orbits.
CHAOS_SHARED = 8
ORBITS_SHARED = 200
# Below this total of excitation cycles over all initial conditions, this search takes longer than it saves.
CYCLES_SHARED = 32_000


def search_options(settings: dict) -> dict:
    """Limit (excitation cycles) and tolerance of searches; entries of fixed-step methods have no tolerance."""
    return {"cycles": settings["settling"], "tolerance": settings.get("tolerance", DEFAULT_TOLERANCE)}


def shared_attractors(
    parameters: np.ndarray, starts: int, settings: dict, *, threads: int = 1, progress: str | None = None
) -> AttractorTable:
    """The attractors that many initial conditions share, for a table of parameters.

    starts : number of initial conditions of each conveyor, which decides what is worth a search
    """
    if starts < CHAOS_SHARED or starts * settings["settling"] < CYCLES_SHARED:
        return NO_ATTRACTORS
    options = {**search_options(settings), "threads": threads, "progress": progress and f"{progress}: attractors"}
    return find_attractors(parameters, orbits=starts >= ORBITS_SHARED, **options)


def join(parts: list[Columns], rows: list[np.ndarray | slice]) -> Columns:
    """The labels of parts of an array, whose rows are given, in the order of the array. A single part is all of it."""
    if len(parts) == 1:
        return parts[0]
    order = np.argsort(np.concatenate(rows), kind="stable")
    return Columns.concatenate(parts).select(order)


def batches_by_conveyor(parameters: np.ndarray) -> list[np.ndarray | slice]:
    """Rows of `parameters`, shape (n,), in batches; all initial conditions of a conveyor are in one batch."""
    conveyors, conveyor = distinct_conveyors(parameters)
    if len(conveyors) <= CONVEYORS:
        return [slice(None)]
    order = np.argsort(conveyor, kind="stable")
    batch = conveyor[order] // CONVEYORS
    return np.split(order, np.flatnonzero(np.diff(batch)) + 1)


def label_starts(
    parameters: np.ndarray, settings: dict, *, starts: int, threads: int = 1, progress: str | None = None
) -> Columns:
    """The labels of initial conditions. Attractors that many initial conditions share are searched for first.

    parameters : table, shape (n,)
    settings : `settling`, and `tolerance` if it is not the default. A search that has not ended after `settling`
        excitation cycles is `undecided`, or chaos if the Lyapunov exponent is positive
    starts : number of initial conditions of each conveyor, in all batches and shards
    """
    batches = batches_by_conveyor(parameters)
    parts = []
    for number, rows in enumerate(batches, start=1):
        label = progress and (f"{progress} ({number} of {len(batches)})" if len(batches) > 1 else progress)
        known = shared_attractors(parameters[rows], starts, settings, threads=threads, progress=label)
        options = {**search_options(settings), "threads": threads, "progress": label}
        parts.append(classify(parameters[rows], attractors=known, **options))
    return join(parts, batches)


def label_entry(parameters: np.ndarray, settings: dict, **options) -> Columns:
    """The labels of `parameters`, shape (n,), the rows of an entry of the config, with its settings.

    options : `threads` and `progress`, as in `label_starts`
    """
    varied = (axis for name, axis in settings["axes"].items() if name in INITIAL_CONDITION)
    return label_starts(parameters, settings, starts=math.prod(map(count_values, varied)), **options)


def label_ends(parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, settings: dict, **options) -> Columns:
    """The labels of runs of `parameters`; the converged solution continues them from their ends (m, m/s)."""
    return label_entry(restart(parameters, z_end, vz_end, settings["duration"]), settings, **options)
