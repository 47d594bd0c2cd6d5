"""Accuracy of the paper's estimates of Lyapunov exponents (finite differences) and dimensions (box counting)."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from conveyor_pipeline.figures import style

CASES = {
    "orbit_phase": "orbit, perturbed phase:\nexponent of $\\dot{x}_p$ in 1/s",
    "orbit_height": "orbit, perturbed height:\nexponent of $z_p$ in 1/s",
    "chaos_phase": "chaos, perturbed phase:\nexponent of $\\dot{x}_p$ in 1/s",
}
VARIED = {
    "perturbation": ("epsilon", "perturbation in rad"),
    "time": ("duration", "duration in s"),
    "step": ("step", "time step of Euler in s"),
}
METHODS = {"euler": ("Euler", style.EULER), "event": ("this solver", style.CONVERGED)}
ESTIMATORS = {
    "boxes, as in the paper": ("box counting as in the paper", style.EULER, "s"),
    "boxes": ("box counting, averaged and extrapolated", style.CONVERGED, "o"),
    "correlation sum": ("correlation sum", style.SECOND_ESTIMATE, "^"),
}
NAMES = {"cantor": "Cantor", "sierpinski": "Sierpinski"}
TRUTH = {"color": "black", "linewidth": 0.8, "linestyle": (0, (4, 2))}
BOUND = {"color": "0.6", "linewidth": 0.8, "linestyle": ":"}


def draw_exponents(axes: Axes, rows: pd.DataFrame, panel: str) -> None:
    """Draw estimates over one quantity, the true value, and the estimate at which the separation saturates."""
    column, label = VARIED[panel]
    for method, (_, colour) in METHODS.items():
        line = rows[rows.estimator == method]
        axes.plot(line[column], line.value, ".-", color=colour)
    low, high = rows.value.min(), rows.value.max()
    line = rows[rows.estimator == "event"]
    axes.plot(line[column], line.bound, **BOUND)
    axes.axhline(rows.truth.iloc[0], **TRUTH)
    room = 0.15 * (high - low)
    axes.set_ylim(min(low, rows.truth.iloc[0]) - room, max(high, rows.truth.iloc[0]) + room)
    axes.set_xscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())  # labels of a short axis would overlap
    axes.set_xlabel(label)


def draw_dimensions(axes: Axes, rows: pd.DataFrame, column: str, label: str) -> None:
    """Draw estimates with their 95 % intervals over one quantity, a line for each case and estimator."""
    for (case, estimator), line in rows.groupby(["case", "estimator"], sort=False):
        _, colour, marker = ESTIMATORS[estimator]
        look = {"color": colour, "markersize": 2.5, "linewidth": 0.7, "elinewidth": 0.5}
        axes.errorbar(line[column], line.value, line.error, marker=marker, **look)
        if estimator == "boxes, as in the paper":
            last = line.iloc[-1]
            side = "top" if last.value < last.truth else "bottom"  # beside the line of the true value
            style.note(axes, NAMES.get(case, case), (last[column], last.value), (4, 0), va=side)
    for truth in rows.truth.dropna().unique():
        axes.axhline(truth, **TRUTH)
    axes.set_ylim(0.4, 2.4)
    axes.set_xscale("log")
    axes.xaxis.set_minor_formatter(NullFormatter())  # labels of a short axis would overlap
    smallest, largest = rows[column].min(), rows[column].max()
    axes.set_xlim(right=largest * (largest / smallest) ** 0.38)  # room for the names
    axes.set_xlabel(label)


def plot(*, estimates: pd.DataFrame) -> Figure:
    """Draw estimates over perturbation, duration and time step."""
    figure = style.figure(style.PAGE, 200.0)
    above, below = figure.subfigures(2, 1, height_ratios=[2.7, 1.0])
    panels = above.subplots(len(CASES), len(VARIED))
    for row, (case, label) in zip(panels, CASES.items(), strict=True):
        for axes, panel in zip(row, VARIED, strict=True):
            draw_exponents(axes, estimates[(estimates.panel == panel) & (estimates.case == case)], panel)
        row[0].set_ylabel(label)
        for axes in row[1:]:
            axes.set_ylabel("exponent in 1/s")
    panels[1, 0].set_xlabel("perturbation in m")
    handles = [Line2D([], [], marker=".", color=colour, label=name) for name, colour in METHODS.values()]
    handles.append(Line2D([], [], **TRUTH, label="true value"))
    handles.append(Line2D([], [], **BOUND, label="separation as large as the signal"))
    above.legend(handles=handles, loc="outside upper center", ncols=4)

    sets, samples, time = below.subplots(1, 3, sharey=True)
    draw_dimensions(sets, estimates[estimates.panel == "known set"], "samples", "points of a set of known dimension")
    draw_dimensions(samples, estimates[estimates.panel == "samples"], "samples", "points of a settled phase portrait")
    draw_dimensions(time, estimates[estimates.panel == "run time"], "duration", "duration of an Euler run in s")
    sets.set_ylabel("dimension")
    handles = [Line2D([], [], marker=marker, color=colour, label=name) for name, colour, marker in ESTIMATORS.values()]
    handles.append(Line2D([], [], **TRUTH, label="true value"))
    below.legend(handles=handles, loc="outside upper center", ncols=4)
    return figure
