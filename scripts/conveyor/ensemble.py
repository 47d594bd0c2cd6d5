"""Many trajectories: one row per point, in the order of the points, also where a run fails."""

import numpy as np

from .arguments import LONGEST, check_array, check_choice, check_count, check_packed, check_threads, check_tolerance
from .methods import fixed_step
from .simulation import DEFAULT_STEP, DEFAULT_TOLERANCE, LAST, check_run
from .solver import trajectory, vertical_lanes
from .solver.horizontal import VX, VZ, X, Z
from .solver.parallel import for_each_chunk

STATUS = trajectory.STATUS
NEEDS = ("feeding", "vertical")
HORIZONTAL = ("mean_velocity", "x_end", "vx_end")
COLUMNS = (
    *("mean_velocity", "z_end", "vz_end", "x_end", "vx_end", "max_gap", "impacts", "contact_fraction"),
    *("impact_speed", "peak_force"),
)


def follow_by_events(parameters, durations, tolerance, feeding):
    """The columns of `run`, each of shape (n,), for `parameters`, shape (n, 16), and `durations` (s), by events."""
    times = np.column_stack([(1.0 - LAST) * durations, durations])
    if feeding:
        samples, results = trajectory.integrate(parameters, times, tolerance=tolerance)
        before, after = samples[:, 0], samples[:, 1]
        horizontal = (after[:, X] - before[:, X]) / (LAST * durations), after[:, X], after[:, VX]
    else:
        after, results = vertical_lanes.integrate(parameters, times, tolerance=tolerance)
        horizontal = np.full((3, len(parameters)), np.nan)
    return {
        **dict(zip(HORIZONTAL, horizontal, strict=True)),
        "z_end": after[:, Z],
        "vz_end": after[:, VZ],
        "max_gap": results[:, trajectory.MAX_GAP],
        "impacts": results[:, trajectory.IMPACTS],
        "contact_fraction": results[:, trajectory.CONTACT_TIME] / durations,
        "impact_speed": results[:, trajectory.IMPACT_SPEED],
        "peak_force": results[:, trajectory.PEAK_FORCE],
        "status": results[:, trajectory.CODE],
    }


def follow_by_steps(parameters, duration, step, method, feeding):
    """The columns of `run`, each of shape (n,), for `parameters`, shape (n, 16), with a fixed-step method."""
    runs = fixed_step.run_all(parameters, duration, step, method)
    fields = {"z_end": "z", "vz_end": "vz", "x_end": "x", "vx_end": "vx"}
    columns = {name: np.array([getattr(run, fields.get(name, name)) for run in runs]) for name in COLUMNS}
    if not feeding:
        columns |= dict.fromkeys(HORIZONTAL, np.nan)
    return columns | {"status": np.array([STATUS.index(run.status) for run in runs])}


