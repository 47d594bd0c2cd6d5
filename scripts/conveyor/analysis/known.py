"""What starts of one conveyor share: the attractors that are known of it, so that none is followed further than needed.

They are tables that kernels read, see attracting_orbits and chaotic_set for how they are found.
"""

from typing import NamedTuple

import numpy as np

from ..solver.model import PARAMETERS
from .conveyors import distinct, places

BOXES = 256  # of a chaotic set, along each axis


class AttractingOrbits(NamedTuple):
    """m periodic orbits, each with a neighbourhood from which all starts end in it; of one conveyor side by side."""

    conveyors: np.ndarray  # float64, shape (m, 13), packed, their phases and starts zero
    centres: (
        np.ndarray
    )  # float64, shape (m, 2), δ (m), Y (m/s, see stroboscope) of a point at trajectory.BEGIN_OF_CYCLE
    factors: np.ndarray  # float64, shape (m, 3), upper triangle of R: the neighbourhood is |R (x - centre)| ≤ 1
    periods: np.ndarray  # int64, shape (m,), excitation cycles
    flights: np.ndarray  # float64, shape (m,), s, longest flight


class ChaoticSets(NamedTuple):
    """m chaotic sets; of one conveyor side by side."""

    conveyors: np.ndarray  # float64, shape (m, 13), packed, their phases and starts zero
    low: np.ndarray  # float64, shape (m, 2), lower corner of the boxes: δ (m), v (m/s) at trajectory.BEGIN_OF_CYCLE
    size: np.ndarray  # float64, shape (m, 2), of a box
    cells: np.ndarray  # bool, shape (m, BOXES, BOXES): visited, or next to one that is


class KnownAttractors(NamedTuple):
    """The attractors that are known of some conveyors."""

    orbits: AttractingOrbits
    chaotic: ChaoticSets

    def of(self, parameters: np.ndarray) -> np.ndarray:
        """Where rows, shape (n, 13), find those of their conveyors: int64, shape (n, 4).

        First orbit and the one behind the last one, first chaotic set and the one behind the last one.
        """
        conveyors, index = distinct(parameters)
        return np.hstack([places(table.conveyors, conveyors) for table in self])[index]


def orbits_of(conveyor: np.ndarray, found: list[tuple[np.ndarray, np.ndarray, int, float]]) -> AttractingOrbits:
    """The table of orbits of one conveyor, shape (13,), from the centre, factor, period and flight of each."""
    centres, factors, periods, flights = zip(*found, strict=True) if found else ((), (), (), ())
    return AttractingOrbits(
        np.tile(conveyor, (len(found), 1)),
        np.array(centres, dtype=np.float64).reshape(-1, 2),
        np.array(factors, dtype=np.float64).reshape(-1, 3),
        np.array(periods, dtype=np.int64),
        np.array(flights, dtype=np.float64),
    )


def chaotic_sets_of(conveyor: np.ndarray, found: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> ChaoticSets:
    """The table of chaotic sets of one conveyor, shape (13,), from the `low`, `size` and `cells` of each."""
    low, size, cells = zip(*found, strict=True) if found else ((), (), ())
    return ChaoticSets(
        np.tile(conveyor, (len(found), 1)),
        np.array(low, dtype=np.float64).reshape(-1, 2),
        np.array(size, dtype=np.float64).reshape(-1, 2),
        np.array(cells, dtype=np.bool_).reshape(-1, BOXES, BOXES),
    )


def together(parts: list[KnownAttractors]) -> KnownAttractors:
    """The tables of several conveyors below each other."""
    orbits, chaotic = zip(*parts, strict=True)
    return KnownAttractors(
        AttractingOrbits(*map(np.concatenate, zip(*orbits, strict=True))),
        ChaoticSets(*map(np.concatenate, zip(*chaotic, strict=True))),
    )


_NO_CONVEYOR = np.zeros(len(PARAMETERS))
NOTHING = KnownAttractors(orbits_of(_NO_CONVEYOR, []), chaotic_sets_of(_NO_CONVEYOR, []))
