"""What the data of each figure need: cost of each variant of each sweep, and what a reader would see of it."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from plots import style

LOOKS = {"feeding": ("o", style.CONVERGED), "vertical": ("s", "#009E73"), "rigid part": ("^", style.PUBLISHED)}


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the table of budgets."""
    table = tables["budget"]
    names = list(dict.fromkeys(table.sweep))
    figure = style.figure(style.PAGE, 22.0 + 8.0 * len(names))
    cost, seen = figure.subplots(1, 2, sharey=True)
    for kind, (marker, colour) in LOOKS.items():
        for visible, face in ((False, colour), (True, "white")):
            rows = table[(table.variant == kind) & (table.visible == visible)]
            places = rows.sweep.map(names.index)
            changes = rows[["states_changed", "velocities_changed"]].max(axis=1).clip(lower=1e-3)
            look = {
                "linestyle": "",
                "markersize": 3.5,
                "color": colour,
                "markerfacecolor": face,
                "markeredgewidth": 0.7,
            }
            cost.plot(1e3 * rows.seconds, places, marker, **look)
            seen.plot(changes, places, marker, **look)
    chosen = table[table.chosen]
    changes = chosen[["states_changed", "velocities_changed"]].max(axis=1).clip(lower=1e-3)
    ring = {"linestyle": "", "markersize": 8.0, "markerfacecolor": "none", "color": "black", "markeredgewidth": 0.8}
    cost.plot(1e3 * chosen.seconds, chosen.sweep.map(names.index), "o", **ring)
    seen.plot(changes, chosen.sweep.map(names.index), "o", **ring)
    full = table.groupby("sweep", sort=False).full_seconds.first()
    cost.plot(1e3 * full, np.arange(len(full)), "|", color="black", markersize=9.0)
    seen.axvline(table.attrs["pixels"], color="black", linewidth=0.6, linestyle=":")
    labels = table.groupby("sweep", sort=False).figures.first()
    cost.set_yticks(range(len(names)), [f"{name}\n{labels[name]}" for name in names])
    cost.invert_yaxis()
    cost.set_xlim(0.01, 1.0)
    for axes in (cost, seen):
        axes.set_xscale("log")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(axis="y", linewidth=0.3)
    cost.set_xlabel("wall time of a point in ms")
    seen.set_xlabel("share of points that change visibly (0.001: none)")
    handles = [
        Line2D([], [], linestyle="", marker=marker, color=colour, label=kind)
        for kind, (marker, colour) in LOOKS.items()
    ]
    handles += [
        Line2D([], [], linestyle="", marker="o", color="0.5", markerfacecolor="white", label="open: visible"),
        Line2D([], [], label="chosen", **{**ring, "marker": "o"}),
        Line2D([], [], linestyle="", marker="|", color="black", markersize=9.0, label="full model, tight tolerance"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=6)
    return figure
