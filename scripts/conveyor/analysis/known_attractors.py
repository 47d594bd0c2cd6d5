"""Finds the attractors of conveyors from where probes of them lead."""

import numpy as np

from ..solver.parallel import for_each_chunk
from . import probes
from .attracting_orbits import orbits_of_conveyor
from .chaotic_set import sets_of_conveyor
from .conveyors import distinct
from .known import NOTHING, KnownAttractors, together


def known_attractors(
    parameters: np.ndarray,
    *,
    cycles: int,
    orbits: bool = True,
    tolerance: float = 1e-8,
    threads: int = 1,
    progress: str | None = None,
) -> KnownAttractors:
    """The attractors of the conveyors in `parameters`, shape (n, 13), whatever their starts are.

    Parameters
    ----------
    cycles : excitation cycles after which a motion that has not settled is followed no further, as in states.classify
    orbits : whether neighbourhoods of periodic orbits are wanted: each takes some thousand cycles
    tolerance, threads, progress : as in states.classify
    """
    conveyors, _ = distinct(parameters)
    found = [NOTHING] * len(conveyors)

    def work(begin, end):
        for k in range(begin, end):
            row = conveyors[k]
            probed = probes.follow(row, probes.starts(row), min(probes.SETTLING, cycles), tolerance)
            found[k] = KnownAttractors(
                orbits_of_conveyor(row, probed, tolerance) if orbits else NOTHING.orbits,
                sets_of_conveyor(row, probed, cycles, tolerance),
            )

    for_each_chunk(work, len(conveyors), threads=threads, chunk=1, progress=progress)
    return together([NOTHING, *found])
