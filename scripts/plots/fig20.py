"""Fig. 20: Lyapunov exponent of z_p by finite differences in z0, published method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the estimates `converged`, `published` and the critical heights `edge`; settings: first_positive, m/s²."""
    figure = style.figure(style.COLUMN, 62.0)
    axes = figure.subplots()
    axes.axhline(0.0, color="black", linewidth=0.6)
    published, converged, edge = tables["published"], tables["converged"], tables["edge"]
    between = edge.acceleration[edge.is_critical & (edge.z0 < converged.attrs["epsilon"])]
    axes.axvspan(between.min(), between.max(), color="0.9", linewidth=0.0, label="neighbours in different basins")
    axes.plot(published.acceleration, published["lambda"], color=style.PUBLISHED, label=style.PUBLISHED_LABEL)
    axes.plot(converged.acceleration, converged["lambda"], color=style.CONVERGED, label=style.CONVERGED_LABEL)
    style.mark(axes, settings["first_positive"], f"{settings['first_positive']:g} m/s²")
    axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    axes.set_ylabel("Lyapunov exponent of $z_p$ in 1/s")
    axes.legend(loc="lower right")
    return figure
