"""Labels of initial conditions, with the settings of an entry of the config."""

import math
from typing import NamedTuple

import numpy as np

from conveyor import (
    DEFAULT_TOLERANCE,
    INITIAL_CONDITION,
    NO_ATTRACTORS,
    AttractorTable,
    Columns,
    classify,
    continued,
    distinct_conveyors,
    find_attractors,
    find_places,
)
from pipeline import grid
from pipeline.sizes import CHAOS_SHARED, CYCLES_SHARED, ORBITS_SHARED, WHOLE_MAP

# Conveyors per batch: the attractors of a conveyor take some 30 kB of memory.
CONVEYORS = 2000
# Conveyors of a table and initial conditions of each from which the length of searches is estimated, and the cycles of
# the first estimate.
SAMPLED_CONVEYORS, SAMPLED_STARTS, FIRST_LIMIT = 8, 32, 1000
# Exponents of the contact law with short series (see contact_law). Cycles with other exponents take several times as
# long, so that searches get a sixth of the cycles.
QUICK_EXPONENTS, SLOWER = (1.0, 1.5), 6
# Searches that all end after so many times `mean_settling` on average are not ended before, so that no label is open.
COMPLETED = 3
# Searches of which a smaller share settles within their limit end after half of it, because they would decide little.
WORTHWHILE = 0.1


def search_tolerance(settings: dict) -> float:
    """Tolerance of the contact steps in the search; the default for entries of fixed-step methods, which have none."""
    return settings.get("tolerance", DEFAULT_TOLERANCE)


def mean_settling(settings: dict) -> int:
    """The excitation cycles that an initial condition may take with the settings' model, on average over a map."""
    model = {name: [value] for name, value in settings.get("model", {}).items()} | settings.get("axes", {})
    exponents = grid.axis_values("exponent", model["exponent"]) if "exponent" in model else QUICK_EXPONENTS
    return settings["mean_settling"] // (1 if np.isin(exponents, QUICK_EXPONENTS).all() else SLOWER)


