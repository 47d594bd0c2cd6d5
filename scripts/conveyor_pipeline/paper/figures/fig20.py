"""Fig. 20: Lyapunov exponent of z_p by finite differences in z0, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(
    *,
    converged: pd.DataFrame,
    edge: pd.DataFrame,
    euler: pd.DataFrame,
    first_positive: float | None = None,
) -> Figure:
    """Draw estimates and mark `first_positive` (m/s²).

    Amplitudes are shaded where a critical height of `edge` lies between the two initial heights of the estimate.
    """
    estimates = {"euler": euler, "converged": converged}
    figure = style.figure(style.COLUMN, 84.0)
    panels = figure.subplots(len(estimates), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, (role, table) in zip(panels, estimates.items(), strict=True):
        colour = style.LOOKS[role]["color"]
        between = edge.acceleration[edge.is_critical & (edge.z0 < table.attrs["epsilon"])]
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.plot(table.acceleration, table["lambda"], style.line(table), color=colour, linewidth=0.8)
        if len(between):
            axes.axvspan(between.min(), between.max(), color="0.88", linewidth=0.0, zorder=0)
            place = {"xycoords": ("data", "axes fraction"), "va": "bottom"}
            style.note(axes, "shaded: different\nbasins", (between.max(), 0.3), (3, 0), **place)
        if first_positive is not None:
            axes.axvline(first_positive, color="black", linewidth=0.6, linestyle=":")
            style.note(axes, f"{first_positive:g} m/s²", (first_positive, 0.0), (-3, -9), ha="right")
        axes.set_title(style.LOOKS[role]["label"], color=colour)
        axes.set_ylabel("exponent of $z_p$ in 1/s")
    panels[-1].set_xlabel(style.AMPLITUDE)
    return figure
