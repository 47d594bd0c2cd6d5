"""Stability limits in detail: maps of the outcome over the time step, and other kinds of failure."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from figures import style

OUTCOMES = {"right": "#BFD9EA", "wrong state": "#F3D9A0", "energy grows": "#D55E00", "blow-up": "#444444"}
AXES = {
    "stiffness": "stiffness in N/m",
    "damping": "damping in N s/m",
    "impact velocity": "impact velocity in m/s",
    "conveyor": "amplitude $\\hat{a}$ in m/s²",
}
LIMIT = {"color": "black", "linewidth": 1.2, "linestyle": (0, (4, 2))}
PAPER = {"marker": "*", "color": "white", "markeredgecolor": "black", "markeredgewidth": 0.6, "markersize": 8.0}
EDGES = {"stiffness": "o", "damping": "s", "impact velocity": "^"}
SMALLEST = 1e-18  # of a slip on a logarithmic axis


def draw_map(axes: Axes, rows: pd.DataFrame, panel: str) -> None:
    """Draw the outcome over the step and one other quantity, with the theoretical stability limit."""
    style.class_map(axes, rows.pivot(index="y", columns="x", values="outcome"), OUTCOMES)
    theory = rows.groupby("y").theory.first()
    axes.plot(theory, theory.index, **LIMIT)
    axes.set_xscale("log")
    axes.set_yscale("linear" if panel == "conveyor" else "log")
    axes.set_xlim(rows.x.min(), rows.x.max())


def draw_maps(figure: SubFigure, table: pd.DataFrame, acceleration: float) -> None:
    """Draw a row of maps for each quantity and a column for each method; star: paper's step and amplitude (m/s²)."""
    methods = table.attrs["methods"]
    panels = figure.subplots(len(AXES), len(methods), sharex=True, sharey="row", squeeze=False)
    for row, panel in zip(panels, AXES, strict=True):
        for axes, method in zip(row, methods, strict=True):
            draw_map(axes, table[(table.panel == panel) & (table.method == method)], panel)
        row[0].set_ylabel(AXES[panel])
    panels[-1, 0].plot(table.attrs["paper_step"], acceleration, **PAPER)
    for axes, method in zip(panels[0], methods, strict=True):
        axes.set_title(style.METHODS[method][1])
    for axes in panels[-1]:
        axes.set_xlabel("time step in s")


def draw_edges(axes: Axes, table: pd.DataFrame) -> None:
    """Draw measured limits over theoretical ones."""
    for panel, marker in EDGES.items():
        for method in table.attrs["methods"]:
            rows = table[(table.panel == f"edge: {panel}") & (table.method == method)]
            look = {"color": style.METHODS[method][0], "markersize": 2.5, "markeredgewidth": 0.0}
            axes.plot(rows.theory, rows.x / rows.theory, marker, **look)
    axes.axhspan(0.8, 1.2, color="0.93")
    axes.set_xscale("log")
    axes.set_ylim(0.7, 1.3)
    axes.set_xlabel("theoretical step limit in s")
    axes.set_ylabel("measured / theory")
    handles = [Line2D([], [], linestyle="", marker=marker, color="0.4", label=name) for name, marker in EDGES.items()]
    axes.legend(handles=handles, loc="lower right", handletextpad=0.0, labelspacing=0.2, borderaxespad=0.0)


def draw_chatter(axes: Axes, table: pd.DataFrame) -> None:
    """Draw the slip velocity of a part that should stick, over the step."""
    for method, label in {"euler": "Euler", "event": "this solver"}.items():
        rows = table[(table.panel == "chatter") & (table.method == method)]
        axes.loglog(rows.x, rows.y.clip(lower=SMALLEST), ".-", color=style.METHODS[method][0])
        style.note(axes, label, (rows.x.iloc[0], rows.y.iloc[0]), (0, 5))
    axes.set_xlabel("time step in s")
    axes.set_ylabel("slip velocity\nin stick in m/s")


def draw_hard(axes: Axes, table: pd.DataFrame) -> None:
    """Draw errors in hard cases, with the outcome of Euler as a text; rivals have smaller points."""
    cases = [panel for panel in dict.fromkeys(table.panel) if panel.startswith("hard")]
    for place, case in enumerate(cases):
        rows = table[table.panel == case].set_index("method")
        for method, error in rows.y.items():
            size = 4.0 if method in ("euler", "event") else 2.5
            axes.semilogx(error, place, "o", color=style.METHODS[method][0], markersize=size)
        text = f"{case.removeprefix('hard: ')}; Euler: {rows.outcome['euler']}"
        style.note(axes, text, (0.02, place), (0, 4), xycoords=("axes fraction", "data"))
    axes.set_ylim(len(cases) - 0.5, -0.9)
    axes.set_xlim(1e-15, 1e2)
    axes.set_xticks([1e-14, 1e-10, 1e-6, 1e-2])
    axes.set_yticks([])
    axes.spines.left.set_visible(False)
    axes.set_xlabel("relative error of the height")


def plot(*, stability: pd.DataFrame, acceleration: float) -> Figure:
    """Draw the maps of all methods at one `acceleration` (m/s²), and their limits."""
    figure = style.figure(style.PAGE, 225.0)
    above, below = figure.subfigures(2, 1, height_ratios=[3.6, 1.0])
    draw_maps(above, stability, acceleration)
    edges, chatter, hard = below.subplots(1, 3)
    draw_edges(edges, stability)
    draw_chatter(chatter, stability)
    draw_hard(hard, stability)
    handles = [Patch(color=colour, label=outcome) for outcome, colour in OUTCOMES.items()]
    handles.append(Line2D([], [], **LIMIT, label="theoretical limit"))
    handles.append(Line2D([], [], linestyle="", **PAPER, label="paper's time step"))
    above.legend(handles=handles, loc="outside upper center", ncols=6)
    in_hard_cases = stability[stability.panel.str.startswith("hard")]
    missing = set(in_hard_cases.method[in_hard_cases.outcome == "not installed"])
    handles = []
    for method in dict.fromkeys((*stability.attrs["methods"], "event", *in_hard_cases.method)):
        colour, name = style.METHODS[method]
        label = f"{name} (not installed)" if method in missing else name
        handles.append(Line2D([], [], linestyle="", marker="o", color=colour, label=label))
    below.legend(handles=handles, loc="outside upper center", ncols=4)
    return figure
