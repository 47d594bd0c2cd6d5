"""Bifurcation diagram: attractors swept up and down and branches of periodic orbits; below, Lyapunov exponents."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

DIRECTIONS = {"up": style.CONVERGED, "down": style.EULER}
MARKERS = {"fold": ("s", "fold"), "period_doubling": ("o", "period doubling")}
WHITE = {"markersize": 3.5, "markerfacecolor": "white", "markeredgecolor": "black", "markeredgewidth": 0.7}
STABLE = {"color": "black", "linewidth": 0.7}
UNSTABLE = {"color": "black", "linewidth": 0.5, "linestyle": (0, (3, 2))}
LOWEST = -2.0  # per excitation cycle, end of the axis of the exponents


def draw_attractors(axes: Axes, strobes: pd.DataFrame) -> None:
    """Draw the strobes of the attractors of each sweep."""
    for branch, rows in strobes.groupby("branch", sort=False):
        order = {"zorder": 1 if branch == "up" else 0}
        style.dots(axes, rows.acceleration, rows.v, DIRECTIONS[branch], 0.7, rasterized=True, **order)


def draw_orbits(axes: Axes, branches: pd.DataFrame) -> None:
    """Draw branches of periodic orbits, a look for stable orbits and one for unstable ones."""
    for _, rows in branches.groupby(["branch", "cycle"]):
        for stable, look in ((True, STABLE), (False, UNSTABLE)):
            # NaN leaves a gap in the line where the stability changes.
            axes.plot(rows.acceleration, rows.v.where(rows.stable == stable), zorder=2, **look)


def draw_bifurcations(axes: Axes, bifurcations: pd.DataFrame) -> None:
    """Draw folds and period doublings."""
    for kind, (marker, label) in MARKERS.items():
        rows = bifurcations[bifurcations.kind == kind]
        if len(rows):
            axes.plot(rows.acceleration, rows.v, marker, label=label, zorder=3, **WHITE)


def draw_exponents(axes: Axes, spectrum: pd.DataFrame, lowest: float) -> None:
    """Draw the largest exponent of each sweep above `lowest` (1/s)."""
    for branch, rows in spectrum.groupby("branch", sort=False):
        label = f"amplitude swept {branch}"
        axes.plot(rows.acceleration, rows.lambda_1, color=DIRECTIONS[branch], linewidth=0.6, label=label)
    axes.axhline(0.0, color="black", linewidth=0.6)
    if not (spectrum.lambda_1 > lowest).any():
        style.say(axes, f"no exponent above {lowest:.3g} 1/s")
    # Room for the line at zero if no motion is chaotic.
    axes.set_ylim(lowest, max(1.15 * spectrum.lambda_1.max(), -0.1 * lowest))


def plot(
    *,
    strobes: pd.DataFrame,
    branches: pd.DataFrame,
    bifurcations: pd.DataFrame,
    cascade: pd.DataFrame,
    spectrum: pd.DataFrame,
    longest_period: int,
) -> Figure:
    """Draw attractors, orbits of up to `longest_period` cycles, and the largest exponents."""
    figure = style.figure(style.PAGE, 130.0)
    diagram, exponents = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.4))
    draw_attractors(diagram, strobes)
    draw_orbits(diagram, branches[branches.period <= longest_period])
    draw_bifurcations(diagram, bifurcations[bifurcations.period <= longest_period])
    # Too few period doublings have no accumulation point, and it may lie beyond the diagram.
    last = cascade.accumulation.dropna().tail(1)
    for place in last[last < strobes.acceleration.max()]:
        for axes in (diagram, exponents):
            axes.axvline(place, color="0.5", linewidth=0.6, linestyle=":")
        style.note(exponents, "period doublings accumulate", (place, 0.05), (3, 0), xycoords=("data", "axes fraction"))
    draw_exponents(exponents, spectrum, LOWEST * spectrum.attrs["model"]["frequency"])
    for stable, label, look in ((True, "stable orbit", STABLE), (False, "unstable orbit", UNSTABLE)):
        if (branches.stable == stable).any():
            diagram.plot([], [], label=label, **look)
    diagram.set_ylabel("speed of approach $v$ at $\\psi$ = $\\psi_0$ in m/s")
    exponents.set_ylabel("exponent $\\lambda_1$ in 1/s")
    exponents.set_xlabel(style.AMPLITUDE)
    exponents.set_xlim(strobes.acceleration.min(), strobes.acceleration.max())
    figure.align_ylabels()
    handles = [*diagram.get_legend_handles_labels()[0], *exponents.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside upper center", ncols=6)
    return figure
