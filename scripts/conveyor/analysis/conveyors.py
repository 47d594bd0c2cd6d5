"""Which conveyor a start is on: what starts of one conveyor share is found once for all of them."""

import numpy as np

from ..solver.model import PARAMETERS, PSI0, VZ0, Z0

# ψ0 only shifts the phase at which one looks, the start is no part of a conveyor.
START = (PSI0, Z0, VZ0)
CONVEYOR = [place for place in range(len(PARAMETERS)) if place not in START]


def without_starts(parameters: np.ndarray) -> np.ndarray:
    """The conveyors of rows, shape (n, 13): their phases and starts are zero."""
    conveyors = np.array(parameters, dtype=np.float64)
    conveyors[:, START] = 0.0
    return conveyors


def distinct(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The conveyors of rows, shape (n, 13), sorted, shape (m, 13), and the number of each row's, int64, shape (n,)."""
    # In most ensembles the starts of a conveyor follow each other; rows are slow to sort, and to copy.
    follows = np.arange(len(parameters)) > 0
    for column in CONVEYOR:
        follows[1:] &= parameters[1:, column] == parameters[:-1, column]
    first = np.flatnonzero(~follows)
    conveyors, index = np.unique(without_starts(parameters[first]), axis=0, return_inverse=True)
    return conveyors, np.repeat(index, np.diff(np.append(first, len(parameters))))


def places(conveyors: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Where each of the `wanted` conveyors, shape (n, 13), finds what is known of it: int64, shape (n, 2).

    conveyors : float64, shape (m, 13), of what is known, equal ones side by side
    Returns the first place, and the one behind the last; 0, 0 where nothing is known.
    """
    found = {}
    for k, row in enumerate(conveyors):
        first, _ = found.get(row.tobytes(), (k, k))
        found[row.tobytes()] = first, k + 1
    return np.array([found.get(row.tobytes(), (0, 0)) for row in wanted], dtype=np.int64).reshape(-1, 2)
