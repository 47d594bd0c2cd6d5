"""Fig. 22: Lyapunov exponent of the feeding velocity by finite differences, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, critical_acceleration: float | None = None) -> Figure:
    """Draw estimates of the exponent over the amplitude, and mark `critical_acceleration` (m/s²)."""
    figure = style.figure(style.COLUMN, 62.0)
    axes = figure.subplots()
    axes.axhline(0.0, color="black", linewidth=0.6)
    for role, table in {"euler": euler, "converged": converged}.items():
        width = 1.6 if role == "euler" else 0.8
        axes.plot(table.acceleration, table["lambda"], style.line(table), linewidth=width, **style.LOOKS[role])
    if critical_acceleration is not None:
        style.mark(axes, critical_acceleration, f"{critical_acceleration:g} m/s²")
    axes.set_xlabel(style.AMPLITUDE)
    axes.set_ylabel("Lyapunov exponent of $\\dot{x}_p$ in 1/s")
    style.legend_above(figure, axes, ncols=2)
    return figure
