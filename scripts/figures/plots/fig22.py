"""Fig. 22: Lyapunov exponent of the feeding velocity by finite differences, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from figures import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the estimates `converged` and `euler`; settings: critical_acceleration, m/s²."""
    figure = style.figure(style.COLUMN, 62.0)
    axes = figure.subplots()
    axes.axhline(0.0, color="black", linewidth=0.6)
    for role, label in style.panels(tables).items():
        table, width = tables[role], 1.6 if role == "euler" else 0.8
        axes.plot(table.acceleration, table["lambda"], color=style.CURVES[role]["color"], linewidth=width, label=label)
    if "critical_acceleration" in settings:
        style.mark(axes, settings["critical_acceleration"], f"{settings['critical_acceleration']:g} m/s²")
    axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    axes.set_ylabel("Lyapunov exponent of $\\dot{x}_p$ in 1/s")
    style.legend_above(figure, axes, ncols=2)
    return figure
