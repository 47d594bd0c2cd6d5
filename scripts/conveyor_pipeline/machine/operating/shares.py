"""Basin stability: the motions that random initial conditions lead to, with shares and velocities, over the amplitude.

The initial conditions are drawn independently from a box, so that the standard error of a share is binomial. Where the
regime changes, steps of the amplitude are halved.
"""

import math

import numpy as np
import pandas as pd

from conveyor import Columns, classify, restart, sample_runs, sweep, throw_number
from conveyor.elementary import cos, sin
from conveyor.packing import plate_peaks
from conveyor.parameters import LAST
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.labelling import join, search_options, shared_attractors
from conveyor_pipeline.common.steepness import steepness
from conveyor_pipeline.machine.operating import regimes
from conveyor_pipeline.machine.operating.parts import population
from conveyor_pipeline.machine.operating.populations import IDENTICAL

TABLES = {
    "shares": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("vertical", "1", "throw number Γ: largest acceleration of the plate normal to it, in g cos α"),
        fields.count("motion", "number of the motion at this amplitude, the fastest one first"),
        *fields.STATE,
        fields.number("longest_flight", "1", "longest flight, in excitation cycles; null for none"),
        fields.count("starts", "initial conditions that lead to the motion"),
        fields.number("share", "1", "share of all initial conditions that lead to the motion"),
        fields.number("stderr", "1", "standard error of the share"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity of the motion; null where it is not known"),
        fields.number("velocity_stderr", "m/s", "standard error of mean_velocity, from several trajectories"),
        fields.number("impact_speed", "m/s", "largest speed of approach at an impact; 0 for none, null if unknown"),
        fields.number("peak_force", "N", "largest contact force; null if unknown"),
        fields.text("status", "ok, or why there is no velocity"),
    ),
    "regimes": regimes.COLUMNS,
}

# Two motions of one state and period are different if their longest flights differ by more, in excitation cycles.
APART = 0.01
# Amplitudes besides those of the config, after which boundaries between regimes are not located further.
MOST_ADDED = 200
# A mean velocity counts as converged if a run twice as long agrees within this fraction of the plate's largest
# velocity.
SETTLED = 1e-3
NEGLIGIBLE = 1e-6  # of the plate's largest velocity; a smaller mean velocity is an error of the solver
RUNS = 6  # each twice as long as the one before
MOST_CYCLES = 4000  # upper limit of cycles of a brief run
FOLLOWED = 8  # initial conditions per attractor from which its mean velocity is computed
CYCLES = 250  # excitation cycles, at least, over which a mean velocity is computed
FORGOTTEN = 200  # excitation cycles, at least, for the transient of the feeding motion
TRIED = 32  # initial conditions of each amplitude that are followed until their motions are known, or to the limit
BRIEF = 0.05  # of the limit: cycles of the others where more would not help


def labels_of(parameters: np.ndarray, settings: dict, *, threads: int = 1, progress: str | None = None) -> Columns:
    """The labels of the initial conditions of some amplitudes, shape (m starts,).

    Where one of the first TRIED of an amplitude ends undecided, motions settle too slowly to be known in any case, so
    that the others are followed for the share BRIEF of the limit only, and end undecided if they have not converged.
    Where some of the first TRIED end at the limit as regular motions of a long period or chaos, and none converges
    between this share and the limit, more cycles would not help the others; Lyapunov exponents label them then.
    """
    options = {"threads": threads, "progress": progress}
    known = shared_attractors(parameters, settings["starts"], settings, **options)
    limit = settings["settling"]
    options = {**search_options(settings), "attractors": known, **options}
    cycles = math.ceil(BRIEF * limit)
    brief = {**options, "cycles": cycles}
    amplitude, start = np.divmod(np.arange(len(parameters)), settings["starts"])
    first = start < TRIED
    tried = classify(parameters[first], **options)

    def others_where(chosen: np.ndarray) -> np.ndarray:
        """The others of the amplitudes of some of those that were tried."""
        return ~first & np.isin(amplitude, amplitude[first][chosen])

    undecided = others_where(tried.state == "undecided")
    endless = others_where(tried.cycles >= limit) & ~undecided
    endless &= ~others_where((tried.cycles > cycles) & (tried.cycles < limit))
    rows = [first, ~(first | undecided | endless), endless, undecided]
    how = [options, brief, brief | {"exponents": False}]
    parts = [classify(parameters[some], **run_options) for some, run_options in zip(rows[1:], how, strict=True)]
    return join([tried, *parts], [np.flatnonzero(some) for some in rows])


