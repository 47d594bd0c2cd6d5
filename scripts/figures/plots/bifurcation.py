"""Bifurcation diagram: attractors swept up and down and branches of periodic orbits; below, Lyapunov exponents."""

import pandas as pd
from matplotlib.figure import Figure

from figures import style

DIRECTIONS = {"up": style.CONVERGED, "down": style.EULER}
MARKERS = {"fold": ("s", "fold"), "period_doubling": ("o", "period doubling")}


def plot(
    *,
    strobes: pd.DataFrame,
    branches: pd.DataFrame,
    bifurcations: pd.DataFrame,
    cascade: pd.DataFrame,
    spectrum: pd.DataFrame,
    longest_period: int,
    lowest_exponent: float,
) -> Figure:
    """Draw attractors, orbits of up to `longest_period` cycles, and exponents above `lowest_exponent` (1/s)."""
    figure = style.figure(style.PAGE, 130.0)
    diagram, exponents = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.4))
    for branch, rows in strobes.groupby("branch", sort=False):
        diagram.plot(
            rows.acceleration,
            rows.v,
            ".",
            markersize=0.7,
            markeredgewidth=0.0,
            color=DIRECTIONS[branch],
            rasterized=True,
            zorder=1 if branch == "up" else 0,
        )
    orbits, found = (table[table.period <= longest_period] for table in (branches, bifurcations))
    for _, rows in orbits.groupby(["branch", "cycle"]):
        for stable, look in ((True, {"linewidth": 0.7}), (False, {"linewidth": 0.5, "linestyle": (0, (3, 2))})):
            # NaN leaves a gap in the line where the stability changes.
            shown = rows.v.where(rows.stable == stable)
            diagram.plot(rows.acceleration, shown, color="black", zorder=2, **look)
    for kind, (marker, label) in MARKERS.items():
        rows = found[found.kind == kind]
        diagram.plot(
            rows.acceleration,
            rows.v,
            marker,
            markersize=3.5,
            markerfacecolor="white",
            markeredgecolor="black",
            markeredgewidth=0.7,
            zorder=3,
            label=label,
        )
    # Too few period doublings have no accumulation point.
    for place in cascade.accumulation.dropna().tail(1):
        for axes in (diagram, exponents):
            axes.axvline(place, color="0.5", linewidth=0.6, linestyle=":")
        style.note(exponents, "period doublings accumulate", (place, 0.05), (3, 0), xycoords=("data", "axes fraction"))
    for branch, rows in spectrum.groupby("branch", sort=False):
        exponents.plot(
            rows.acceleration, rows.lambda_1, color=DIRECTIONS[branch], linewidth=0.6, label=f"amplitude swept {branch}"
        )
    exponents.axhline(0.0, color="black", linewidth=0.6)
    exponents.set_ylim(lowest_exponent, 1.15 * spectrum.lambda_1.max())
    diagram.plot([], [], color="black", linewidth=0.7, label="stable orbit")
    diagram.plot([], [], color="black", linewidth=0.5, linestyle=(0, (3, 2)), label="unstable orbit")
    diagram.set_ylabel("speed of approach $v$ at $\\psi$ = $\\psi_0$ in m/s")
    exponents.set_ylabel("exponent $\\lambda_1$ in 1/s")
    exponents.set_xlabel(style.AMPLITUDE)
    exponents.set_xlim(strobes.acceleration.min(), strobes.acceleration.max())
    figure.align_ylabels()
    handles = [*diagram.get_legend_handles_labels()[0], *exponents.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside upper center", ncols=6)
    return figure
