"""Valley of nearly equal fits of Eq. 13: error and parameters along it, and the curves of some of its points."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.paper.claims.about_states import flat_part
from conveyor_pipeline.paper.fit.hyperbola import Hyperbola, critical_height

MARKERS = {
    "pymoo": ("o", style.CONVERGED, "pymoo"),
    "least_squares": ("+", "black", "least squares"),
    "paper": ("D", style.EULER, "$A$, $B$, $C$ of the paper"),
}
CURVES = 5  # in panel c


def marks(fit: pd.DataFrame) -> list[tuple[pd.Series, dict, str]]:
    """The single fits of a table: row, look and label of each."""
    return [
        (
            fit[fit.fit == name].iloc[0],
            {"marker": marker, "color": colour, "linestyle": "", "markersize": 4.0, "markerfacecolor": "none"},
            label,
        )
        for name, (marker, colour, label) in MARKERS.items()
    ]


def draw_errors(axes: Axes, fit: pd.DataFrame, fit_euler: pd.DataFrame, paper_error: float | None) -> None:
    """Draw the smallest error for each B, and the error that the paper prints (m²)."""
    if paper_error is not None:
        paper = 1e6 * paper_error**0.5
        axes.axhline(paper, color="black", linewidth=0.6, linestyle=":")
        place = {"xycoords": ("axes fraction", "data"), "ha": "right", "va": "top"}
        style.note(axes, "printed error", (1.0, paper), (0, -2), **place)
    fits = (
        (fit, style.CONVERGED, "fit to the converged solution"),
        (fit_euler, style.EULER, "fit to the paper's method"),
    )
    for table, colour, label in fits:
        curve = table[table.fit == "valley"]
        axes.plot(curve.B, 1e6 * curve.error**0.5, color=colour, linewidth=0.8, label=label)
    for row, look, _ in marks(fit):
        axes.plot(row.B, 1e6 * row.error**0.5, **look)
    axes.set_yscale("log")
    axes.set_yticks([4.0, 6.0, 10.0, 20.0], ["4", "6", "10", "20"])
    axes.minorticks_off()
    axes.set_ylim(top=2.0 * axes.get_ylim()[1])  # room for the legend above the curves
    axes.set_xlabel("$B$ in m/s²")
    axes.set_ylabel("smallest rms deviation in µm")
    axes.legend(loc="upper right", handlelength=1.2)


def draw_parameters(axes: Axes, fit: pd.DataFrame, flat: pd.DataFrame) -> None:
    """Draw A and C of the best fit for each B, wide for the fits in `flat`."""
    valley = fit[fit.fit == "valley"]
    axes.plot(1e3 * valley.A, 1e3 * valley.C, color="0.6", linewidth=0.8, label="best $A$ and $C$ for each $B$")
    axes.plot(1e3 * flat.A, 1e3 * flat.C, color="0.6", linewidth=4.0, alpha=0.5, label="error ≤ paper's triple")
    for row, look, label in marks(fit):
        axes.plot(1e3 * row.A, 1e3 * row.C, **look, label=label)
    axes.set_xlabel("$A$ in 10$^{-3}$ m²/s²")
    axes.set_ylabel("$C$ in mm")
    # Room for the legend below the curve.
    axes.set_ylim(bottom=1e3 * (valley.C.min() - 0.75 * np.ptp(valley.C)))
    axes.legend(loc="lower left")


def draw_heights(axes: Axes, converged: pd.DataFrame, flat: pd.DataFrame, acceleration: list[float]) -> None:
    """Draw some fits of `flat` over the amplitudes of the fit (m/s²), and the critical heights there."""
    amplitudes = np.linspace(*acceleration, 200)
    places = np.linspace(0, len(flat) - 1, CURVES).astype(int)
    for place, shade in zip(places, np.linspace(0.0, 0.9, CURVES), strict=True):
        row = flat.iloc[place]
        curve = critical_height(amplitudes, Hyperbola(row.A, row.B, row.C))
        colour = colormaps["viridis"](shade)
        axes.plot(amplitudes, 1e3 * curve, color=colour, linewidth=0.6, label=f"$B = {row.B:.1f}$ m/s²")
    edge = converged[converged.is_critical & converged.acceleration.between(*acceleration)]
    style.dots(axes, edge.acceleration, 1e3 * edge.z0, "black", 2.0, label="converged solution")
    axes.set_xlabel(style.AMPLITUDE)
    axes.set_ylabel("critical initial height $z_0$ in mm")
    axes.legend()


def plot(
    *, converged: pd.DataFrame, fit: pd.DataFrame, fit_euler: pd.DataFrame, paper_error: float | None = None
) -> Figure:
    """Draw the fits of the critical heights `converged`, and mark the printed error `paper_error` (m²)."""
    figure = style.figure(style.PAGE, 62.0)
    panels = figure.subplots(1, 3)
    flat = flat_part(fit)
    draw_errors(panels[0], fit, fit_euler, paper_error)
    draw_parameters(panels[1], fit, flat)
    draw_heights(panels[2], converged, flat, fit.attrs["acceleration"])
    style.letter(*panels)
    return figure
