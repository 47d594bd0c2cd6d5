"""Speed and accuracy in one chart: error over processor time of all methods in three scenes, and their failures."""

import math

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from conveyor.parameters import FIXED_STEP_METHODS
from conveyor_pipeline.figures import style
from conveyor_pipeline.study.accuracy import speed

# Marker and line of each treatment of events, and its name in the legend.
TREATMENTS = {
    "exact": ("o", "-", None),
    "exact, nothing repeated": ("o", "-.", "this solver, no step reused"),
    "fixed step": (".", "-", None),
    "sign": ("x", ":", "sign: no events, friction by sign()"),
    "events": ("^", "--", "events: naive restart"),
    "modes": ("s", "-", "modes: events and contact modes"),
}
# Marker of each outcome in the list of failures, and its meaning.
OUTCOMES = {
    "ok": ("|", "right state of motion"),
    "wrong state": ("x", "wrong state of motion"),
    "through the plate": ("v", "fell through the plate, reported success"),
    "gave up": ("s", "limit of evaluations reached"),
    "stuck at an event": ("o", "same event again and again"),
    "step too small": ("<", "step too small"),
    "event lost": ("^", "event missed"),
    "not finite": ("D", "not finite"),
}
SMALLEST = 1e-16  # drawn error
NAMES = {"jumping": "jumping", "riding": "always in contact", "bouncing": "micro-bounces"}  # of the scenes


def method_name(method: str) -> str:
    """The name of a method in a sentence; methods of SciPy with their package: "SciPy's DOP853"."""
    return style.METHODS[method][1] if method in FIXED_STEP_METHODS else f"SciPy's {method}"


