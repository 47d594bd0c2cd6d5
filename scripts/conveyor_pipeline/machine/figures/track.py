"""Feeding velocity of each state over the inclination of the track and the phase shift of the drive."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.operating.regimes import NOT_ALL_SETTLED, SLIDES_AWAY

PHASES = {"−π": -np.pi, "−π/2": -0.5 * np.pi, "0": 0.0, "π/2": 0.5 * np.pi, "π": np.pi}


def plot(*, track: pd.DataFrame) -> Figure:
    """Draw one panel for each state; a line separates parts that climb from parts that slide back."""
    states = [state for state, rows in track.groupby("state") if rows.mean_velocity.notna().any()]
    figure = style.figure(style.PAGE, 82.0)
    panels = figure.subplots(1, max(len(states), 1), sharex=True, sharey=True, squeeze=False)[0]
    largest = track.mean_velocity.abs().max()
    for axes in panels:
        axes.set_xlabel("phase shift $\\varepsilon$ in rad")
        axes.set_xticks(list(PHASES.values()), PHASES)
        axes.set_xlim(track.phase_shift.min(), track.phase_shift.max())
    for axes, state in zip(panels, states, strict=False):
        grid = track[track.state == state].pivot(index="inclination", columns="phase_shift", values="mean_velocity")
        x, y = grid.columns.to_numpy(), np.degrees(grid.index.to_numpy())
        colours = {"cmap": "PuOr_r", "vmin": -largest, "vmax": largest}
        image = axes.pcolormesh(x, y, grid, shading="nearest", rasterized=True, **colours)
        axes.set_facecolor("0.85")
        if grid.min(axis=None) < 0.0 < grid.max(axis=None):
            axes.contour(x, y, grid, levels=[0.0], colors="black", linewidths=1.0)
        axes.axhline(0.0, color="black", linewidth=0.4, linestyle=":")
        axes.axvline(0.0, color="black", linewidth=0.4, linestyle=":")
        axes.set_title(style.state_label(state), color=style.STATE_COLOURS[state])
        steep = np.degrees(track.inclination[(track.status == SLIDES_AWAY) & (track.inclination > 0.0)])
        if len(steep):
            middle = (0.0, 0.5 * (steep.min() + steep.max()))
            style.note(axes, "parts slide down and accelerate", middle, ha="center", va="center")
    panels[0].set_ylabel("inclination $\\alpha$ in °")
    if states:
        style.velocity_axis(figure.colorbar(image, ax=list(panels)).ax.yaxis)
    else:
        panels[0].set_ylim(*np.degrees([track.inclination.min(), track.inclination.max()]))
        known = "known " if (track.status == NOT_ALL_SETTLED).any() else ""
        slides = (track.status == SLIDES_AWAY).all()
        style.say(panels[0], "parts slide away on all tracks" if slides else f"no periodic motion {known}on any track")
    return figure
