"""The known attractors of conveyors, in tables that compiled functions read.

All initial conditions on one conveyor share them, so that no trajectory is followed further than necessary. The modules
trapping_regions and chaotic_sets find them.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...packing import as_rows, as_table
from ...solver.model import PARAMETERS, PSI0, VZ0, Z0

BOXES = 256  # of a chaotic set, along each axis
# Places of the initial condition; ψ0 only shifts the phase at which a motion is observed.
INITIAL_CONDITION = (PSI0, Z0, VZ0)


def distinct_conveyors(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The conveyors of a table, each once, sorted, with phase and initial condition zero; and the conveyor of each row.

    Examples
    --------
    >>> conveyors, numbers = distinct_conveyors(parameter_table(Conveyor(), acceleration=[40.0, 20.0, 40.0], z0=1e-4))
    >>> conveyors["acceleration"].tolist(), numbers.tolist()
    ([20.0, 40.0], [1, 0, 1])
    """
    conveyors, numbers = distinct_rows(as_rows(parameters))
    return as_table(conveyors), numbers


def distinct_rows(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The conveyors of rows, shape (n, 16), each once, sorted, shape (m, 16); and the conveyor of each row, shape (n,).

    The phases and initial conditions of the conveyors are zero. The conveyor of a row is its number among them, int64.
    """
    # In most ensembles rows of one conveyor follow each other; rows are slow to sort, and to copy.
    follows = np.arange(len(parameters)) > 0
    for column in set(range(parameters.shape[1])) - set(INITIAL_CONDITION):
        follows[1:] &= parameters[1:, column] == parameters[:-1, column]
    first = np.flatnonzero(~follows)
    conveyors = np.array(parameters[first], dtype=np.float64)
    conveyors[:, INITIAL_CONDITION] = 0.0
    conveyors, index = np.unique(conveyors, axis=0, return_inverse=True)
    return conveyors, np.repeat(index, np.diff(np.append(first, len(parameters))))


def find_places(conveyors: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Where a table holds the rows of some conveyors: int64, shape (n, 2).

    Returns the first row and the row behind the last; 0, 0 for a conveyor that the table does not have.

    Parameters
    ----------
    conveyors : the conveyor of each row, shape (m,), as from `distinct_conveyors`; equal ones are adjacent
    wanted : the conveyors to look up, shape (n,)

    Examples
    --------
    >>> conveyors, _ = distinct_conveyors(parameter_table(Conveyor(), acceleration=[20.0, 30.0, 40.0]))
    >>> find_places(conveyors[[0, 1, 1]], conveyors).tolist()
    [[0, 1], [1, 3], [0, 0]]
    """
    places = {}
    for k, row in enumerate(conveyors):
        first, _ = places.get(row.tobytes(), (k, k))
        places[row.tobytes()] = first, k + 1
    return np.array([places.get(row.tobytes(), (0, 0)) for row in wanted], dtype=np.int64).reshape(-1, 2)


class AttractingOrbits(NamedTuple):
    """m periodic orbits, most with a trapping region. The orbits of one conveyor are adjacent."""

    conveyors: np.ndarray  # float64, shape (m, 16), packed, their phases and initial conditions zero
    centres: np.ndarray  # float64, shape (m, 2), δ (m) and Y (m/s) of a point at pieces.BEGIN_OF_CYCLE
    factors: (
        np.ndarray
    )  # float64, shape (m, 3), upper triangle of R: the trapping region is |R (x - centre)| ≤ 1, inf: none
    periods: np.ndarray  # int64, shape (m,), excitation cycles
    flights: np.ndarray  # float64, shape (m,), s, longest flight


class ChaoticSets(NamedTuple):
    """m chaotic sets. The sets of one conveyor are adjacent."""

    conveyors: np.ndarray  # float64, shape (m, 16), packed, their phases and initial conditions zero
    low: np.ndarray  # float64, shape (m, 2), lower corner of the boxes: δ (m), v (m/s) at pieces.BEGIN_OF_CYCLE
    size: np.ndarray  # float64, shape (m, 2), of a box
    cells: np.ndarray  # bool, shape (m, BOXES, BOXES): visited, or next to one that is


class AttractorTable(NamedTuple):
    """The known attractors of some conveyors, from `find_attractors`."""

    orbits: AttractingOrbits
    chaotic: ChaoticSets

    def rows_of(self, parameters: np.ndarray) -> np.ndarray:
        """Where the table holds the attractors of packed parameters, shape (n, 16): int64, shape (n, 4).

        Each row has the number of its conveyor's first orbit and the number behind its last orbit, then the same two
        numbers for its chaotic sets.
        """
        conveyors, index = distinct_rows(parameters)
        return np.hstack([find_places(table.conveyors, conveyors) for table in self])[index]


NO_ATTRACTORS = AttractorTable(
    AttractingOrbits(
        np.empty((0, len(PARAMETERS))), np.empty((0, 2)), np.empty((0, 3)), np.empty(0, np.int64), np.empty(0)
    ),
    ChaoticSets(
        np.empty((0, len(PARAMETERS))), np.empty((0, 2)), np.empty((0, 2)), np.empty((0, BOXES, BOXES), np.bool_)
    ),
)


def stack(columns: Sequence[np.ndarray]) -> np.ndarray:
    """Columns of several tables below each other; a table without rows fits any number of harmonics."""
    return np.concatenate([column for column in columns if len(column)] or columns[:1])


def append_row(table: AttractingOrbits | ChaoticSets, *row: np.ndarray | float) -> AttractingOrbits | ChaoticSets:
    """The table with one more row, from its values in the order of the fields."""
    columns = zip(table, row, strict=True)
    return type(table)(*(stack([column, np.array([value], dtype=column.dtype)]) for column, value in columns))


def concatenate(parts: list[AttractorTable]) -> AttractorTable:
    """The tables of several conveyors below each other."""
    orbits, chaotic = zip(*parts, strict=True)
    return AttractorTable(
        AttractingOrbits(*map(stack, zip(*orbits, strict=True))),
        ChaoticSets(*map(stack, zip(*chaotic, strict=True))),
    )
