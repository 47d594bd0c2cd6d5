"""Many trajectories: one row per point, in the order of the points, also where a run fails."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from . import arguments
from .columns import Columns
from .methods import fixed_step
from .packing import check_column, check_rows, copy_table
from .parallel import for_each_chunk
from .parameters import LAST, RANGES, UNITS
from .simulation import DEFAULT_STEP, DEFAULT_TOLERANCE, check_run, follow_by_events, name_results
from .solver import record, trajectory
from .solver.arrivals import CYCLES, EVERY_CYCLE, ON_TRACK, SHARE
from .solver.model import Conveyor
from .solver.record import SAMPLES, X
from .solver.status import NOT_FINITE, OK, STATUS

NEEDS = ("feeding", "vertical")
HORIZONTAL = ("mean_velocity", "x_end", "vx_end")
COLUMNS = (
    *("mean_velocity", "z_end", "vz_end", "x_end", "vx_end", "max_gap", "impacts", "contact_fraction"),
    *("impact_speed", "peak_force"),
)


def sweep(
    parameters: Conveyor | np.ndarray,
    *,
    duration: ArrayLike = 1.0,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    needs: str = "feeding",
    threads: int = 1,
    chunk: int = 4096,
    progress: str | None = None,
) -> Columns:
    """Follow a part for each row of a table of parameters.

    Parameters
    ----------
    parameters : from `parameter_table`, of any shape s
    duration, method, tolerance, step : as in `simulate`; the event-driven method also takes durations of the shape s
    needs : "feeding"; or "vertical" for NaN in the columns of the horizontal motion, which saves time with the
        event-driven method
    threads, chunk : number of threads, and rows that a thread takes at a time; the result does not depend on them
    progress : label of a progress bar on stderr, or None

    Returns
    -------
    columns of the shape s: mean_velocity (m/s, over the last quarter), z_end, vz_end, x_end, vx_end (m, m/s),
    max_gap (m), impacts (int64), contact_fraction (1), impact_speed (m/s) and peak_force (N), the largest speed of
    approach at an impact and the largest contact force over the last quarter (0 if there is none), and status (str;
    "ok", or why the run ended early: impacts are then those up to its end, all other numbers NaN)

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), acceleration=np.array([20.0, 40.0])[:, None], z0=[0.0, 3e-4])
    >>> runs = sweep(parameters, duration=0.5)
    >>> runs.status.tolist()
    [['ok', 'ok'], ['ok', 'ok']]
    >>> bool(runs.mean_velocity[1, 1] > runs.mean_velocity[1, 0])  # at 40 m/s² a part that jumps is faster
    True
    """
    arguments.check_choice("needs", needs, NEEDS)
    threads = arguments.check_threads(threads)
    arguments.check_count("chunk", chunk, 1, 10**9)
    rows, shape = check_rows(parameters)
    shortest = np.finfo(np.float64).tiny
    durations = check_column("duration", duration, shape, shortest, arguments.LONGEST, unit="s").flatten()
    _, tolerance, step = check_run(durations.max(initial=shortest), method, tolerance, step)
    if method != "event" and np.ndim(duration) > 0:
        raise ValueError("duration: only the event-driven method takes one for each row")
    feeding = needs == "feeding"
    columns = {name: np.empty(len(rows)) for name in (*COLUMNS, "status")}

    def work(begin, end):
        part = slice(begin, end)
        if method == "event":
            samples, results = follow_by_events(rows[part], durations[part], tolerance, feeding)
            before, after = samples.transpose(1, 2, 0)
            some = name_results(before, after, results.T, durations[part])
            some["mean_velocity"] = (after[X] - before[X]) / (LAST * durations[part])
        else:
            some = fixed_step.run(rows[part], float(durations[begin]), step, method)
        for name in columns:
            columns[name][part] = some[name] if feeding or name not in HORIZONTAL else np.nan
        return np.count_nonzero(columns["status"][part] != OK)

    for_each_chunk(work, len(rows), threads=threads, chunk=chunk, progress=progress)
    columns["impacts"] = columns["impacts"].astype(np.int64)
    failed = columns["status"] != OK
    columns["max_gap"][failed] = columns["contact_fraction"][failed] = np.nan
    columns["status"] = np.array(STATUS, dtype=object)[columns["status"].astype(np.int64)]
    return Columns({name: column.reshape(shape) for name, column in columns.items()})


def sample_runs(
    parameters: Conveyor | np.ndarray,
    times: ArrayLike,
    *,
    columns: Sequence[str] = SAMPLES,
    vx0: ArrayLike = 0.0,
    method: str = "event",
    tolerance: float = DEFAULT_TOLERANCE,
    step: float = DEFAULT_STEP,
    reuse: bool = True,
    skip: bool = False,
    threads: int = 1,
    chunk: int = 64,
    progress: str | None = None,
) -> Columns:
    """Follow a part for each row of a table of parameters, and sample its motion at times of its own.

    Parameters
    ----------
    parameters : from `parameter_table`, shape (n,)
    times : s, ascending, shape (n, k)
    columns : the wanted samples, among x, z (m), vx, vz (m/s), contact_force, friction_force (N);
        without x, vx and friction_force the horizontal motion is not followed
    vx0 : m/s, velocity along the track at t = 0, a number or of the shape (n,); NaN continues a failed run. The
        methods with a fixed step begin at rest
    method, tolerance, step, reuse : as in `simulate`
    skip : whether the event-driven method skips cycles between two samples in which the motion repeats itself
    threads, chunk, progress : as in `sweep`

    Returns
    -------
    the `columns`, shape (n, k), NaN after the point where a run ended early; and of the shape (n,) impact_speed (m/s)
    and peak_force (N), the largest ones between the last two times, NaN for the methods with a fixed step, and status,
    "ok" or why the run ended early

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), z0=[0.0, 3e-4])
    >>> sample_runs(parameters, np.array([[0.0, 0.5], [0.0, 0.7]]), columns=["x"]).x.shape
    (2, 2)
    """
    rows, _ = check_rows(parameters)
    times = arguments.check_array("times", times, 0.0, arguments.LONGEST, "s", least=0)
    if times.ndim != 2 or len(times) != len(rows):
        raise ValueError(f"times must have the shape ({len(rows)}, k), as parameters, got {times.shape}")
    if (np.diff(times) < 0.0).any():
        raise ValueError("times must ascend in each row")
    if not isinstance(columns, (list, tuple)):
        raise TypeError(f"columns = {columns!r} must be a list of some of {', '.join(SAMPLES)}")
    for name in columns:
        arguments.check_choice("columns", name, SAMPLES)
    _, tolerance, step = check_run(times.max(initial=np.finfo(np.float64).tiny), method, tolerance, step)
    arguments.check_flag("reuse", reuse)
    arguments.check_flag("skip", skip)
    threads = arguments.check_threads(threads)
    arguments.check_count("chunk", chunk, 1, 10**9)
    vx0 = check_column("vx0", vx0, rows.shape[:1], *RANGES["vz0"], may_be_nan=True, unit="m/s").copy()
    if method != "event" and vx0.any():
        raise ValueError(f"vx0: the method {method} begins at rest; use the method event")
    samples = {name: np.empty(times.shape) for name in columns}
    peaks, codes = np.full((2, len(rows)), np.nan), np.zeros(len(rows), np.int64)
    feeding = not {"x", "vx", "friction_force"}.isdisjoint(columns)

    def work(begin, end):
        part = slice(begin, end)
        if method != "event":
            # Together, trajectories with equal times take less time. Of 200,000 times, np.unique would take a second.
            alike = {}
            for row in range(begin, end):
                alike.setdefault(times[row].tobytes(), []).append(row)
            for together in alike.values():
                found = fixed_step.sample(rows[together], times[together[0]], step, method)
                for name in columns:
                    samples[name][together] = found[name]
            return
        motion, results = trajectory.integrate(
            rows[part],
            times[part],
            tolerance=tolerance,
            feeding=feeding,
            reuse=reuse,
            vx0=vx0[part],
            repetition=(CYCLES, SHARE * tolerance) if skip else EVERY_CYCLE,
        )
        for name, values in samples.items():
            values[part] = motion[:, :, SAMPLES.index(name)]
        peaks[:, part] = results[:, [record.IMPACT_SPEED, record.PEAK_FORCE]].T
        codes[part] = results[:, record.CODE]

    for_each_chunk(work, len(rows), threads=threads, chunk=chunk, progress=progress)
    impact_speed, peak_force = peaks
    failed = np.isnan(vx0)
    codes[failed & (codes == OK)] = NOT_FINITE
    for values in samples.values():
        values[failed] = np.nan
    status = np.array(STATUS, dtype=object)[codes]
    return Columns(samples | {"impact_speed": impact_speed, "peak_force": peak_force, "status": status})


def restart(parameters: Conveyor | np.ndarray, z_end: ArrayLike, vz_end: ArrayLike, duration: ArrayLike) -> np.ndarray:
    """The table of trajectories that continue runs of `parameters`.

    z_end, vz_end : where the runs ended, m and m/s, in the shape of `parameters`; NaN for a run that failed
    duration : of the runs, s, a number or an array

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), z0=[0.0, 3e-4])
    >>> runs = sweep(parameters, duration=0.5)
    >>> restart(parameters, runs.z_end, runs.vz_end, 0.5)["psi0"].tolist()  # after 25 cycles
    [0.0, 0.0]
    """
    later = copy_table(parameters)
    cycles = later["frequency"] * check_column("duration", duration, later.shape, 0.0, arguments.LONGEST, unit="s")
    later["psi0"] = (later["psi0"] + 2.0 * math.pi * (cycles - np.floor(cycles))) % (2.0 * math.pi)
    for name, of_end, ends in (("z0", "z_end", z_end), ("vz0", "vz_end", vz_end)):
        unit = UNITS[name]
        later[name] = check_column(of_end, ends, later.shape, *arguments.PACKED[name], may_be_nan=True, unit=unit)
    return later


def transits(
    parameters: Conveyor | np.ndarray,
    lengths: ArrayLike,
    longest: ArrayLike,
    *,
    begin: ArrayLike,
    tolerance: float = DEFAULT_TOLERANCE,
    threads: int = 1,
    progress: str | None = None,
) -> Columns:
    """Follow every part along tracks of several lengths, on each until it arrives or its longest time has passed.

    Parameters
    ----------
    parameters : from `parameter_table`, shape (n,)
    lengths : of the tracks, m, ascending, shape (k,)
    longest : longest time on each track, s, ascending, shape (k,)
    begin : time (s) from which impacts and forces count, at most the first of `longest`, a number or of shape (n,)
    tolerance, threads, progress : as in `sweep`

    Returns
    -------
    columns `arrival`, the time (s) at which a part has travelled each length for the first time, NaN if it is
    late, shape (n, k); `velocity` (m/s), for late parts their distance over the longest time, shape (n, k);
    `impact_speed` (m/s) and `peak_force` (N), the largest ones from `begin` on, NaN for parts that arrive earlier,
    shape (n,); `status`, shape (n,): "ok", or why the run ended early. Numbers of failed runs are NaN.

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), z0=[0.0, 3e-4])
    >>> transits(parameters, np.array([0.02]), np.array([1.0]), begin=np.array(0.2)).arrival[:, 0].round(1)  # s
    array([nan, 0.3])
    """
    lengths = arguments.check_array("lengths", lengths, np.finfo(np.float64).tiny, np.inf, "m")
    longest = arguments.check_array("longest", longest, np.finfo(np.float64).tiny, arguments.LONGEST, "s")
    if lengths.ndim != 1:
        raise ValueError(f"lengths must have the shape (k,), got {lengths.shape}")
    if longest.shape != lengths.shape:
        raise ValueError(f"longest has the shape {longest.shape}, but lengths has the shape {lengths.shape}")
    for name, values in (("lengths", lengths), ("longest", longest)):
        if (np.diff(values) <= 0.0).any():
            raise ValueError(f"{name} must ascend")
    parameters, _ = check_rows(parameters)
    threads, tolerance = arguments.check_threads(threads), arguments.check_tolerance(tolerance)
    begin = check_column("begin", begin, parameters.shape[:1], 0.0, longest[0], unit="s").copy()
    times = np.column_stack([begin, np.tile(longest, (len(parameters), 1))])
    arrival, travelled = np.empty((2, len(parameters), len(lengths)))
    peaks, codes = np.empty((len(parameters), 2)), np.empty(len(parameters), dtype=np.int64)

    def work(first, behind):
        rows = slice(first, behind)
        targets = {"distances": lengths, "arrivals": arrival[rows], "since": begin[rows], "repetition": ON_TRACK}
        samples, results = trajectory.integrate(parameters[rows], times[rows], tolerance=tolerance, **targets)
        travelled[rows] = samples[:, 1:, X]
        peaks[rows] = results[:, [record.IMPACT_SPEED, record.PEAK_FORCE]]
        codes[rows] = results[:, record.CODE]
        return np.count_nonzero(codes[rows] != OK)

    for_each_chunk(work, len(parameters), threads=threads, chunk=64, progress=progress)
    arrival[arrival > longest] = np.nan
    velocity = np.where(np.isnan(arrival), travelled / longest, lengths / arrival)
    arrival[codes != OK] = velocity[codes != OK] = np.nan
    peaks[arrival[:, -1] <= begin] = np.nan
    impact_speed, peak_force = peaks.T
    status = np.array(STATUS, dtype=object)[codes]
    columns = {"arrival": arrival, "velocity": velocity, "status": status}
    return Columns(columns | {"impact_speed": impact_speed, "peak_force": peak_force})
