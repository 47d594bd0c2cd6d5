"""Which conveyor a start is on: what starts of one conveyor share is found once for all of them."""

import numpy as np

from ..solver.model import PSI0, VZ0, Z0


def without_starts(parameters: np.ndarray) -> np.ndarray:
    """The conveyors of rows, shape (n, 13): ψ0 only shifts the phase at which one looks, the start is no part of it."""
    conveyors = np.array(parameters, dtype=np.float64)
    conveyors[:, [PSI0, Z0, VZ0]] = 0.0
    return conveyors


def distinct(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The conveyors of rows, shape (n, 13), sorted, shape (m, 13), and the number of each row's, int64, shape (n,)."""
    rows = without_starts(parameters)
    # In most ensembles the starts of a conveyor follow each other; rows are slow to sort.
    first = np.flatnonzero(np.concatenate([np.ones(len(rows[:1]), bool), (rows[1:] != rows[:-1]).any(axis=1)]))
    conveyors, index = np.unique(rows[first], axis=0, return_inverse=True)
    return conveyors, np.repeat(index, np.diff(np.append(first, len(rows))))


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
