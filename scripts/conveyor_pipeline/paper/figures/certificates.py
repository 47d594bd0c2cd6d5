"""Proved periodic orbits on their branches, widths of their enclosures, and brackets of folds and period doublings."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

PROVED = {
    "stable": {"color": style.CONVERGED, "marker": "o", "label": "proved stable"},
    "unstable": {"color": style.EULER, "marker": "o", "markerfacecolor": "white", "label": "proved unstable"},
    "open": {"color": "black", "marker": "x", "label": "not proved"},
}
# Colours of Okabe and Ito, from light to dark.
PERIODS = {1: "#56B4E9", 2: "#E69F00", 4: "#009E73", 8: "#CC79A7", 16: "#000000"}


def plot(*, branches: pd.DataFrame, orbits: pd.DataFrame, bifurcations: pd.DataFrame, longest_period: int) -> Figure:
    """Draw the certified `orbits` and bifurcations on the branches of up to `longest_period` cycles."""
    figure = style.figure(style.PAGE, 130.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(2.2, 1.0), width_ratios=(2.0, 1.0))
    diagram, widths, brackets = (figure.add_subplot(place) for place in (grid[0, :], grid[1, 0], grid[1, 1]))
    for _, rows in branches[branches.period <= longest_period].groupby(["branch", "cycle"]):
        diagram.plot(rows.acceleration, rows.v, color="0.7", linewidth=0.6, zorder=1)
    diagram.plot([], [], color="0.7", linewidth=0.6, label="computed branches")
    for kind, look in PROVED.items():
        rows = orbits[orbits.stability == kind]
        if len(rows):
            diagram.plot(rows.acceleration, rows.stored_v, linestyle="", markersize=2.8, markeredgewidth=0.7, **look)
    proved = bifurcations[bifurcations.proved]
    for row in proved.itertuples():
        diagram.axvline(row.acceleration_low, color="black", linewidth=0.5, linestyle=":", zorder=0)
    diagram.set_xlim(branches.acceleration.min(), branches.acceleration.max())
    diagram.set_xlabel(style.AMPLITUDE)
    diagram.set_ylabel("speed of approach $v$ at $\\psi$ = $\\psi_0$ in m/s")
    style.legend_above(figure, diagram, ncols=4)

    for period, rows in orbits[orbits.contained].groupby("period"):
        colour = PERIODS.get(period, "0.5")
        widths.plot(rows.acceleration, rows.half_width, ".", markersize=3.5, color=colour, label=f"{period}")
    widths.set_yscale("log")
    widths.set_xlim(diagram.get_xlim())
    widths.set_xlabel(style.AMPLITUDE)
    widths.set_ylabel("half-width of enclosures\nin $g/\\omega^2$ and $g/\\omega$")
    widths.legend(
        title="period in cycles", title_fontsize=7.0, ncols=5, loc="upper left", columnspacing=0.8, handletextpad=0.1
    )
    low, high = widths.get_ylim()
    widths.set_ylim(low, high * (high / low) ** 0.45)

    names = ["fold" if row.kind == "fold" else f"{row.period} → {2 * row.period}" for row in proved.itertuples()]
    sizes = (proved.acceleration_high - proved.acceleration_low).to_numpy()
    brackets.plot(sizes, np.arange(len(names)), "o", color="black", markersize=3.0)
    for place, row in enumerate(proved.itertuples()):
        style.note(brackets, f"{row.acceleration_low:.4f} m/s²", (sizes[place], place), (0, 4), ha="center")
    brackets.set_yticks(np.arange(len(names)), names)
    brackets.set_ylim(len(names) - 0.5, -0.9)
    brackets.set_xscale("log")
    brackets.set_xlim(sizes.min() / 10.0, sizes.max() * 10.0)
    brackets.set_xlabel("width of the bracket in m/s²")
    return figure
