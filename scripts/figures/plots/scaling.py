"""Cost of sweeps: time per point, points per second and memory of jobs, over points, threads and shards."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from figures import style

MAPS, CONVEYORS, GATHERING = "#0072B2", "#D55E00", "#CC79A7"
MICROSECONDS = 1e6
WITH_STARTUP = {"points": "including the start of the job", "conveyors": None}  # one legend entry for both


def costs(rows: pd.DataFrame) -> tuple[pd.Series, pd.Series]:
    """Wall time of jobs per point (µs), without and with the time in which they start."""
    return tuple(MICROSECONDS * seconds / rows.computed for seconds in (rows.computing_seconds, rows.shard_seconds))


def draw_over_points(left: Axes, right: Axes, table: pd.DataFrame) -> None:
    """Draw the cost of a point and the memory of jobs over the points of a sweep."""
    for varied, colour, name in (
        ("points", MAPS, "initial conditions of one conveyor"),
        ("conveyors", CONVEYORS, "conveyors, one initial condition each"),
    ):
        rows = table[table.varied == varied].sort_values("points")
        computing, whole = costs(rows)
        left.plot(rows.points, computing, "o-", color=colour, label=name)
        left.plot(rows.points, whole, "o:", color=colour, markerfacecolor="white", label=WITH_STARTUP[varied])
        right.plot(rows.points, rows.shard_memory, "o-", color=colour)
        if varied == "points":
            right.plot(rows.points, rows.gathering_memory, "s--", color=GATHERING, label="job that joins the shards")
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_xlabel("points of a sweep")
    left.set_yscale("log")
    left.set_ylim(bottom=0.5 * min(np.min(line.get_ydata()) for line in left.lines))
    left.set_ylabel("wall time of a job\nper point in µs")
    right.set_ylim(0.0, 1.1 * max(np.max(line.get_ydata()) for line in right.lines))
    right.set_ylabel("peak memory of a job in MB")


def draw_over_counts(axes: Axes, rows: pd.DataFrame, varied: str, rates: pd.Series) -> None:
    """Draw rates over the number of threads or shards, the column `varied`; over threads with ideal scaling."""
    counts, rates = rows[varied].to_numpy(), rates.to_numpy()
    axes.plot(counts, rates, "o-", color=MAPS)
    if varied == "threads":
        axes.plot(counts, rates[0] * counts / counts[0], color="black", linewidth=0.6, linestyle=":")
        style.note(axes, "ideal scaling", (counts[-1], rates[0] * counts[-1] / counts[0]), ha="right", va="bottom")
    else:
        axes.set_xscale("log")
    axes.set_xticks(counts, [f"{count}" for count in counts])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.minorticks_off()
    axes.set_ylim(0.0, 1.1 * max(np.max(line.get_ydata()) for line in axes.lines))


def plot(*, scaling: pd.DataFrame) -> Figure:
    """Draw the costs of sweeps."""
    figure = style.figure(style.PAGE, 112.0)
    (left, right), (threads, shards) = figure.subplots(2, 2)
    draw_over_points(left, right, scaling)
    rows = scaling[scaling.varied == "threads"].sort_values("threads")
    draw_over_counts(threads, rows, "threads", rows.computed / rows.computing_seconds)
    threads.set_xlabel("threads of a job")
    threads.set_ylabel("points per second of a job,\nwithout its start")
    rows = scaling[scaling.varied == "shards"].sort_values("shards")
    draw_over_counts(shards, rows, "shards", rows.computed / rows.shard_seconds)
    shards.set_xlabel("shards of a sweep")
    shards.set_ylabel("points per second,\njobs one after another")
    handles = [handle for axes in (left, right) for handle in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside upper center", ncols=4)
    return figure
