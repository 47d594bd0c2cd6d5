"""Fig. 3: mean feeding velocity over the acceleration amplitude, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

MARKERS = {
    "euler": {"markersize": 3.2, "markerfacecolor": "none", "markeredgewidth": 0.6},
    "converged": {"markersize": 1.6, "markeredgewidth": 0.0},
}


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, critical_acceleration: float | None = None) -> Figure:
    """Draw two sweeps over acceleration, and mark `critical_acceleration` (m/s²)."""
    figure = style.figure(style.COLUMN, 62.0)
    axes = figure.subplots()
    for role, sweep in {"euler": euler, "converged": converged}.items():
        rows = sweep.query("z0 == 0")
        axes.plot(rows.acceleration, rows.mean_velocity, "o", **style.LOOKS[role], **MARKERS[role])
    if critical_acceleration is not None:
        style.mark(axes, critical_acceleration, f"{critical_acceleration:g} m/s²")
    axes.set_xlabel(style.AMPLITUDE)
    style.velocity_axis(axes.yaxis)
    style.from_zero(axes)
    style.legend_above(figure, axes, ncols=2)
    return figure
