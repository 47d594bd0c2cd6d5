"""The motion under a slow change of the conveyor: each conveyor begins where the one before ended."""

import numpy as np

from ...solver import trajectory
from ...solver.jit import compiled
from ...solver.trajectory import OK
from .. import stroboscopic_map


@compiled
def follow_change(parameters, tolerance, state, transient, strobes, codes):
    """See `follow_attractor`: fill `strobes`, shape (n, m, 2), and status `codes`, shape (n,); advance `state`."""
    cycles = transient + strobes.shape[1]
    visited, features = np.empty((cycles, 2)), np.empty((cycles, stroboscopic_map.FEATURES))
    strobes[:] = np.nan
    for i in range(parameters.shape[0]):
        codes[i] = stroboscopic_map.follow(parameters[i], tolerance, state, cycles, visited, features)
        strobes[i] = visited[transient:]
        if codes[i] != OK:
            return


def follow_attractor(
    parameters: np.ndarray, *, transient: int, strobes: int, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Stroboscopic states on the attractors of conveyors that change step by step.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack, in order; only the first initial condition counts
    transient : excitation cycles after each step that are not recorded
    strobes : excitation cycles that are recorded
    tolerance : of the contact steps

    Returns
    -------
    states, status : δ (m) and v (m/s) at the phase ψ0, shape (n, strobes, 2), and str, shape (n,); behind a failure NaN
    """
    parameters = np.ascontiguousarray(parameters, dtype=np.float64)
    states = np.empty((len(parameters), strobes, 2))
    codes = np.full(len(parameters), trajectory.NOT_FINITE)
    state = stroboscopic_map.initial_states(parameters[:1], tolerance)[0]
    follow_change(parameters, tolerance, state, transient, states, codes)
    return states, np.array(trajectory.STATUS)[codes]
