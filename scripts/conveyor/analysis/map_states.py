"""States of the stroboscopic map for tables of parameters: where a motion begins, where it is later, and back."""

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import MOST_CYCLES, check_count, check_states, check_tolerance
from ..packing import as_rows, as_table, check_row, check_rows
from ..parameters import DEFAULT_TOLERANCE
from ..progress import progress_bar
from ..solver.model import Z0, Conveyor
from . import stroboscopic_map


def initial_states(parameters: Conveyor | np.ndarray, *, tolerance: float = DEFAULT_TOLERANCE) -> np.ndarray:
    """States (δ in m, v in m/s) at the phases ψ0 of a table of initial conditions with n rows: shape (n, 2).

    Examples
    --------
    >>> initial_states(parameter_table(Conveyor(acceleration=0.0), z0=[0.0, 1e-4])).tolist()
    [[-0.0, -0.0], [-0.0001, -0.0]]
    """
    return stroboscopic_map.initial_states(check_rows(parameters)[0], check_tolerance(tolerance))


def plate_heights(parameters: np.ndarray) -> np.ndarray:
    """Heights of the plates (m) at t = 0 (Eq. 4) for a table of the shape (n,), shape (n,).

    Examples
    --------
    >>> plate_heights(parameter_table(Conveyor(acceleration=40.0), psi0=[0.0, 3.0])) > 0.0
    array([False,  True])
    """
    rows = as_rows(parameters).copy()
    rows[:, Z0] = 0.0  # from where the penetration is the height of the plate
    return stroboscopic_map.initial_states(rows, DEFAULT_TOLERANCE)[:, 0]


def strobes(
    conveyor: Conveyor | np.ndarray,
    cycles: int,
    *,
    tolerance: float = DEFAULT_TOLERANCE,
    progress: str | None = None,
) -> np.ndarray:
    """The states (δ in m, v in m/s) of one motion after each of some cycles: shape (cycles, 2).

    conveyor : a Conveyor, or a row of a table with an initial condition
    progress : as in `sweep`

    NaN from a failure on. At most 1e6 cycles.

    Examples
    --------
    >>> strobes(parameter_table(Conveyor(), z0=3e-4), 5).shape
    (5, 2)
    """
    row, tolerance = check_row("conveyor", conveyor), check_tolerance(tolerance)
    cycles = check_count("cycles", cycles, 1, MOST_CYCLES)
    (state,) = stroboscopic_map.initial_states(row[None], tolerance)
    with progress_bar(total=cycles, label=progress, unit="cycles") as shown:
        return stroboscopic_map.follow_map(row, tolerance, state, cycles, shown.update)[1]


def start_at(
    parameters: Conveyor | np.ndarray, states: ArrayLike, *, tolerance: float = DEFAULT_TOLERANCE
) -> np.ndarray:
    """The table, shape (n,), with initial conditions that begin at states (δ in m, v in m/s) at the phases ψ0.

    states : shape (n, 2); those of one conveyor may be many; NaN for a motion that failed

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), z0=[1e-4, 3e-4])
    >>> again = start_at(parameters, initial_states(parameters))
    >>> bool(np.allclose(again["z0"], parameters["z0"], atol=1e-15))
    True
    """
    rows, shape = check_rows(parameters)
    if shape == () and np.ndim(states) == 2:
        rows = np.tile(rows, (len(states), 1))
    states = check_states("states", states, (len(rows), 2), may_be_nan=True)
    return as_table(stroboscopic_map.pack_states(rows, states, check_tolerance(tolerance)))