def draw_curve(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw the errors of the runs of one method over their times."""
    method, treatment = rows.method.iloc[0], rows.treatment.iloc[0]
    colour, _ = style.METHODS[method]
    marker, line, _ = TREATMENTS[treatment]
    size, order = (3.0, 3) if method == "event" else (2.2, 2)
    width, face = 1.4 if treatment == "exact" else 0.6, colour if treatment in ("exact", "fixed step") else "none"
    markers = {"marker": marker, "markersize": size, "markeredgewidth": 0.6, "markerfacecolor": face}
    axes.plot(
        rows.milliseconds,
        rows.trajectory_error.clip(lower=SMALLEST),
        color=colour,
        linestyle=line,
        linewidth=width,
        zorder=order,
        **markers,
    )


def draw_factor(axes: Axes, factor: speed.Factor, below: bool) -> None:
    """Draw an arrow from another run to the solver at equal error, with the ratio of their times."""
    look = {"arrowstyle": "-|>", "color": "black", "linewidth": 1.0, "shrinkA": 0.0, "shrinkB": 2.0}
    tip, tail = (factor.own_milliseconds, factor.error), (factor.milliseconds, factor.error)
    axes.annotate("", tip, tail, arrowprops=look, zorder=4)
    place = math.sqrt(factor.own_milliseconds * factor.milliseconds), factor.error
    offset, side = ((0, -3), "top") if below else ((0, 3), "bottom")
    label = f"{float(f'{factor.ratio:.2g}'):g}×"
    box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}  # between the label and the curves
    style.note(axes, label, place, offset, ha="center", va=side, weight="bold", bbox=box)


def draw_panel(axes: Axes, runs: pd.DataFrame) -> None:
    """Draw the error over the processor time of the successful runs of a scene."""
    for _, rows in runs.groupby(["method", "treatment"], sort=False):
        draw_curve(axes, rows)
    paper = speed.paper_run(runs)
    place = paper.milliseconds, paper.trajectory_error
    axes.plot(*place, "o", markersize=7.0, markerfacecolor="none", color=style.EULER)
    for factor in speed.factors(runs):
        draw_factor(axes, factor, factor.method == "euler")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(SMALLEST, 1e3)
    axes.set_yticks([1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0])
    axes.minorticks_off()
    axes.grid(linewidth=0.3, color="0.9")


def legend_handles() -> list[Line2D]:
    """Legend handles of the methods and of the treatments of events."""
    known = [Line2D([], [], color=colour, linewidth=1.4, label=name) for colour, name in style.METHODS.values()]
    treated = [
        Line2D([], [], color="0.3", marker=marker, linestyle=line, linewidth=0.6, markerfacecolor="none", label=label)
        for marker, line, label in TREATMENTS.values()
        if label
    ]
    paper = Line2D([], [], color=style.EULER, marker="o", linestyle="", markersize=6.0, markerfacecolor="none")
    paper.set_label("paper's time step")
    return [*known, *treated, paper]


def failing_methods(runs: pd.DataFrame) -> list[tuple[str, str]]:
    """Methods and treatments with at least one failed run, in the order of the table."""
    failed = runs[runs.outcome != "ok"]
    return list(failed[["method", "treatment"]].drop_duplicates().itertuples(index=False, name=None))


def draw_outcomes(axes: Axes, table: pd.DataFrame, kinds: list[tuple[str, str]]) -> None:
    """Draw the outcomes of a scene over tolerance or time step, with a line for each method and treatment."""
    accuracy = table.tolerance.fillna(table.step)
    for place, (method, treatment) in enumerate(kinds):
        of_kind = (table.method == method) & (table.treatment == treatment)
        for outcome, (marker, _) in OUTCOMES.items():
            values = accuracy[of_kind & (table.outcome == outcome)]
            look = {"color": style.METHODS[method][0], "markerfacecolor": "none", "markersize": 3.5}
            axes.plot(values, np.full(len(values), place), marker, **look)
    axes.set_xscale("log")
    axes.minorticks_off()
    axes.set_xlabel("tolerance, or time step in s")


def draw_failures(figure: SubFigure, scenes: dict[str, pd.DataFrame]) -> None:
    """Draw the outcomes of all methods that fail in some scene, a panel for each scene."""
    runs = pd.concat(scenes.values())
    kinds = failing_methods(runs)
    panels = figure.subplots(1, len(scenes), sharex=True, sharey=True)
    for axes, (name, table) in zip(panels, scenes.items(), strict=True):
        draw_outcomes(axes, table, kinds)
        axes.set_title(NAMES[name])
    panels[0].invert_xaxis()
    panels[0].set_ylim(len(kinds) - 0.5, -0.5)
    treatments = {kind: "" if kind[1] == "fixed step" else f", {kind[1]}" for kind in kinds}
    panels[0].set_yticks(range(len(kinds)), [style.METHODS[kind[0]][1] + treatments[kind] for kind in kinds])
    handles = [
        Line2D([], [], color="0.3", linestyle="", marker=marker, markerfacecolor="none", markersize=3.5, label=meaning)
        for outcome, (marker, meaning) in OUTCOMES.items()
        if (runs.outcome == outcome).any()
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, handletextpad=0.2)


def plot(
    *,
    jumping: pd.DataFrame,
    riding: pd.DataFrame,
    bouncing: pd.DataFrame,
    jumping_times: pd.DataFrame,
    riding_times: pd.DataFrame,
    bouncing_times: pd.DataFrame,
) -> Figure:
    """Draw the errors over processor time in three scenes, and all failures.

    A ring is around the run with the paper's step. Speed ratios are at its error and at EQUAL_ERROR of `speed`.
    """
    figure = style.figure(style.PAGE, 155.0)
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.3, 1.0))
    scenes = {"jumping": jumping, "riding": riding, "bouncing": bouncing}
    panels = upper.subplots(1, len(scenes), sharex=True, sharey=True)
    times = (jumping_times, riding_times, bouncing_times)
    for axes, (name, work), seconds in zip(panels, scenes.items(), times, strict=True):
        draw_panel(axes, speed.successful_runs(work, seconds))
        axes.set_title(NAMES[name])
        axes.set_xlabel(f"processor time for {work.attrs['duration']:g} s in ms")
    panels[0].set_ylabel("error of the trajectory\nin units of the plate's motion")
    upper.legend(handles=legend_handles(), loc="outside upper center", ncols=4)
    draw_failures(lower, scenes)
    return figure
