"""The known attractors of conveyors, in tables that compiled functions read.

All initial conditions on one conveyor share them, so that no trajectory is followed further than necessary. The modules
trapping_regions and chaotic_sets find them.
"""

from typing import NamedTuple

import numpy as np

from ...solver.model import PARAMETERS, PSI0, VZ0, Z0

BOXES = 256  # of a chaotic set, along each axis
# Places of the initial condition; ψ0 only shifts the phase at which a motion is observed.
INITIAL_CONDITION = (PSI0, Z0, VZ0)
CONVEYOR = [place for place in range(len(PARAMETERS)) if place not in INITIAL_CONDITION]


def distinct_conveyors(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The conveyors of rows, shape (n, 16), sorted, shape (m, 16), and the number of each row's, int64, shape (n,).

    The phases and initial conditions of the conveyors are zero.
    """
    # In most ensembles rows of one conveyor follow each other; rows are slow to sort, and to copy.
    follows = np.arange(len(parameters)) > 0
    for column in CONVEYOR:
        follows[1:] &= parameters[1:, column] == parameters[:-1, column]
    first = np.flatnonzero(~follows)
    conveyors = np.array(parameters[first], dtype=np.float64)
    conveyors[:, INITIAL_CONDITION] = 0.0
    conveyors, index = np.unique(conveyors, axis=0, return_inverse=True)
    return conveyors, np.repeat(index, np.diff(np.append(first, len(parameters))))


def find_places(conveyors: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """The rows of a table that belong to each of the `wanted` conveyors, shape (n, 16): int64, shape (n, 2).

    conveyors : float64, shape (m, 16), the conveyor of each row of the table, equal ones side by side
    Returns the first row, and the one behind the last; 0, 0 for a conveyor that the table does not have.
    """
    found = {}
    for k, row in enumerate(conveyors):
        first, _ = found.get(row.tobytes(), (k, k))
        found[row.tobytes()] = first, k + 1
    return np.array([found.get(row.tobytes(), (0, 0)) for row in wanted], dtype=np.int64).reshape(-1, 2)


class AttractingOrbits(NamedTuple):
    """m periodic orbits, each with a trapping region. The orbits of one conveyor are adjacent."""

    conveyors: np.ndarray  # float64, shape (m, 16), packed, their phases and initial conditions zero
    centres: np.ndarray  # float64, shape (m, 2), δ (m) and Y (m/s) of a point at trajectory.BEGIN_OF_CYCLE
    factors: np.ndarray  # float64, shape (m, 3), upper triangle of R: the trapping region is |R (x - centre)| ≤ 1
    periods: np.ndarray  # int64, shape (m,), excitation cycles
    flights: np.ndarray  # float64, shape (m,), s, longest flight


class ChaoticSets(NamedTuple):
    """m chaotic sets. The sets of one conveyor are adjacent."""

    conveyors: np.ndarray  # float64, shape (m, 16), packed, their phases and initial conditions zero
    low: np.ndarray  # float64, shape (m, 2), lower corner of the boxes: δ (m), v (m/s) at trajectory.BEGIN_OF_CYCLE
    size: np.ndarray  # float64, shape (m, 2), of a box
    cells: np.ndarray  # bool, shape (m, BOXES, BOXES): visited, or next to one that is


class AttractorTable(NamedTuple):
    """The known attractors of some conveyors."""

    orbits: AttractingOrbits
    chaotic: ChaoticSets

    def rows_of(self, parameters: np.ndarray) -> np.ndarray:
        """Where the table holds the attractors of packed parameters, shape (n, 16): int64, shape (n, 4).

        Each row has the first orbit of its conveyor, the one behind the last orbit, and the same of chaotic sets.
        """
        conveyors, index = distinct_conveyors(parameters)
        return np.hstack([find_places(table.conveyors, conveyors) for table in self])[index]


def orbit_table(conveyor: np.ndarray, found: list[tuple[np.ndarray, np.ndarray, int, float]]) -> AttractingOrbits:
    """The table of orbits of one conveyor, shape (16,), from the centre, factor, period and flight of each."""
    centres, factors, periods, flights = zip(*found, strict=True) if found else ((), (), (), ())
    return AttractingOrbits(
        np.tile(conveyor, (len(found), 1)),
        np.array(centres, dtype=np.float64).reshape(-1, 2),
        np.array(factors, dtype=np.float64).reshape(-1, 3),
        np.array(periods, dtype=np.int64),
        np.array(flights, dtype=np.float64),
    )


def chaotic_set_table(conveyor: np.ndarray, found: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> ChaoticSets:
    """The table of chaotic sets of one conveyor, shape (16,), from the `low`, `size` and `cells` of each."""
    low, size, cells = zip(*found, strict=True) if found else ((), (), ())
    return ChaoticSets(
        np.tile(conveyor, (len(found), 1)),
        np.array(low, dtype=np.float64).reshape(-1, 2),
        np.array(size, dtype=np.float64).reshape(-1, 2),
        np.array(cells, dtype=np.bool_).reshape(-1, BOXES, BOXES),
    )


def concatenate(parts: list[AttractorTable]) -> AttractorTable:
    """The tables of several conveyors below each other."""
    orbits, chaotic = zip(*parts, strict=True)
    return AttractorTable(
        AttractingOrbits(*map(np.concatenate, zip(*orbits, strict=True))),
        ChaoticSets(*map(np.concatenate, zip(*chaotic, strict=True))),
    )


_NO_CONVEYOR = np.zeros(len(PARAMETERS))
NO_ATTRACTORS = AttractorTable(orbit_table(_NO_CONVEYOR, []), chaotic_set_table(_NO_CONVEYOR, []))
