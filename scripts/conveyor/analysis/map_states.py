"""States of the stroboscopic map for tables of parameters: where a motion begins, where it is later, and back."""

import numpy as np

from ..packing import as_rows, as_table
from . import stroboscopic_map


def initial_states(parameters: np.ndarray, tolerance: float) -> np.ndarray:
    """States (δ in m, v in m/s) at the phases ψ0 of a table of initial conditions, shape (n,): shape (n, 2).

    Examples
    --------
    >>> initial_states(parameter_table(Conveyor(acceleration=0.0), z0=[0.0, 1e-4]), 1e-10).tolist()
    [[-0.0, -0.0], [-0.0001, -0.0]]
    """
    return stroboscopic_map.initial_states(as_rows(parameters), tolerance)


def strobes(parameters: np.ndarray, cycles: int, tolerance: float) -> np.ndarray:
    """The states (δ in m, v in m/s) of one motion, a row of a table, after each of some cycles: shape (cycles, 2).

    NaN from a failure on.

    Examples
    --------
    >>> strobes(parameter_table(Conveyor(), z0=3e-4), 5, 1e-10).shape
    (5, 2)
    """
    row = as_rows(parameters)
    (state,) = stroboscopic_map.initial_states(row[None], tolerance)
    return stroboscopic_map.follow_map(row, tolerance, state, cycles)[1]


def start_at(parameters: np.ndarray, states: np.ndarray, tolerance: float) -> np.ndarray:
    """The table with initial conditions that begin at states (δ in m, v in m/s) at the phases ψ0, shape (n, 2).

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), z0=[1e-4, 3e-4])
    >>> again = start_at(parameters, initial_states(parameters, 1e-10), 1e-10)
    >>> bool(np.allclose(again["z0"], parameters["z0"], atol=1e-15))
    True
    """
    return as_table(stroboscopic_map.pack_states(as_rows(parameters), states, tolerance))
