"""The motion under a slow change of the conveyor: each conveyor begins where the one before ended."""

import threading

import numpy as np

from ...arguments import MOST_CYCLES, MOST_VALUES, check_count, check_threads, check_tolerance
from ...columns import Columns
from ...packing import check_rows
from ...parallel import for_each_chunk
from ...parameters import DEFAULT_TOLERANCE
from ...progress import progress_bar
from ...solver.model import Conveyor
from ...solver.status import NOT_FINITE, OK, STATUS
from .. import stroboscopic_map


def bifurcation_diagram(
    parameters: Conveyor | np.ndarray,
    *,
    transient: int = 1000,
    strobes: int = 64,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """Stroboscopic states on the attractors of conveyors that change step by step.

    Parameters
    ----------
    parameters : from `parameter_table`, of any shape; the conveyors along the last axis follow each other, and only the
        first initial condition along it counts
    transient : excitation cycles on each conveyor before the recorded ones, up to 1e6
    strobes : excitation cycles that are recorded, 1 to 1e6
    tolerance, threads, progress : as in `sweep`; a thread follows the conveyors along the last axis

    Returns
    -------
    columns delta (m) and v (m/s) at the phase ψ0, with one more axis of `strobes` cycles, NaN from a failure on; and
    status, of the shape of `parameters`, "ok" or why the motion was lost

    Examples
    --------
    >>> diagram = bifurcation_diagram(parameter_table(Conveyor(), acceleration=[50.0, 57.0], z0=3e-4), strobes=2)
    >>> (1e6 * diagram.delta).round(1).tolist()  # µm: the period has doubled
    [[-600.9, -600.9], [-783.4, -476.1]]
    """
    (rows, shape), tolerance, threads = check_rows(parameters), check_tolerance(tolerance), check_threads(threads)
    if not len(rows):
        raise ValueError(f"parameters must have at least one row, got the shape {shape}")
    check_count("transient", transient, 0, MOST_CYCLES)
    check_count("strobes", strobes, 1, MOST_CYCLES)
    if len(rows) * strobes > MOST_VALUES:
        raise ValueError(f"strobes = {strobes} of {len(rows)} conveyors are more than {MOST_VALUES:g}; take fewer")
    lines = rows.reshape(-1, *shape[-1:], rows.shape[-1]) if shape else rows[None]
    states = np.full((*lines.shape[:2], strobes, 2), np.nan)
    codes, lock = np.full(lines.shape[:2], NOT_FINITE), threading.Lock()

    with progress_bar(total=len(rows) * (transient + strobes), label=progress, unit="cycles") as shown:

        def count(cycles):
            with lock:
                shown.update(cycles)

        def work(begin, end):
            for k in range(begin, end):
                (state,) = stroboscopic_map.initial_states(lines[k, :1], tolerance)
                for i, row in enumerate(lines[k]):
                    codes[k, i], visited = stroboscopic_map.follow_map(
                        row, tolerance, state, transient + strobes, count
                    )
                    states[k, i] = visited[transient:]
                    if codes[k, i] != OK:
                        break

        for_each_chunk(work, len(lines), threads=threads, chunk=1)
    delta, v = np.moveaxis(states, -1, 0).reshape(2, *shape, strobes)
    return Columns({"delta": delta, "v": v, "status": np.array(STATUS, dtype=object)[codes].reshape(shape)})
