"""Finds the attractors of conveyors from where probes of them lead."""

import numpy as np

from ..solver.parallel import for_each_chunk
from . import probes
from .attracting_orbits import orbits_of_conveyor
from .chaotic_set import sets_of_conveyors
from .conveyors import distinct
from .known import NOTHING, KnownAttractors, together

# Conveyors whose probes are followed side by side.
TOGETHER = 16


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
        some = conveyors[begin:end]
        probed = probes.of_conveyors(some, min(probes.SETTLING, cycles), tolerance)
        chaotic = sets_of_conveyors(some, probed, cycles, tolerance)
        for k, (row, of_row, sets) in enumerate(zip(some, probed, chaotic, strict=True), start=begin):
            found[k] = KnownAttractors(orbits_of_conveyor(row, of_row, tolerance) if orbits else NOTHING.orbits, sets)

    chunk = TOGETHER if len(conveyors) >= TOGETHER * threads else 1
    for_each_chunk(work, len(conveyors), threads=threads, chunk=chunk, progress=progress)
    return together([NOTHING, *found])
