"""Sensitivity of bifurcations and critical heights to each parameter; bifurcation curves in dimensionless groups."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from conveyor_pipeline.figures import style

# Labels of the parameters, from top to bottom.
NAMES = {
    "acceleration": "amplitude $\\hat{a}$",
    "angle": "angle $\\varphi$",
    "gravity": "gravity $g$",
    "frequency": "frequency $f$",
    "mass": "mass $m$",
    "stiffness": "stiffness $k_c$",
    "damping": "damping $d_c$",
}
CHAOS, SECOND, FIRST = (style.STATE_COLOURS[state] for state in ("chaos", "second", "first"))
OTHER = "0.7"
POINTS = {
    "lift-off of a riding part": {"marker": "^", "color": FIRST},
    "part from rest leaves first state": {"marker": "s", "color": FIRST, "markerfacecolor": "none"},
    "first fold": {"marker": "o", "color": SECOND},
    "first period doubling": {"marker": "o", "color": CHAOS, "markerfacecolor": "none"},
    "second period doubling": {"marker": "D", "color": CHAOS, "markerfacecolor": "none"},
    "accumulation of doublings": {"marker": "*", "color": CHAOS, "markersize": 5.0},
}
HOLLOW = {"linestyle": "", "color": "black", "markerfacecolor": "none", "markeredgewidth": 0.6}
MEETINGS = {
    "cusp": ("cusp of folds", {"marker": "D", "markersize": 2.8}),
    "generalised doubling": ("generalised period doubling", {"marker": "v", "markersize": 3.2}),
    "grazing": ("grazing at the end of a curve", {"marker": "x", "markersize": 3.0}),
}


def select_points(table: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """The rows of each bifurcation that the figure names, by its label in POINTS."""
    folds = table[table.kind == "fold"]
    points = {
        "lift-off of a riding part": table[table.rides],
        "part from rest leaves first state": table[table.kind == "critical_amplitude"],
        "first fold": folds[folds.acceleration == folds.acceleration.min()],
        "first period doubling": table[table.doubling == 1],
        "second period doubling": table[table.doubling == 2],
        "accumulation of doublings": table[table.kind == "accumulation"],
    }
    return {
        label: rows[(rows.status == "ok") & rows.parameter.isin(NAMES) & rows.elasticity.notna()]
        for label, rows in points.items()
    }


def draw_dots(axes: Axes, groups: dict[str, pd.DataFrame], parameters: list[str], column: str, looks: dict) -> None:
    """Draw one row of dots for each parameter, with the groups below each other within it."""
    for n, (label, rows) in enumerate(groups.items()):
        values = rows.set_index("parameter")[column].reindex(parameters)
        offset = 0.6 * ((n + 0.5) / len(groups) - 0.5)
        axes.plot(values, np.arange(len(parameters)) + offset, linestyle="", label=label, **looks[label])
    for n in range(1, len(parameters)):
        axes.axhline(n - 0.5, color="0.9", linewidth=0.5, zorder=0)
    axes.axvline(0.0, color="black", linewidth=0.5, zorder=0)
    axes.set_ylim(len(parameters) - 0.5, -0.5)
    axes.set_yticks(range(len(parameters)), [NAMES[name] for name in parameters])
    axes.tick_params(axis="y", length=0.0)
    axes.locator_params(axis="x", nbins=7)  # labels such as -0.75 would overlap


def label_and_look(curve: pd.DataFrame, first_fold: float) -> tuple[str, dict]:
    """Legend label and line style of a bifurcation curve."""
    row = curve.iloc[0]
    if row.kind == "grazing":
        return "lift-off of a riding part", {"color": FIRST}
    if row.kind == "fold":
        if row.begin == first_fold:
            return "first fold", {"color": SECOND, "linewidth": 1.4}
        return "other folds", {"color": OTHER, "linewidth": 0.8}
    if row.doubling:
        dashes = {1: "-", 2: (0, (4, 1.5)), 3: (0, (1.5, 1.5))}.get(row.doubling, (0, (1, 3)))
        names = {1: "first period doubling", 2: "second period doubling", 3: "third period doubling"}
        return names.get(row.doubling, "later period doublings"), {"color": CHAOS, "linestyle": dashes}
    return "other period doublings", {"color": OTHER, "linewidth": 0.8, "linestyle": (0, (2, 1.5))}


def draw_curves(axes: Axes, curves: pd.DataFrame, meetings: pd.DataFrame, parameter: str, name: str) -> None:
    """Draw bifurcation curves, Γ over a parameter's group, with points of codimension two and the config's conveyor."""
    group = f"{parameter}_group"
    continued = curves[curves.parameter == parameter]
    folds = continued[continued.kind == "fold"]
    groups = [rows for _, rows in continued.groupby(["kind", "doubling", "begin"], sort=False)]
    looks = [(*label_and_look(rows, folds.begin.min()), rows) for rows in groups]
    # Named curves are drawn last, above the other ones.
    for label, look, rows in sorted(looks, key=lambda item: not item[0].startswith("other")):
        axes.plot(rows[group], rows.amplitude_group, label=label, **look)
    meetings = meetings[meetings.parameter == parameter]
    shown = meetings[
        (meetings.status == "ok") & (meetings.meeting != "grazing") | (meetings.status == "the curve ends here")
    ]
    for kind, (label, look) in MEETINGS.items():
        rows = shown[shown.meeting == kind]
        if len(rows):
            axes.plot(rows[group], rows.amplitude_group, label=label, **look, **HOLLOW)
    conveyor = curves[curves.parameter == "angle"]
    if len(conveyor):
        axes.axvline(conveyor[group].iloc[0], color="black", linewidth=0.5, linestyle=":")
        style.note(axes, "this conveyor", (conveyor[group].iloc[0], 0.02), (2, 0), xycoords=("data", "axes fraction"))
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = 0.15, 5.0
    axes.set_ylim(low, high)
    axes.set_yticks([0.2, 0.5, 1.0, 2.0, 5.0], ["0.2", "0.5", "1", "2", "5"])
    axes.yaxis.set_minor_locator(LogLocator(subs=()))
    style.label_powers(axes.xaxis)
    if continued.empty:
        style.say(axes, "no bifurcation to follow")
        axes.set_xticks([])
        axes.minorticks_off()
    axes.set_xlabel(name)
    axes.set_ylabel("amplitude group $\\Gamma = a_z/g$")


def plot(*, changes: pd.DataFrame, continued: pd.DataFrame, meetings: pd.DataFrame) -> Figure:
    """Draw changes by one per cent of each parameter, and bifurcation curves over two dimensionless groups."""
    figure = style.figure(style.PAGE, 140.0)
    (amplitudes, heights), (damping, stiffness) = figure.subplots(2, 2, height_ratios=(1.0, 1.15))

    named = {label: rows for label, rows in select_points(changes).items() if len(rows)}
    draw_dots(amplitudes, named, [name for name in NAMES if name != "acceleration"], "elasticity", POINTS)
    amplitudes.set_xlabel("change of $\\hat{a}$ in % per % of the parameter")
    if named:
        amplitudes.legend(loc="lower left", bbox_to_anchor=(-0.19, 1.0), ncols=2, columnspacing=0.6, handletextpad=0.2)
    else:
        has_bifurcations = changes.kind.isin(("fold", "period_doubling")).any()
        style.say(amplitudes, "no point was found again" if has_bifurcations else "no fold and no period doubling")
        amplitudes.set_xticks([])

    rows = changes[(changes.kind == "critical_height") & (changes.status == "ok")]
    rows = rows.assign(per_percent=1e6 * rows.change)
    by_amplitude = {f"{acceleration:.4g} m/s²": group for acceleration, group in rows.groupby("acceleration")}
    shades = colormaps["viridis"](np.linspace(0.0, 0.85, max(len(by_amplitude), 1)))
    looks = {label: {"marker": "o", "color": shade} for label, shade in zip(by_amplitude, shades, strict=False)}
    draw_dots(heights, by_amplitude, list(NAMES), "per_percent", looks)
    heights.set_xlabel("change of height in µm per % of the parameter")
    if by_amplitude:
        heights.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4, columnspacing=0.7, handletextpad=0.0)
    else:
        has_heights = (changes.kind == "critical_height").any()
        style.say(heights, "no point was found again" if has_heights else "no critical height")
        heights.set_xticks([])

    draw_curves(damping, continued, meetings, "damping", "damping group $D = d_c/(m\\omega)$")
    draw_curves(stiffness, continued, meetings, "stiffness", "stiffness group $K = k_c g^{p-1}/(m\\omega^{2p})$")
    handles: dict = {}
    for axes in (damping, stiffness):
        handles |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    if handles:
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
    style.letter(amplitudes, heights, damping, stiffness, x=-0.22)
    return figure
