"""Many trajectories: one row per point, in the order of the points, whatever fails and however work is shared."""

import numpy as np

from .arguments import check_array, check_choice, check_count, check_packed, check_threads
from .methods import fixed_step
from .simulation import DEFAULT_STEP, DEFAULT_TOLERANCE, LAST, LONGEST, check_run
from .solver import trajectory, vertical_lanes
from .solver.horizontal import VX, VZ, X, Z
from .solver.parallel import for_each_chunk

STATUS = trajectory.STATUS
NEEDS = ("feeding", "vertical")
# Rows of the array of results that all methods fill.
MEAN_VELOCITY, Z_END, VZ_END, X_END, VX_END, MAX_GAP, IMPACTS, CONTACT_FRACTION = range(8)
IMPACT_SPEED, PEAK_FORCE, CODE = range(8, 11)
COLUMNS = (
    *("mean_velocity", "z_end", "vz_end", "x_end", "vx_end", "max_gap", "impacts", "contact_fraction"),
    *("impact_speed", "peak_force"),
)


def follow_by_events(parameters, durations, tolerance, feeding, out):
    """Fill `out`, shape (11, n), for `parameters`, shape (n, 16), and `durations` (s), by events."""
    times = np.column_stack([(1.0 - LAST) * durations, durations])
    if feeding:
        samples, results = trajectory.integrate(parameters, times, tolerance=tolerance)
        before, after = samples[:, 0], samples[:, 1]
        out[MEAN_VELOCITY] = (after[:, X] - before[:, X]) / (LAST * durations)
        out[X_END], out[VX_END] = after[:, X], after[:, VX]
    else:
        after, results = vertical_lanes.integrate(parameters, times, tolerance=tolerance)
        out[[MEAN_VELOCITY, X_END, VX_END]] = np.nan
    out[Z_END], out[VZ_END] = after[:, Z], after[:, VZ]
    out[MAX_GAP] = results[:, trajectory.MAX_GAP]
    out[IMPACTS] = results[:, trajectory.IMPACTS]
    out[CONTACT_FRACTION] = results[:, trajectory.CONTACT_TIME] / durations
    out[IMPACT_SPEED] = results[:, trajectory.IMPACT_SPEED]
    out[PEAK_FORCE] = results[:, trajectory.PEAK_FORCE]
    out[CODE] = results[:, trajectory.CODE]


def follow_by_steps(parameters, duration, step, method, out):
    """Fill `out`, shape (11, n), for `parameters`, shape (n, 16), with a fixed-step method."""
    for i, run in enumerate(fixed_step.run_all(parameters, duration, step, method, LAST)):
        out[[MEAN_VELOCITY, X_END, VX_END, Z_END, VZ_END], i] = run.mean_velocity, run.x, run.vx, run.z, run.vz
        out[[MAX_GAP, IMPACTS, CONTACT_FRACTION], i] = run.max_gap, run.impacts, run.contact_fraction
        out[[IMPACT_SPEED, PEAK_FORCE], i] = run.impact_speed, run.peak_force
        out[CODE, i] = STATUS.index(run.status)


def run(
    parameters: np.ndarray,
    *,
    duration: float | np.ndarray = 1.0,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    needs: str = "feeding",
    threads: int = 1,
    chunk: int = 1024,
    progress: str | None = None,
) -> dict[str, np.ndarray]:
    """Follow every point for `duration` (s), for the event-driven method also one for each point, shape (n,).

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack
    duration, method, tolerance, step : as in simulation.simulate
    needs : "feeding"; or "vertical" for the vertical motion alone, with NaN in the columns of the horizontal motion
        (event-driven method)
    threads, chunk : number of threads, and points that a thread takes at a time; the result does not depend on them
    progress : name of a progress bar on stderr, or None

    Returns
    -------
    dict of arrays of shape (n,): mean_velocity (m/s, over the last quarter), z_end, vz_end, x_end, vx_end (m, m/s),
    max_gap (m), impacts (int64), contact_fraction (1), impact_speed (m/s) and peak_force (N), the largest speed of
    approach at an impact and the largest contact force over the last quarter (0 if there is none), and status (str;
    "ok", or why the run ended early: numbers that are then not known are NaN)

    Raises
    ------
    ValueError
        names the argument that cannot be used
    """
    check_choice("needs", needs, NEEDS)
    threads = check_threads(threads)
    check_count("chunk", chunk, 1, 10**9)
    durations = check_array("duration", duration, np.finfo(np.float64).tiny, LONGEST, "s", least=0)
    _, tolerance, step = check_run(durations.max() if durations.size else LONGEST, method, tolerance, step)
    if method != "event" and durations.ndim > 0:
        raise ValueError("duration: only the event-driven method takes one for each point")
    parameters = check_packed(parameters)
    if durations.ndim > 0 and durations.shape != (len(parameters),):
        raise ValueError(f"duration has the shape {durations.shape}, but there are {len(parameters)} points")
    out = np.empty((CODE + 1, len(parameters)))
    feeding = needs == "feeding"
    durations = np.broadcast_to(durations, len(parameters)).copy()

    def work(begin, end):
        if method == "event":
            rows = slice(begin, end)
            follow_by_events(parameters[rows], durations[rows], tolerance, feeding, out[:, rows])
        else:
            follow_by_steps(parameters[begin:end], durations[begin], step, method, out[:, begin:end])
        return np.count_nonzero(out[CODE, begin:end] != trajectory.OK)

    for_each_chunk(work, len(parameters), threads=threads, chunk=chunk, progress=progress)
    columns = dict(zip(COLUMNS, out, strict=False))
    if not feeding:
        for name in ("mean_velocity", "x_end", "vx_end"):
            columns[name] = np.full(len(parameters), np.nan)
    columns["impacts"] = columns["impacts"].astype(np.int64)
    columns["status"] = np.array(STATUS, dtype=object)[out[CODE].astype(np.int64)]
    return columns
