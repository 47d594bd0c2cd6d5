"""Find the attractors of conveyors by following trajectories from sampled initial conditions."""

import math

import numpy as np

from ...packing import rows_and_shape
from ...parallel import for_each_chunk
from ...parameters import DEFAULT_TOLERANCE
from . import sampling
from .attractor_table import NO_ATTRACTORS, AttractorTable, concatenate, distinct_rows
from .chaotic_sets import find_chaotic_sets
from .trapping_regions import find_attracting_orbits

# Conveyors whose trajectories are followed side by side. Each takes 0.3 MB while its chaotic sets are searched for.
TOGETHER = 128
# Chaotic sets of a conveyor, and then its orbits, are searched for in at most as many cycles as this number of
# searches for a period takes, unless a number of cycles is given.
SEARCHES = 32


def find_attractors(
    parameters: np.ndarray,
    *,
    cycles: int,
    orbits: bool = True,
    most: int | None = None,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> AttractorTable:
    """The attractors of the conveyors in a table of `parameters`; the initial conditions there do not matter.

    Parameters
    ----------
    cycles : excitation cycles after which a search for a period ends, as in labels.classify
    most : excitation cycles that end the search for the chaotic sets of a conveyor, and the search for its orbits; the
        rest is not found. At most, and by default, SEARCHES times `cycles`
    orbits : whether trapping regions of periodic orbits are wanted; each takes some thousand cycles
    tolerance, threads, progress : as in labels.classify
    """
    conveyors, _ = distinct_rows(rows_and_shape(parameters)[0])
    most = min(SEARCHES * cycles, math.inf if most is None else most)
    attractors = [NO_ATTRACTORS] * len(conveyors)

    def work(begin, end):
        some = conveyors[begin:end]
        sampled = sampling.sample_conveyors(some, min(sampling.SHORT_SEARCH, cycles), tolerance)
        chaotic = find_chaotic_sets(some, sampled, cycles, tolerance, most=most)
        for k, (row, of_row, sets) in enumerate(zip(some, sampled, chaotic, strict=True), start=begin):
            known = NO_ATTRACTORS.orbits
            if orbits:
                known = find_attracting_orbits(row, of_row, sets, cycles, tolerance, most=most)
            attractors[k] = AttractorTable(known, sets)

    for_each_chunk(work, len(conveyors), threads=threads, chunk=TOGETHER, progress=progress)
    return concatenate([NO_ATTRACTORS, *attractors])
