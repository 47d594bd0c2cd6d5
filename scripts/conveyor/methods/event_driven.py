"""The solver itself, as it is compared with theory: samples and events of a trajectory in a single pass."""

import numpy as np

from ..packing import as_rows
from ..solver import trajectory
from ..solver.record import EVENT_KINDS, SAMPLES


def follow(
    parameters: np.ndarray, times: np.ndarray, tolerance: float, room: int
) -> tuple[dict[str, np.ndarray], list[tuple[float, str]]]:
    """Samples at `times` (s, ascending), and the first events up to the last time; no step is used twice.

    Parameters
    ----------
    parameters : a row of a table; gravity may be 0, which a Conveyor does not allow
    room : largest number of events

    Returns
    -------
    samples : x, vx, z, vz, contact_force, friction_force (m, m/s, N), shape of `times`
    events : times (s) and kinds
    """
    instants, kinds = np.empty((1, room)), np.full((1, room), -1, np.int8)
    options = {"tolerance": tolerance, "reuse": False, "event_times": instants, "event_kinds": kinds}
    (samples,), _ = trajectory.integrate(as_rows(parameters)[None], np.asarray(times)[None], **options)
    events = [(time, EVENT_KINDS[kind]) for time, kind in zip(instants[0], kinds[0], strict=True) if kind >= 0]
    return dict(zip(SAMPLES, samples.T, strict=True)), events
