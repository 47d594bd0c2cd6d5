"""Fig. 24: dimension of phase portraits over the acceleration amplitude, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the dimensions `euler`, `converged` and `correlation`; settings: critical_acceleration, m/s²."""
    figure = style.figure(style.COLUMN, 70.0)
    axes = figure.subplots()
    for dimension in (1.0, 2.0):
        axes.axhline(dimension, color="0.8", linewidth=0.6)
    curves = (
        ("euler", "o-", style.EULER, "paper's method: boxes, Euler, 1 s"),
        ("converged", "s", style.CONVERGED, "converged: boxes, settled motion"),
        ("correlation", "x", "#009E73", "converged: correlation sum"),
    )
    for role, marker, colour, label in curves:
        table = tables[role]
        axes.errorbar(
            table.acceleration,
            table.dimension,
            yerr=table.error,
            fmt=marker,
            color=colour,
            markersize=2.0,
            markeredgewidth=0.6,
            linewidth=0.6,
            elinewidth=0.4,
            label=label,
        )
    axes.axvline(settings["critical_acceleration"], ymax=0.78, color="black", linewidth=0.6, linestyle=":")
    axes.annotate(
        f"{settings['critical_acceleration']:g} m/s²",
        (settings["critical_acceleration"], 2.2),
        xytext=(-3, 0),
        textcoords="offset points",
        ha="right",
        size=7.0,
    )
    axes.set_ylim(0.75, 2.75)
    axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    axes.set_ylabel("dimension of the phase portrait")
    axes.legend(loc="upper left")
    return figure
