"""The motion under a slow change of the conveyor: each conveyor begins where the one before ended."""

import numpy as np

from ...arguments import MOST_CYCLES, check_count, check_tolerance
from ...packing import check_rows
from ...parameters import DEFAULT_TOLERANCE
from ...progress import progress_bar
from ...solver.status import NOT_FINITE, OK, STATUS
from .. import stroboscopic_map


def bifurcation_diagram(
    parameters: np.ndarray,
    *,
    transient: int = 1000,
    strobes: int = 64,
    tolerance: float = DEFAULT_TOLERANCE,
    progress: str | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Stroboscopic states on the attractors of conveyors that change step by step.

    Parameters
    ----------
    parameters : table, shape (n,), in order; only the first initial condition counts
    transient : excitation cycles on each conveyor before the recorded ones, up to 1e6
    strobes : excitation cycles that are recorded, 1 to 1e6
    tolerance, progress : as in `sweep`

    Returns
    -------
    states : float64, shape (n, strobes, 2), δ (m) and v (m/s) at the phase ψ0; NaN from a failure on
    status : str, shape (n,), "ok" or why the motion was lost

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), acceleration=[50.0, 57.0], z0=3e-4)
    >>> states, status = bifurcation_diagram(parameters, transient=500, strobes=2)
    >>> (1e6 * states[:, :, 0]).round(1).tolist()  # µm: the period has doubled
    [[-600.9, -600.9], [-783.4, -476.1]]
    """
    (parameters, shape), tolerance = check_rows(parameters), check_tolerance(tolerance)
    if len(shape) > 1 or not len(parameters):
        raise ValueError(f"parameters must be a table of the shape (n,), got {shape}")
    check_count("transient", transient, 0, MOST_CYCLES)
    check_count("strobes", strobes, 1, MOST_CYCLES)
    states = np.full((len(parameters), strobes, 2), np.nan)
    codes = np.full(len(parameters), NOT_FINITE)
    (state,) = stroboscopic_map.initial_states(parameters[:1], tolerance)
    for i, row in enumerate(progress_bar(parameters, label=progress)):
        codes[i], visited, _ = stroboscopic_map.follow_map(row, tolerance, state, transient + strobes)
        states[i] = visited[transient:]
        if codes[i] != OK:
            break
    return states, np.array(STATUS)[codes]