def shared_attractors(
    parameters: np.ndarray,
    counts: tuple[int, int],
    settings: dict,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> AttractorTable:
    """The attractors that many initial conditions share, for a table of parameters.

    Which attractors are worth a search depends on the number of initial conditions of each conveyor. The searches for
    the orbits of all conveyors may together take as many cycles as those for a map, and so may those for chaotic sets.

    counts : of conveyors and of initial conditions on each, as in a Table
    """
    conveyors, starts = counts
    if starts < CHAOS_SHARED or starts * settings["settling"] < CYCLES_SHARED:
        return NO_ATTRACTORS
    options = {"cycles": settings["settling"], "tolerance": search_tolerance(settings), "threads": threads}
    options["most"] = mean_settling(settings) * WHOLE_MAP // conveyors
    progress = progress and f"{progress}: attractors"
    return find_attractors(parameters, orbits=starts >= ORBITS_SHARED, **options, progress=progress)


class Table(NamedTuple):
    """A table whose rows are a product of conveyors and initial conditions, both as tables of parameters."""

    conveyors: np.ndarray  # shape (m,), all of them or some that are spread over them
    starts: np.ndarray  # shape (s,), all of them or some that are spread over them
    counts: tuple[int, int]  # of conveyors and of initial conditions on each


class Limits(NamedTuple):
    """When searches on m conveyors end."""

    conveyors: np.ndarray  # shape (m,), as from `distinct_conveyors`
    cycles: np.ndarray  # int64, shape (m,), excitation cycles


def sample_starts(parameters: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Some of the initial conditions `starts`, shape (s,), on each conveyor in `parameters`, shape (n,)."""
    conveyors, _ = distinct_conveyors(parameters)
    chosen = spread(starts, SAMPLED_STARTS)
    rows = np.repeat(conveyors, len(chosen))
    for name in INITIAL_CONDITION:
        rows[name] = np.tile(chosen[name], len(conveyors))
    return rows


def spread(rows: np.ndarray, most: int) -> np.ndarray:
    """At most so many rows of an array, evenly spread over it."""
    return rows[spread_places(len(rows), most)]


def spread_places(count: int, most: int) -> np.ndarray:
    """At most so many of the numbers below `count`, evenly spread."""
    return np.unique(np.linspace(0, count - 1, most).round().astype(np.int64))


def spread_rows(axes: dict, model: dict, count: int, most: int) -> np.ndarray:
    """At most so many of the `count` rows of a product of axes, shape (k,), evenly spread over it."""
    if not axes:
        return grid.row_of(model)[None]
    places = spread_places(count, most)
    return np.concatenate([grid.product(axes, model, (place, place + 1))[1] for place in places])


def limit_of_mean(cycles: np.ndarray, mean: float) -> int:
    """The limit L for which searches of these lengths, shape (n,), that all end at L have a mean length."""
    # If the j shortest searches end before L, the sum is n mean for one L. Any other j gives a smaller L.
    ascending = np.sort(cycles)
    shorter = np.cumsum(ascending) - ascending
    return int(((len(cycles) * mean - shorter) / np.arange(len(cycles), 0, -1)).max())


def search_limits(
    sample: np.ndarray, group: np.ndarray, attractors: AttractorTable, mean: float, settings: dict, *, threads: int = 1
) -> np.ndarray:
    """The excitation cycles after which searches in each group must end to take `mean` cycles on average, or half.

    sample, group : some initial conditions of the groups, shape (k,), and their groups, 0 to m - 1, shape (k,)
    Returns int64, shape (m,), at most `settling`.
    """
    most = settings["settling"]
    limits, is_open = np.full(group.max() + 1, most), np.ones(group.max() + 1, dtype=bool)
    options = {"tolerance": search_tolerance(settings), "exponents": False, "threads": threads}
    limit = min(FIRST_LIMIT, most)
    while is_open.any():
        rows = np.flatnonzero(is_open[group])
        cycles = classify(sample[rows], attractors=attractors, cycles=limit, **options).cycles
        for k in np.flatnonzero(is_open):
            own = cycles[group[rows] == k]
            if own.mean() > mean:
                affordable = limit_of_mean(own, mean)
                limits[k] = affordable if (own < affordable).mean() >= WORTHWHILE else affordable // 2
            is_open[k] = own.mean() <= mean and own.max() >= limit and limit < most
        limit = min(2 * limit, most)
    return limits


def mean_limit(count: int, settings: dict) -> float:
    """The excitation cycles that `count` searches for a table may take on average: as many in all as for a map."""
    return mean_settling(settings) * max(1.0, WHOLE_MAP / count)


def is_slow(table: Table, settings: dict, *, known: AttractorTable | None = None, threads: int = 1) -> bool:
    """Whether the searches for a table must end after its `mean_limit`, because they would take much more cycles.

    known : the shared attractors of all conveyors of the table; None if they have not been found yet
    """
    mean = max(mean_limit(math.prod(table.counts), settings), COMPLETED * mean_settling(settings))
    if mean >= settings["settling"]:
        return False
    sample = sample_starts(spread(distinct_conveyors(table.conveyors)[0], SAMPLED_CONVEYORS), table.starts)
    attractors = known or shared_attractors(sample, table.counts, settings, threads=threads)
    group = np.zeros(len(sample), dtype=np.int64)
    return bool(search_limits(sample, group, attractors, mean, settings, threads=threads)[0] < settings["settling"])


def find_limits(
    parameters: np.ndarray, table: Table, attractors: AttractorTable, settings: dict, *, threads: int = 1
) -> Limits:
    """The limits of searches for a table, on the conveyors in `parameters`, which are some of the table's rows."""
    conveyors, _ = distinct_conveyors(parameters)
    sample = sample_starts(parameters, table.starts)
    group = np.repeat(np.arange(len(conveyors)), len(sample) // len(conveyors))
    mean = mean_limit(math.prod(table.counts), settings)
    return Limits(conveyors, search_limits(sample, group, attractors, mean, settings, threads=threads))


def label_within_limits(
    parameters: np.ndarray,
    attractors: AttractorTable,
    settings: dict,
    *,
    limits: Limits | None = None,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """The labels of initial conditions. An initial condition whose search ends at a limit stays undecided."""
    most = settings["settling"]
    options = {"attractors": attractors, "tolerance": search_tolerance(settings), "threads": threads}
    if limits is None:
        return classify(parameters, cycles=most, **options, progress=progress)
    conveyors, index = distinct_conveyors(parameters)
    cycles = limits.cycles[find_places(limits.conveyors, conveyors)[:, 0]][index]
    groups = [np.flatnonzero(cycles == limit) for limit in np.unique(cycles)]
    parts = []
    for rows in groups:
        limit = int(cycles[rows[0]])
        parts.append(classify(parameters[rows], cycles=limit, exponents=limit == most, **options, progress=progress))
    return join(parts, groups)


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
    parameters: np.ndarray,
    settings: dict,
    *,
    starts: int,
    table: Table | None = None,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """The labels of initial conditions. Attractors that many initial conditions share are searched for first.

    parameters : table, shape (n,)
    settings : `settling`, `mean_settling`, and `tolerance` if it is not the default
    starts : number of initial conditions of each conveyor, in all batches and shards
    table : the whole table, if `parameters` are only a part of it
    """
    batches, parts = batches_by_conveyor(parameters), []
    table = table or Table(parameters, parameters[:starts], (max(len(parameters) // max(starts, 1), 1), starts))
    options, of_all = {"threads": threads}, None
    is_whole = len(batches) == 1 and len(parameters) == math.prod(table.counts)
    if is_whole or table.counts[0] <= SAMPLED_CONVEYORS:
        conveyors = parameters if is_whole else table.conveyors
        of_all = shared_attractors(conveyors, table.counts, settings, **options, progress=progress)
    slow = is_slow(table, settings, known=of_all, **options)
    for number, rows in enumerate(batches, start=1):
        label = progress and (f"{progress} ({number} of {len(batches)})" if len(batches) > 1 else progress)
        batch = parameters[rows]
        known = of_all or shared_attractors(batch, table.counts, settings, **options, progress=label)
        limits = find_limits(batch, table, known, settings, **options) if slow else None
        parts.append(label_within_limits(batch, known, settings, limits=limits, **options, progress=label))
    return join(parts, batches)


def label_entry(parameters: np.ndarray, settings: dict, **options) -> Columns:
    """The labels of `parameters`, shape (n,), the rows of an entry of the config, with its settings.

    options : `threads` and `progress`, as in `label_starts`
    """
    axes, model = settings["axes"], settings.get("model", {})
    varied = {name: axis for name, axis in axes.items() if name in INITIAL_CONDITION}
    fixed = {name: axis for name, axis in axes.items() if name not in varied}
    conveyors, starts = (math.prod(map(grid.count_values, some.values())) for some in (fixed, varied))
    sampled = (
        spread_rows(fixed, model, conveyors, SAMPLED_CONVEYORS),
        spread_rows(varied, model, starts, SAMPLED_STARTS),
    )
    table = Table(*sampled, (conveyors, starts))
    return label_starts(parameters, settings, starts=starts, table=table, **options)


def label_ends(parameters: np.ndarray, z_end: np.ndarray, vz_end: np.ndarray, settings: dict, **options) -> Columns:
    """The labels of runs of `parameters`; the converged solution continues them from their ends (m, m/s)."""
    return label_entry(continued(parameters, z_end, vz_end, settings["duration"]), settings, **options)
