"""Time steps at which the paper's method leaves the right state of motion; this solver has no such limit."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from conveyor_pipeline.figures import style
from conveyor_pipeline.study.accuracy.speed import PAPER_STEP

OUTCOMES = {"right": "#BFD9EA", "wrong state": "#F3D9A0", "energy grows": "#D55E00", "blow-up": "#444444"}
AXES = {
    "stiffness": "stiffness in N/m",
    "damping": "damping in N s/m",
    "impact velocity": "impact velocity in m/s",
    "conveyor": "amplitude $\\hat{a}$ in m/s²",
}
PAPER_AMPLITUDE = 40.0  # m/s² (Sect. 3)
PAPER = {"marker": "*", "color": "white", "markeredgecolor": "black", "markeredgewidth": 0.6, "markersize": 9.0}
THEORY = {"color": "black", "linewidth": 1.0, "linestyle": ":"}
TITLES = {
    "stiffness": "linear contact",
    "damping": "linear contact",
    "impact velocity": "single Hertz impact",
    "conveyor": "vibrating plate",
}
OWN_ROW = 2.5  # place of the solver's line, in units of the largest step


def largest_right_step(rows: pd.DataFrame) -> pd.Series:
    """For each value, the largest step (s) up to which all steps lead to the right state; NaN where none does."""

    def limit(steps: pd.DataFrame) -> float:
        steps = steps.sort_values("x")
        right_steps = steps.x[(steps.outcome == "right").cummin()]
        return right_steps.max() if len(right_steps) else np.nan

    return rows.groupby("y")[["x", "outcome"]].apply(limit)


def draw_panel(axes: Axes, rows: pd.DataFrame, panel: str, methods: list[str]) -> None:
    """Draw the outcomes of the paper's method over one quantity and the step, and the limits of all methods."""
    euler = rows[rows.method == "euler"]
    style.class_map(axes, euler.pivot(index="x", columns="y", values="outcome"), OUTCOMES)
    for method in methods:
        limits = largest_right_step(rows[rows.method == method])
        width = 2.0 if method == "euler" else 1.0
        edge = withStroke(linewidth=width + 1.0, foreground="white")
        axes.plot(limits.index, limits, color=style.METHODS[method][0], linewidth=width, path_effects=[edge])
    theory = euler.groupby("y").theory.first()
    axes.plot(theory.index, theory, **THEORY)
    solver = rows[rows.method == "event"].sort_values("y")
    top = OWN_ROW * euler.x.max()
    right = solver.y.where(solver.outcome == "right")
    axes.plot(right, np.full(len(solver), top), color=style.CONVERGED, linewidth=4.0, solid_capstyle="butt")
    axes.axhline(PAPER_STEP, color="black", linewidth=0.8, linestyle=(0, (4, 2)))
    axes.set_yscale("log")
    axes.set_xscale("linear" if panel == "conveyor" else "log")
    axes.set_xlim(euler.y.min(), euler.y.max())
    axes.set_ylim(euler.x.min(), 2.0 * top)
    axes.set_title(TITLES[panel])
    axes.set_xlabel(AXES[panel])


def legend_handles(methods: list[str]) -> list[Patch | Line2D]:
    """Legend handles of the outcomes of the paper's method, the limits of all methods, and the solver."""
    names = {"right": "paper's method: right state"}
    areas = [Patch(color=colour, label=names.get(outcome, outcome)) for outcome, colour in OUTCOMES.items()]
    lines = []
    for method in methods:
        colour, name = style.METHODS[method]
        width = 2.0 if method == "euler" else 1.0
        lines.append(Line2D([], [], color=colour, linewidth=width, label=f"limit of {name}"))
    theory = Line2D([], [], **THEORY, label="limit of explicit Euler, theory")
    solver = Line2D([], [], color=style.CONVERGED, linewidth=4.0, label="this solver: right state, no step limit")
    step = Line2D([], [], color="black", linewidth=0.8, linestyle=(0, (4, 2)), label="paper's time step")
    return [*areas, *lines, theory, solver, step]


def plot(*, stability: pd.DataFrame) -> Figure:
    """Draw a panel for each quantity, with a star at the paper's step and default amplitude."""
    figure = style.figure(style.PAGE, 130.0)
    panels = figure.subplots(2, 2, sharey=True)
    methods = [method for method in stability.method.unique() if method != "event"]
    for axes, panel in zip(panels.flat, AXES, strict=True):
        draw_panel(axes, stability[stability.panel == panel], panel, methods)
    panels[1, 1].plot(PAPER_AMPLITUDE, PAPER_STEP, **PAPER)
    for axes in panels[:, 0]:
        axes.set_ylabel("time step in s")
    figure.legend(handles=legend_handles(methods), loc="outside upper center", ncols=3)
    return figure
