"""Which motions starts end in, for the stages whose entries of the config say how to find that out."""

import math

import numpy as np

from conveyor import grid
from conveyor.chaotic_set import ChaoticSets, chaotic_sets
from conveyor.model import PARAMETERS, PSI0, VZ0, Z0
from conveyor.simulation import DEFAULT_TOLERANCE
from conveyor.states import Motions, classify, continued

# From so many starts of a conveyor on it costs less to find its chaotic sets first.
SHARED = 8


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


def motions(parameters: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> Motions:
    """The motions that the starts of `parameters`, shape (n, 13), end in; `settings` are those of their entry."""
    known = None
    if starts_per_conveyor(settings["axes"]) >= SHARED:
        known = known_sets(parameters, settings, threads=threads, progress=progress)
    options = {"cycles": settings["settling"], "tolerance": tolerance_of(settings)}
    return classify(parameters, known=known, **options, threads=threads, progress=progress)


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