def groups(labels: Columns, conveyor: np.ndarray) -> np.ndarray:
    """The number of the motion that each label belongs to, int64, shape (n,); it ascends with the conveyor.

    Labels of one motion have one conveyor, one state and one period, and their longest flights are neighbours.

    conveyor : number of the conveyor of each label, shape (n,)
    """
    flights = np.nan_to_num(labels.longest_flight, nan=-1.0)
    order = np.lexsort((flights, labels.period, labels.state, conveyor))
    is_same = np.diff(flights[order]) <= APART
    for column in (conveyor, labels.state, labels.period):
        is_same &= column[order][1:] == column[order][:-1]
    number = np.empty(len(order), dtype=np.int64)
    number[order] = np.concatenate([[0], np.cumsum(~is_same)])
    return number


def continue_normal(rows: np.ndarray, cycles: np.ndarray, settings: dict, *, threads: int = 1) -> np.ndarray:
    """Parameters, shape (n,), that continue the motion normal to the track after some excitation cycles.

    rows : parameters of trajectories, shape (n,)
    cycles : of each trajectory, shape (n,)
    """
    durations = cycles / rows["frequency"]
    ends = sweep(rows, duration=durations, tolerance=settings["tolerance"], needs="vertical", threads=threads)
    return restart(rows, ends["z_end"], ends["vz_end"], durations)


