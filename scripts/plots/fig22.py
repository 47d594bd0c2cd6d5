"""Fig. 22: Lyapunov exponent of the feeding velocity by finite differences, published method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the estimates `converged` and `published`; settings: critical_acceleration, m/s²."""
    figure = style.figure(style.COLUMN, 62.0)
    axes = figure.subplots()
    axes.axhline(0.0, color="black", linewidth=0.6)
    published, converged = tables["published"], tables["converged"]
    axes.plot(published.acceleration, published["lambda"], color=style.PUBLISHED, label=style.PUBLISHED_LABEL)
    axes.plot(converged.acceleration, converged["lambda"], color=style.CONVERGED, label=style.CONVERGED_LABEL)
    style.mark(axes, settings["critical_acceleration"], f"{settings['critical_acceleration']:g} m/s²")
    axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    axes.set_ylabel("Lyapunov exponent of $\\dot{x}_p$ in 1/s")
    axes.legend(loc="upper left")
    return figure
