"""Find the attractors of conveyors from where sampled initial conditions lead."""

import numpy as np

from ...solver.parallel import for_each_chunk
from . import sampling
from .attractor_table import NO_ATTRACTORS, AttractorTable, distinct, together
from .chaotic_sets import sets_of_conveyors
from .trapping_regions import orbits_of_conveyor

# Conveyors whose trajectories are followed side by side.
TOGETHER = 16


def find_attractors(
    parameters: np.ndarray,
    *,
    cycles: int,
    orbits: bool = True,
    tolerance: float = 1e-8,
    threads: int = 1,
    progress: str | None = None,
) -> AttractorTable:
    """The attractors of the conveyors in `parameters`, shape (n, 13), whatever their starts are.

    Parameters
    ----------
    cycles : excitation cycles after which a motion that has not settled is followed no further, as in labels.classify
    orbits : whether neighbourhoods of periodic orbits are wanted: each takes some thousand cycles
    tolerance, threads, progress : as in labels.classify
    """
    conveyors, _ = distinct(parameters)
    found = [NO_ATTRACTORS] * len(conveyors)

    def work(begin, end):
        some = conveyors[begin:end]
        sampled = sampling.sample_conveyors(some, min(sampling.SETTLING, cycles), tolerance)
        chaotic = sets_of_conveyors(some, sampled, cycles, tolerance)
        for k, (row, of_row, sets) in enumerate(zip(some, sampled, chaotic, strict=True), start=begin):
            found[k] = AttractorTable(
                orbits_of_conveyor(row, of_row, tolerance) if orbits else NO_ATTRACTORS.orbits, sets
            )

    chunk = TOGETHER if len(conveyors) >= TOGETHER * threads else 1
    for_each_chunk(work, len(conveyors), threads=threads, chunk=chunk, progress=progress)
    return together([NO_ATTRACTORS, *found])