def last_quarters(
    parameters: np.ndarray, durations: np.ndarray, tolerance: float, threads: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean feeding velocities (m/s) over the last quarters of runs, shape (n, k), and, for the last quarter of the
    longest run, the largest speed of approach (m/s) and contact force (N), shape (n, 2), and the status.

    durations : s, shape (n, k); the last quarter of each run begins after the end of the run before
    """
    times = np.stack([(1.0 - LAST) * durations, durations], axis=-1).reshape(len(durations), 2 * durations.shape[1])
    runs = sample_runs(parameters, times, columns=["x"], tolerance=tolerance, threads=threads, chunk=4)
    means = (runs.x[:, 1::2] - runs.x[:, ::2]) / (LAST * durations)
    return means, np.column_stack([runs.impact_speed, runs.peak_force]), runs.status


def velocities(
    parameters: np.ndarray, labels: Columns, settings: dict, *, threads: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean feeding velocity (m/s) of settled trajectories, shape (n,); the largest speed of approach (m/s) and contact
    force (N) over the same cycles, whole periods of the motion, shape (n, 2); and the status.

    Each trajectory is followed until it has settled, and then twice as long, until both mean velocities agree. They
    never agree in chaos, where the mean is taken over the longer run. On a track that is too steep for sliding friction
    they must agree in chaos, too, because the part may be about to slide away. A velocity that has not converged in the
    last of RUNS runs is not known.

    parameters, labels : shape (n,), and the labels of the trajectories
    """
    n, period = len(parameters), labels.period
    # A motion without a period is not more settled in later cycles.
    settled = np.where(period > 0, labels.cycles, np.minimum(labels.cycles, CYCLES))
    velocity, status = np.full(n, np.nan), np.full(n, regimes.UNSETTLED, dtype=object)
    peaks = np.full((n, 2), np.nan)
    plate = plate_peaks(parameters).vx
    # A mean over whole periods; the last quarter of a run is what a mean is taken over.
    step = np.maximum(period, 1)
    quarter = np.maximum(np.maximum(CYCLES, np.ceil((settled + FORGOTTEN) / 3.0)), step)
    steep = steepness(parameters)
    status[steep == 2] = regimes.SLIDES_AWAY
    open_ = np.flatnonzero(steep < 2)
    # Every trajectory needs the second run, which contains the first; one integration gives both.
    for doublings in ([0, 1], *([doubling] for doubling in range(2, RUNS))):
        cycles = 4.0 * step[open_, None] * np.ceil(2.0 ** np.array(doublings) * (quarter / step)[open_, None])
        durations = cycles / parameters["frequency"][open_, None]
        means, peaks[open_], why = last_quarters(parameters[open_], durations, settings["tolerance"], threads)
        failed = why != "ok"
        status[open_[failed]] = why[failed]
        for mean in means.T:
            close = np.abs(mean - velocity[open_]) <= SETTLED * plate[open_]
            velocity[open_] = mean
        # A part that does not settle, and is faster than the plate ever is, does not stick again.
        away = ~failed & ~close & (steep[open_] == 1) & (np.abs(velocity[open_]) > plate[open_])
        status[open_[away]] = regimes.SLIDES_AWAY
        known = ~failed & (close | ((period[open_] == 0) & (steep[open_] == 0)))
        status[open_[known]] = "ok"
        open_ = open_[~failed & ~away & ~known]
    velocity[np.abs(velocity) <= NEGLIGIBLE * plate] = 0.0
    velocity[status != "ok"] = peaks[status != "ok"] = np.nan
    return velocity, peaks, status


def brief_durations(parameters: np.ndarray, period: np.ndarray, cycles: int) -> np.ndarray:
    """Durations (s) of runs whose last quarter has the mean velocity of settled normal motions, shape (n,).

    The last quarter contains whole periods. In the three quarters before it, friction must be able to accelerate the
    part to the velocity of the plate. The mean acceleration that remains for this is g (μ cos α - |sin α|), so tracks
    that are nearly too steep need more than `cycles`.

    parameters, period : shape (n,), and the period in excitation cycles, 0 for none, shape (n,)
    cycles : least excitation cycles of a run
    """
    alpha, friction = parameters["inclination"], parameters["friction"]
    remaining = parameters["gravity"] * (friction * cos(alpha) - np.abs(sin(alpha)))
    along = parameters["acceleration"] * cos(parameters["angle"])
    # Friction that cannot hold a sliding part does not slow it down however long the run is.
    needed = np.where(remaining > 0.0, along / (2.0 * math.pi * 0.75 * np.maximum(remaining, 1e-300)), 0.0)
    step = 4.0 * np.maximum(period, 1)
    return step * np.ceil(np.maximum(cycles, np.minimum(needed, MOST_CYCLES)) / step) / parameters["frequency"]


def shares_at(
    amplitudes: np.ndarray,
    settings: dict,
    *,
    followed: int = FOLLOWED,
    threads: int = 1,
    progress: str | None = None,
) -> pd.DataFrame:
    """The table for some amplitudes (m/s²), ascending, shape (m,).

    followed : initial conditions per attractor from which its mean velocity is computed
    """
    starts = settings["starts"]
    parameters = population(amplitudes, settings, IDENTICAL)
    labels = labels_of(parameters, settings, threads=threads, progress=progress)
    number = groups(labels, np.arange(len(parameters)) // starts)
    _, first, count = np.unique(number, return_index=True, return_counts=True)
    # The trajectories of each motion that have settled first are followed further.
    limits = np.where(labels.state[first] == "undecided", 0, followed)
    order = np.lexsort((labels.cycles, number))
    rank = np.arange(len(order)) - np.repeat(np.cumsum(count) - count, count)
    chosen = order[rank < np.repeat(limits, count)]
    of_chosen = labels.select(chosen)
    each_velocity, each_peaks, each_status = velocities(parameters[chosen], of_chosen, settings, threads=threads)
    velocity, error, peaks = np.full(len(first), np.nan), np.full(len(first), np.nan), np.full((len(first), 2), np.nan)
    status = np.where(limits > 0, "ok", regimes.UNDECIDED).astype(object)
    for row, members in enumerate(np.split(np.arange(len(chosen)), np.cumsum(np.minimum(count, limits))[:-1])):
        failed = each_status[members] != "ok"
        if failed.any():
            status[row] = each_status[members][failed][0]
        elif len(members):
            velocity[row], peaks[row] = each_velocity[members].mean(), each_peaks[members].max(axis=0)
            error[row] = each_velocity[members].std(ddof=1) / math.sqrt(len(members)) if len(members) > 1 else np.nan
    share = count / starts
    acceleration = parameters["acceleration"][first]
    table = pd.DataFrame(
        {
            "acceleration": acceleration,
            "vertical": throw_number(acceleration, **settings["model"]),
            "state": labels.state[first],
            "period": labels.period[first],
            "longest_flight": labels.longest_flight[first],
            "starts": count,
            "share": share,
            "stderr": np.sqrt(share * (1.0 - share) / starts),
            "mean_velocity": velocity,
            "velocity_stderr": error,
            "impact_speed": peaks[:, 0],
            "peak_force": peaks[:, 1],
            "status": status,
        }
    )
    order = {"by": ["acceleration", "mean_velocity", "starts"], "ascending": [True, False, False]}
    table = table.sort_values(**order, ignore_index=True)
    return table.assign(motion=table.groupby("acceleration").cumcount() + 1)


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, pd.DataFrame]:
    """The tables of shares and of regimes for the settings of the config."""
    amplitudes = np.unique(grid.axis_values("acceleration", settings["acceleration"]))
    table = shares_at(amplitudes, settings, threads=threads, progress=progress)
    while True:
        summary = regimes.summarize_amplitudes(table)
        places, regime = summary.acceleration.to_numpy(), summary.regime.to_numpy()
        wide = (regime[1:] != regime[:-1]) & (np.diff(places) > settings["resolution"] * places[1:])
        if not wide.any() or len(places) >= len(amplitudes) + MOST_ADDED:
            return {"shares": table, "regimes": regimes.intervals_of(summary, table)}
        between = 0.5 * (places[1:] + places[:-1])[wide]
        label = progress and f"{progress}, amplitudes between: {len(between)}"
        new = shares_at(between, settings, threads=threads, progress=label)
        table = pd.concat([table, new]).sort_values(["acceleration", "motion"], ignore_index=True)
