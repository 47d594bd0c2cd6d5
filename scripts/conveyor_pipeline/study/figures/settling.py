"""Share of the initial conditions whose motion has not settled, over the excitation cycles."""

import math

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

COLUMNS = 2  # of panels


def draw_share(axes: Axes, times: pd.DataFrame, limit: int) -> None:
    """Draw the share of the motions at one amplitude that have not settled, up to `limit` cycles."""
    settled = np.sort(times[times.period > 0].cycles)
    # A motion that settles exactly at the limit leaves the share there.
    cycles = np.concatenate([[1.0], settled, [limit]])
    share = 1.0 - np.concatenate([[0.0], np.arange(1, len(settled) + 1), [len(settled)]]) / len(times)
    axes.fill_between(cycles, share, step="post", color=style.CONVERGED, alpha=0.25, linewidth=0.0)
    axes.step(cycles, share, where="post", color=style.CONVERGED)


def plot(*, times: pd.DataFrame) -> Figure:
    """Draw the share of unsettled initial conditions; the attribute `settling` is the limit of the config."""
    longest = times.cycles.max()
    amplitudes = np.sort(times.acceleration.unique())
    figure = style.figure(style.COLUMN, 20.0 + 18.0 * math.ceil(len(amplitudes) / COLUMNS))
    grid = figure.subplots(math.ceil(len(amplitudes) / COLUMNS), COLUMNS, sharex=True, sharey=True, squeeze=False)
    for axes, acceleration in zip(grid.flat, amplitudes, strict=False):
        draw_share(axes, times[times.acceleration == acceleration], longest)
        axes.axvline(times.attrs["settling"], color="black", linewidth=0.6, linestyle=":")
        axes.set_title(f"{acceleration:g} m/s²", pad=2.0)
    for axes in grid.flat[len(amplitudes) :]:
        axes.set_axis_off()
    grid[0, 0].set_xscale("log")
    grid[0, 0].set_xlim(8.0, longest)
    grid[0, 0].set_ylim(0.0, 1.05)
    figure.supxlabel("excitation cycles", fontsize=style.PARAMETERS["axes.labelsize"])
    figure.supylabel("share of initial conditions not settled", fontsize=style.PARAMETERS["axes.labelsize"])
    return figure
