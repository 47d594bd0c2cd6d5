"""The motion under a slow change of the conveyor: each conveyor begins where the one before ended."""

import numpy as np

from ...arguments import MOST_CYCLES, check_count, check_tolerance
from ...packing import check_rows
from ...solver.status import NOT_FINITE, OK, STATUS
from .. import stroboscopic_map


def follow_attractor(
    parameters: np.ndarray, *, transient: int, strobes: int, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Stroboscopic states on the attractors of conveyors that change step by step.

    Parameters
    ----------
    parameters : table, shape (n,), in order; only the first initial condition counts
    transient : excitation cycles after each step that are not recorded
    strobes : excitation cycles that are recorded
    tolerance : of the contact steps

    Returns
    -------
    states, status : δ (m) and v (m/s) at the phase ψ0, shape (n, strobes, 2), and str, shape (n,); behind a failure NaN
    """
    (parameters, _), tolerance = check_rows(parameters), check_tolerance(tolerance)
    check_count("transient", transient, 0, MOST_CYCLES)
    check_count("strobes", strobes, 1, MOST_CYCLES)
    states = np.full((len(parameters), strobes, 2), np.nan)
    codes = np.full(len(parameters), NOT_FINITE)
    (state,) = stroboscopic_map.initial_states(parameters[:1], tolerance)
    for i, row in enumerate(parameters):
        codes[i], visited, _ = stroboscopic_map.follow_map(row, tolerance, state, transient + strobes)
        states[i] = visited[transient:]
        if codes[i] != OK:
            break
    return states, np.array(STATUS)[codes]
