"""Fig. 6: amplitude spectrum of the vertical velocity, below and above the critical amplitude."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

LOWEST = 1e-6  # m/s, end of the axis: below, lines of the riding part vanish in the noise of the samples
HIGHEST = 1000.0  # Hz, end of the axis, as in the paper


def plot_signal(converged: pd.DataFrame, euler: pd.DataFrame, signal: str, symbol: str) -> Figure:
    """Draw the spectra of one signal at two amplitudes."""
    figure = style.figure(style.PAGE, 60.0)
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    markers = {"euler": {"marker": "o", "markerfacecolor": "none"}, "converged": {"marker": "."}}
    for role, table in {"euler": euler, "converged": converged}.items():
        look = style.LOOKS[role] | markers[role]
        shown = table[(table.signal == signal) & (table.frequency <= HIGHEST)]
        for axes, place, (acceleration, rows) in zip(
            panels, ("below", "above"), shown.groupby("acceleration"), strict=True
        ):
            axes.plot(rows.frequency, rows.amplitude, linestyle="", markersize=4.0, markeredgewidth=0.6, **look)
            if role == "converged":
                axes.vlines(rows.frequency, LOWEST, rows.amplitude, color=look["color"], linewidth=0.8)
            axes.set_title(f"{place}, $\\hat{{a}}$ = {acceleration:g} m/s²")
            axes.set_xlabel("frequency in Hz")
            axes.set_yscale("log")
            axes.set_ylim(LOWEST, 1.5 * shown.amplitude.max())
            axes.set_ylabel(f"amplitude of {symbol} in m/s")
    panels[1].legend(loc="upper right")
    return figure


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame) -> Figure:
    """Draw spectra at two amplitudes."""
    return plot_signal(converged, euler, "vz", "$\\dot{z}_p$")
