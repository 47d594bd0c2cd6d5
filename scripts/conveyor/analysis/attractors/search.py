"""Find the attractors of conveyors by following trajectories from sampled initial conditions."""

import numpy as np

from ...arguments import MOST_CYCLES, check_count, check_flag, check_threads, check_tolerance
from ...packing import check_rows
from ...parallel import for_each_chunk
from ...parameters import DEFAULT_TOLERANCE
from . import sampling
from .attractor_table import NO_ATTRACTORS, AttractorTable, concatenate, distinct_rows
from .chaotic_sets import find_chaotic_sets
from .trapping_regions import find_attracting_orbits

# Conveyors whose trajectories are followed side by side. Each takes 0.3 MB while its chaotic sets are searched for.
TOGETHER = 128
# Chaotic sets of a conveyor, and then its orbits, are searched for in at most as many cycles as this number of
# searches for a period takes.
SEARCHES = 32


def find_attractors(
    parameters: np.ndarray,
    *,
    cycles: int,
    orbits: bool = True,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> AttractorTable:
    """The attractors that trajectories from sampled initial conditions lead to, on each conveyor of a table.

    `classify` is faster with them. They are numerical results: an attractor with a small basin may be missing, and so
    may one that is not reached within SEARCHES times `cycles`.

    Parameters
    ----------
    parameters : from `parameter_table`, of any shape; their initial conditions do not matter
    cycles : excitation cycles after which the search for a period ends, as in `classify`
    orbits : whether periodic orbits are wanted; the trapping region of one takes some thousand cycles
    tolerance, threads, progress : as in `classify`

    Returns
    -------
    AttractorTable with the attractors of each distinct conveyor

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), acceleration=40.0, z0=[0.0, 3e-4])
    >>> attractors = find_attractors(parameters, cycles=400)
    >>> attractors.orbits.periods.tolist(), len(attractors.chaotic.conveyors)
    ([1, 1], 0)
    >>> classify(parameters, attractors=attractors).state.tolist()
    ['first', 'second']
    """
    conveyors, _ = distinct_rows(check_rows(parameters)[0])
    cycles = check_count("cycles", cycles, 1, MOST_CYCLES)
    tolerance, threads, orbits = check_tolerance(tolerance), check_threads(threads), check_flag("orbits", orbits)
    attractors = [NO_ATTRACTORS] * len(conveyors)

    def work(begin, end):
        some = conveyors[begin:end]
        sampled = sampling.sample_conveyors(some, min(sampling.SHORT_SEARCH, cycles), tolerance)
        chaotic = find_chaotic_sets(some, sampled, cycles, tolerance, max_cycles=SEARCHES * cycles)
        for k, (row, of_row, sets) in enumerate(zip(some, sampled, chaotic, strict=True), start=begin):
            known = NO_ATTRACTORS.orbits
            if orbits:
                known = find_attracting_orbits(row, of_row, sets, cycles, tolerance, max_cycles=SEARCHES * cycles)
            attractors[k] = AttractorTable(known, sets)

    for_each_chunk(work, len(conveyors), threads=threads, chunk=TOGETHER, progress=progress)
    return concatenate([NO_ATTRACTORS, *attractors])
