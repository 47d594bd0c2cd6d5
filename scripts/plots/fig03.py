"""Fig. 3: mean feeding velocity over the acceleration amplitude, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the sweeps `converged` and `euler`; settings: critical_acceleration, m/s²."""
    figure = style.figure(style.COLUMN, 62.0)
    axes = figure.subplots()
    converged, euler = (tables[role].query("z0 == 0") for role in ("converged", "euler"))
    axes.plot(
        euler.acceleration,
        euler.mean_velocity,
        "o",
        markersize=3.2,
        markerfacecolor="none",
        markeredgewidth=0.6,
        color=style.EULER,
        label=style.EULER_LABEL,
    )
    axes.plot(
        converged.acceleration,
        converged.mean_velocity,
        "o",
        markersize=1.6,
        markeredgewidth=0.0,
        color=style.CONVERGED,
        label=style.CONVERGED_LABEL,
    )
    style.mark(axes, settings["critical_acceleration"], f"{settings['critical_acceleration']:g} m/s²")
    axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    axes.set_ylabel("mean feeding velocity in m/s")
    axes.set_ylim(bottom=0.0)
    style.legend_above(figure, axes, ncols=2)
    return figure
