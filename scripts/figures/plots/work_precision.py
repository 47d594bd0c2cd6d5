"""Error over work: all methods in three scenes, with their failures, and estimates of exponent, dimension and fit."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from figures import style

# Marker and line of each treatment.
TREATMENTS = {
    "exact": ("o", "-", None),
    "exact, nothing repeated": ("o", "-.", "this solver, no step reused"),
    "fixed step": (".", "-", None),
    "sign": ("x", ":", "sign() friction"),
    "events": ("^", "--", "events, naive restart"),
    "modes": ("s", "-", "events and contact modes"),
}
FAILURES = {
    "gave up": "T",
    "stuck at an event": "R",
    "step too small": "S",
    "event lost": "E",
    "not finite": "N",
    "wrong state": "W",
    "through the plate": "P",
}
MEANINGS = (
    "T: evaluation limit reached · W: wrong state of motion · P: fell through the plate, reported success\n"
    "R: repeats the same event endlessly · S: step too small · E: event missed · N: not finite"
)
MISSING = "not installed"
# Columns of work and error, and their labels.
PANELS = (
    ("milliseconds", "velocity_error", "processor time in ms", "mean velocity"),
    ("evaluations", "velocity_error", "force evaluations", "mean velocity"),
    ("milliseconds", "state_error", "processor time in ms", "final state"),
    ("evaluations", "state_error", "force evaluations", "final state"),
)
# Failures are drawn in a band above this error, with a line for each method and treatment.
FAILED = 3.0
BAND_ENDS = 1e10

QUANTITIES = {
    "exponent": ("simulated cycles", "relative error of $\\lambda_1$"),
    "dimension": ("points", "error of the dimension"),
    "fit": ("evaluations", "relative gap to the best fit"),
}


def draw_curve(axes: Axes, rows: pd.DataFrame, x: str, y: str) -> None:
    """Draw the successful runs of one method."""
    method, treatment = rows.method.iloc[0], rows.treatment.iloc[0]
    colour, _ = style.METHODS[method]
    marker, line, _ = TREATMENTS[treatment]
    good = rows[rows.outcome == "ok"]
    ours = method == "event"
    axes.plot(
        good[x],
        good[y].clip(lower=1e-16),
        marker=marker,
        linestyle=line,
        color=colour,
        markersize=3.0 if ours else 2.2,
        markeredgewidth=0.6,
        linewidth=1.4 if treatment == "exact" else 0.6,
        markerfacecolor=colour if treatment in ("exact", "fixed step") else "none",
        zorder=3 if ours else 2,
    )


def draw_failures(axes: Axes, table: pd.DataFrame, x: str) -> None:
    """Draw the failures of a scene in the band: for each kind a line over its work, with its letter at the right."""
    kinds = table[table.outcome.isin(FAILURES)].groupby(["method", "treatment", "outcome"], sort=False)
    lines = np.geomspace(BAND_ENDS, FAILED, kinds.ngroups + 2)[1:-1]
    for line, ((method, _, outcome), failed) in zip(lines, kinds, strict=True):
        colour, _ = style.METHODS[method]
        least, most = failed[x].min(), failed[x].max()
        axes.plot([least, most], [line] * 2, color=colour, linewidth=0.8, marker="|", markersize=2.5)
        style.note(axes, FAILURES[outcome], (most, line), (3.0, 0.0), color=colour, va="center", annotation_clip=False)


def draw_panel(axes: Axes, table: pd.DataFrame, x: str, y: str, paper_step: float) -> None:
    """Draw the error `y` over the work `x` of all methods in one scene."""
    for _, rows in table.groupby(["method", "treatment"], sort=False):
        draw_curve(axes, rows, x, y)
    paper = table[(table.method == "euler") & np.isclose(table.step, paper_step)]
    axes.plot(paper[x], paper[y], "o", markersize=7.0, markerfacecolor="none", color=style.EULER)
    draw_failures(axes, table, x)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(1e-15, BAND_ENDS)
    axes.set_yticks([1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0])
    axes.axhspan(FAILED, BAND_ENDS, color="0.95", linewidth=0.0)
    axes.minorticks_off()
    axes.grid(linewidth=0.3, color="0.9")


def legend_handles(scenes: list[pd.DataFrame]) -> list[Line2D]:
    """Legend handles of the methods that ran (a peer may not be installed) and of the treatments of events."""
    everything = pd.concat(scenes)
    ran = set(everything[everything.outcome != MISSING].method)
    known = [
        Line2D([], [], color=colour, linewidth=1.4, label=name)
        for method, (colour, name) in style.METHODS.items()
        if method in ran
    ]
    treated = [
        Line2D([], [], color="0.3", marker=marker, linestyle=line, linewidth=0.6, markerfacecolor="none", label=label)
        for marker, line, label in TREATMENTS.values()
        if label
    ]
    paper = Line2D([], [], color=style.EULER, marker="o", linestyle="", markersize=6.0, markerfacecolor="none")
    paper.set_label("published time step")
    return [*known, *treated, paper]


def missing_note(scenes: list[pd.DataFrame]) -> str:
    """A line that names the peers that are not installed; empty if all are."""
    everything = pd.concat(scenes)
    missing = dict.fromkeys(everything[everything.outcome == MISSING].method)
    return f"\nnot installed, so not shown: {', '.join(missing)}" if missing else ""


def draw_estimates(axes: Axes, rows: pd.DataFrame, work: str, error: str) -> None:
    """Draw the error of the estimates of one quantity over their work."""
    colours = (style.EULER, "black", style.CONVERGED)
    for colour, (name, curve) in zip(colours, rows.groupby("estimator", sort=False), strict=False):
        axes.loglog(curve.work, curve.error.clip(lower=1e-16), ".-", color=colour, linewidth=0.8, label=name)
    axes.set_xlabel(work)
    axes.set_ylabel(error)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), handlelength=1.2)


def plot(
    *,
    jumping: pd.DataFrame,
    riding: pd.DataFrame,
    bouncing: pd.DataFrame,
    jumping_times: pd.DataFrame,
    riding_times: pd.DataFrame,
    bouncing_times: pd.DataFrame,
    estimates: pd.DataFrame,
    paper_step: float,
) -> Figure:
    """Draw the errors over the work in three scenes, with a ring around the published step, `paper_step` (s)."""
    figure = style.figure(style.PAGE, 215.0)
    upper, lower = figure.subfigures(2, 1, height_ratios=(3.4, 1.0))
    grid = upper.subplots(3, len(PANELS), sharex="col", sharey=True)
    scenes = {
        "jumping": (jumping, jumping_times),
        "always in contact": (riding, riding_times),
        "micro-bounces": (bouncing, bouncing_times),
    }
    for (name, (work, times)), row in zip(scenes.items(), grid, strict=True):
        table = work.assign(milliseconds=1e3 * times.seconds)
        for axes, (x, y, label, title) in zip(row, PANELS, strict=True):
            draw_panel(axes, table, x, y, paper_step)
            if axes in grid[0]:
                axes.set_title(title)
            if axes in grid[-1]:
                axes.set_xlabel(label)
        row[0].set_ylabel(f"{name}\nrelative error")
    upper.legend(handles=legend_handles([jumping, riding, bouncing]), loc="outside upper center", ncols=4)
    upper.supxlabel(MEANINGS + missing_note([jumping, riding, bouncing]), size=7.0)
    for axes, (quantity, labels) in zip(lower.subplots(1, len(QUANTITIES)), QUANTITIES.items(), strict=True):
        draw_estimates(axes, estimates[estimates.quantity == quantity], *labels)
    return figure
