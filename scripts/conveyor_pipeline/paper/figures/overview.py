"""Overview: attractors and Lyapunov exponents over the amplitude, and a map of the states over initial conditions."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.paper.claims.about_proofs import lowest_fold

SHADE = "0.93"
# Colours of the exponents of the attractors that are followed over the amplitude; the upper branch hides the lower one.
BRANCHES = {
    "down": ("#56B4E9", "converged, falling"),
    "up": (style.CONVERGED, "converged, rising"),
}
LOWEST = -30.0  # 1/s, end of the axis of the exponents


def draw_attractors(axes: Axes, strobes: pd.DataFrame) -> None:
    """Draw stroboscopic states in the colour of their state of motion."""
    for state in ("chaos", "undecided", "second", "first"):  # regular motion over chaos
        rows = strobes[strobes.state == state]
        size = 0.6 if state == "chaos" else 1.2
        style.dots(axes, rows.acceleration, rows.v, style.STATE_COLOURS[state], size, rasterized=True)
    axes.set_ylabel("speed of approach\nat $\\psi$ = $\\psi_0$ in m/s")


def draw_exponents(axes: Axes, spectrum: pd.DataFrame, estimate: pd.DataFrame) -> None:
    """Draw the Lyapunov exponents of the attractors swept up and down, and the paper's estimate."""
    axes.axhline(0.0, color="black", linewidth=0.6)
    for branch, (colour, label) in BRANCHES.items():
        rows = spectrum[spectrum.branch == branch]
        axes.plot(rows.acceleration, rows.lambda_1, color=colour, linewidth=0.6, label=label)
    look = {"color": style.EULER, "linewidth": 0.9, "label": "estimate of Fig. 22"}
    axes.plot(estimate.acceleration, estimate["lambda"], **look)
    axes.set_ylabel("Lyapunov\nexponent in 1/s")
    axes.legend(loc="upper left", bbox_to_anchor=(0.06, 1.04), handlelength=1.0, labelspacing=0.1)


def plot(
    *,
    strobes: pd.DataFrame,
    bifurcations: pd.DataFrame,
    cascade: pd.DataFrame,
    spectrum: pd.DataFrame,
    estimate: pd.DataFrame,
    map: pd.DataFrame,
    critical_acceleration: float | None = None,
) -> Figure:
    """Draw attractors, exponents and states; shade from `critical_acceleration` (m/s²) to the accumulation."""
    figure = style.figure(style.PAGE, 96.0)
    grid = figure.add_gridspec(1, 2, width_ratios=(2.0, 1.0))
    left = grid[0].subgridspec(2, 1, height_ratios=(1.5, 1.0))
    diagram = figure.add_subplot(left[0])
    below = figure.add_subplot(left[1], sharex=diagram)
    states = figure.add_subplot(grid[1])

    fold = lowest_fold(bifurcations)
    accumulation = cascade.accumulation.dropna().iloc[-1]
    draw_attractors(diagram, strobes)
    draw_exponents(below, spectrum, estimate)
    for axes in (diagram, below):
        if critical_acceleration is not None:
            axes.axvspan(critical_acceleration, accumulation, color=SHADE, zorder=-1)
        axes.axvline(fold, color="black", linewidth=0.6, linestyle=":")
        axes.axvline(accumulation, color="black", linewidth=0.6, linestyle=":")
    top = {"xycoords": ("data", "axes fraction"), "va": "top"}
    style.note(diagram, "two attractors coexist", (fold, 0.97), (2, 0), **top)
    text = "doublings of\nthe jumps\naccumulate"
    style.note(diagram, text, (accumulation, 0.97), (-2, 0), ha="right", **top)
    if critical_acceleration is not None:
        middle = 0.5 * (critical_acceleration + accumulation)
        style.note(below, "chaos by\nestimate", (middle, 0.97), ha="center", **top)
    diagram.tick_params(labelbottom=False)
    below.set_ylim(LOWEST, 2.0 * spectrum.lambda_1.max())
    below.set_xlim(strobes.acceleration.min(), strobes.acceleration.max())
    below.set_xlabel(style.AMPLITUDE)

    style.state_map(states, map.assign(z0=1e3 * map.z0), "z0", "psi0")
    style.phase_axis(states.yaxis)
    states.set_xlabel("initial height $z_0$ in mm")
    states.set_ylabel("initial phase $\\psi_0$ in rad")
    states.set_title(f"$\\hat{{a}}$ = {map.attrs['model']['acceleration']:g} m/s²")
    style.letter(diagram, below, states)
    figure.legend(handles=style.state_handles(strobes, map), loc="outside upper center", ncols=4)
    figure.align_ylabels([diagram, below])
    return figure
