"""Share of the initial conditions whose motion has not settled, over the excitation cycles."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.figure import Figure

from figures import style


def plot(*, times: pd.DataFrame) -> Figure:
    """Draw the share of unsettled initial conditions; the attribute `settling` is the limit of the config."""
    figure = style.figure(style.COLUMN, 84.0)
    axes = figure.subplots()
    most = times.cycles.max()
    amplitudes = np.sort(times.acceleration.unique())
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(amplitudes)))
    lines = ("-", "--", "-.", ":")
    for k, (colour, acceleration) in enumerate(zip(colours, amplitudes, strict=True)):
        rows = times[times.acceleration == acceleration]
        settled = np.sort(rows[rows.period > 0].cycles)
        # A motion that settles exactly at the limit leaves the share there.
        cycles = np.concatenate([[1.0], settled, [most]])
        share = 1.0 - np.concatenate([[0.0], np.arange(1, len(settled) + 1), [len(settled)]]) / len(rows)
        look = {"color": colour, "linestyle": lines[k % len(lines)], "label": f"{acceleration:g} m/s²"}
        axes.step(cycles, share, where="post", **look)
    style.mark(axes, times.attrs["settling"], "limit of\nthe config")
    axes.set_xscale("log")
    axes.set_xlim(8.0, most)
    axes.set_ylim(-0.02, 1.15)  # room for the label above the curves
    axes.set_xlabel("excitation cycles")
    axes.set_ylabel("share of initial conditions not settled")
    style.legend_above(figure, axes, ncols=3, handlelength=2.6)
    return figure
