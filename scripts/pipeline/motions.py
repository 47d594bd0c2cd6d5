"""Which motions starts end in, for the stages whose entries of the config say how to find that out."""

import math

import numpy as np

from conveyor.analysis.chaotic_set import ChaoticSets, chaotic_sets, without_starts
from conveyor.analysis.states import Motions, classify, continued
from conveyor.simulation import DEFAULT_TOLERANCE
from conveyor.solver.model import PARAMETERS, PSI0, VZ0, Z0
from pipeline import grid

# From so many starts of a conveyor on it costs less to find its chaotic sets first.
SHARED = 8
# So many conveyors have their chaotic sets in memory at a time, some 30 kB each.
CONVEYORS = 2000


def starts_per_conveyor(axes: dict) -> int:
    """Number of starts of each conveyor in the product of some axes."""
    return math.prod(
        len(grid.axis_values(PARAMETERS[k], axes[PARAMETERS[k]])) for k in (PSI0, Z0, VZ0) if PARAMETERS[k] in axes
    )


def tolerance_of(settings: dict) -> float:
    """Of the contact steps in the search; what a fixed-step method leaves is followed on at the default."""
    return settings.get("tolerance", DEFAULT_TOLERANCE)


def known_sets(parameters: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> ChaoticSets:
    """The chaotic sets of conveyors, shape (n, 13), as the settings of an entry ask for them."""
    options = {"cycles": settings["settling"], "tolerance": tolerance_of(settings)}
    return chaotic_sets(parameters, **options, threads=threads, progress=progress and f"{progress}: chaotic sets")


def of_conveyors(parameters: np.ndarray) -> list[np.ndarray]:
    """Rows of `parameters`, shape (n, 13), in batches that hold all starts of their conveyors."""
    _, conveyor = np.unique(without_starts(parameters), axis=0, return_inverse=True)
    order = np.argsort(conveyor, kind="stable")
    batch = conveyor[order] // CONVEYORS
    return np.split(order, np.flatnonzero(np.diff(batch)) + 1)


def motions_of_starts(
    parameters: np.ndarray, settings: dict, *, shared: bool, threads: int = 1, progress: str | None = None
) -> Motions:
    """The motions that starts end in, whether or not their conveyors' chaotic sets are found first (`shared`).

    Parameters
    ----------
    parameters : float64, shape (n, 13)
    settings : `settling`, and `tolerance` if it is not the default
    """
    options = {"cycles": settings["settling"], "tolerance": tolerance_of(settings), "threads": threads}
    batches = of_conveyors(parameters)
    parts = []
    for number, rows in enumerate(batches, start=1):
        label = progress and (f"{progress} ({number} of {len(batches)})" if len(batches) > 1 else progress)
        known = known_sets(parameters[rows], settings, threads=threads, progress=label) if shared else None
        parts.append(classify(parameters[rows], known=known, **options, progress=label))
    order = np.argsort(np.concatenate(batches))
    return Motions(*(np.concatenate(column)[order] for column in zip(*parts, strict=True)))


def motions(parameters: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> Motions:
    """The motions that the starts of `parameters`, shape (n, 13), end in; `settings` are those of their entry."""
    shared = starts_per_conveyor(settings["axes"]) >= SHARED
    return motions_of_starts(parameters, settings, shared=shared, threads=threads, progress=progress)


def motions_after(
    parameters: np.ndarray,
    z_end: np.ndarray,
    vz_end: np.ndarray,
    settings: dict,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> Motions:
    """The motions that runs of `parameters` with these ends (m, m/s) go on to, by whichever method they were made."""
    later = continued(parameters, z_end, vz_end, settings["duration"])
    return motions(later, settings, threads=threads, progress=progress)