def run(
    parameters: np.ndarray,
    *,
    duration: float | np.ndarray = 1.0,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    needs: str = "feeding",
    threads: int = 1,
    chunk: int = 4096,
    progress: str | None = None,
) -> dict[str, np.ndarray]:
    """Follow every point for `duration` (s). The event-driven method also takes one duration per point, shape (n,).

    ValueError names the argument that cannot be used.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack
    duration, method, tolerance, step : as in simulation.simulate
    needs : "feeding"; or "vertical" for NaN in the columns of the horizontal motion, which saves time with the
        event-driven method
    threads, chunk : number of threads, and points that a thread takes at a time; the result does not depend on them
    progress : name of a progress bar on stderr, or None

    Returns
    -------
    dict of arrays of shape (n,): mean_velocity (m/s, over the last quarter), z_end, vz_end, x_end, vx_end (m, m/s),
    max_gap (m), impacts (int64), contact_fraction (1), impact_speed (m/s) and peak_force (N), the largest speed of
    approach at an impact and the largest contact force over the last quarter (0 if there is none), and status (str;
    "ok", or why the run ended early: impacts are then those up to its end, all other numbers NaN)
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
    feeding = needs == "feeding"
    durations = np.broadcast_to(durations, len(parameters)).copy()
    columns = {name: np.empty(len(parameters)) for name in (*COLUMNS, "status")}

    def work(begin, end):
        rows = slice(begin, end)
        if method == "event":
            found = follow_by_events(parameters[rows], durations[rows], tolerance, feeding)
        else:
            found = follow_by_steps(parameters[rows], durations[begin], step, method, feeding)
        for name, values in found.items():
            columns[name][rows] = values
        return np.count_nonzero(columns["status"][rows] != trajectory.OK)

    for_each_chunk(work, len(parameters), threads=threads, chunk=chunk, progress=progress)
    columns["impacts"] = columns["impacts"].astype(np.int64)
    failed = columns["status"] != trajectory.OK
    columns["max_gap"][failed] = columns["contact_fraction"][failed] = np.nan
    columns["status"] = np.array(STATUS, dtype=object)[columns["status"].astype(np.int64)]
    return columns


def transits(
    parameters: np.ndarray,
    lengths: np.ndarray,
    longest: np.ndarray,
    *,
    begin: np.ndarray,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> dict[str, np.ndarray]:
    """Follow every part along tracks of several lengths, on each until it arrives or its longest time has passed.

    ValueError names the argument that cannot be used.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack
    lengths : of the tracks, m, ascending, shape (k,)
    longest : longest time on each track, s, ascending, shape (k,)
    begin : time (s), at most the first of `longest`, from which impacts and forces count on a single track, shape (n,)
    tolerance, threads, progress : as in `run`

    Returns
    -------
    dict of arrays: `arrival`, the time (s) at which a part has travelled each length for the first time, NaN if it is
    late, shape (n, k); `velocity` (m/s), of late parts what they have travelled over the longest time, shape (n, k);
    `impact_speed` (m/s) and `peak_force` (N), the largest ones from `begin` on, NaN for parts that arrive earlier,
    shape (n,); `status`, shape (n,): "ok", or why the run ended early. Numbers of failed runs are NaN.
    """
    lengths = check_array("lengths", lengths, np.finfo(np.float64).tiny, np.inf, "m")
    longest = check_array("longest", longest, np.finfo(np.float64).tiny, LONGEST, "s")
    if lengths.ndim != 1 or lengths.shape != longest.shape:
        raise ValueError(f"longest has the shape {longest.shape}, but lengths has the shape {lengths.shape}")
    for name, values in (("lengths", lengths), ("longest", longest)):
        if (np.diff(values) <= 0.0).any():
            raise ValueError(f"{name} must ascend")
    parameters, threads, tolerance = check_packed(parameters), check_threads(threads), check_tolerance(tolerance)
    begin = np.broadcast_to(check_array("begin", begin, 0.0, longest[0], "s", least=0), len(parameters))
    times = np.column_stack([begin, np.tile(longest, (len(parameters), 1))])
    arrival, travelled = np.empty((2, len(parameters), len(lengths)))
    peaks, codes = np.empty((len(parameters), 2)), np.empty(len(parameters), dtype=np.int64)

    def work(first, behind):
        rows = slice(first, behind)
        targets = {"distances": lengths, "arrivals": arrival[rows]}
        samples, results = trajectory.integrate(parameters[rows], times[rows], tolerance=tolerance, **targets)
        travelled[rows] = samples[:, 1:, X]
        peaks[rows] = results[:, [trajectory.IMPACT_SPEED, trajectory.PEAK_FORCE]]
        codes[rows] = results[:, trajectory.CODE]
        return np.count_nonzero(codes[rows] != trajectory.OK)

    for_each_chunk(work, len(parameters), threads=threads, chunk=64, progress=progress)
    arrival[arrival > longest] = np.nan
    velocity = np.where(np.isnan(arrival), travelled / longest, lengths / arrival)
    arrival[codes != trajectory.OK] = velocity[codes != trajectory.OK] = np.nan
    peaks[arrival[:, -1] <= begin] = np.nan
    impact_speed, peak_force = peaks.T
    status = np.array(STATUS, dtype=object)[codes]
    return {
        **{"arrival": arrival, "velocity": velocity, "status": status},
        **{"impact_speed": impact_speed, "peak_force": peak_force},
    }
