"""Fig. 9: mean feeding velocity over the initial height for several amplitudes."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, critical_height: float | None = None) -> Figure:
    """Draw sweeps over acceleration and z0, and mark `critical_height` (m)."""
    figure = style.figure(style.PAGE, 72.0)
    sweeps = {"euler": euler, "converged": converged}
    panels = style.velocity_panels(figure, sweeps, "initial height $z_0$ in mm")
    for axes, sweep in zip(panels, sweeps.values(), strict=True):
        curves = sweep.groupby("acceleration")
        # The palest end of the colour map would be lost on white.
        colours = colormaps["viridis"](np.linspace(0.0, 0.85, len(curves)))
        for colour, (acceleration, rows) in zip(colours, curves, strict=True):
            axes.plot(1e3 * rows.z0, rows.mean_velocity, color=colour, linewidth=0.8, label=f"{acceleration:g} m/s²")
        if critical_height is not None:
            style.mark(axes, 1e3 * critical_height, f"{1e3 * critical_height:g} mm")
    low, high = (pd.concat(sweeps.values()).mean_velocity.agg(name) for name in ("min", "max"))
    if low < high:
        panels[0].set_ylim(1.15 * min(low, 0.0), 1.15 * max(high, 0.0))
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right center", title="$\\hat{a}$")
    return figure
