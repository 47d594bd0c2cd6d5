"""Valley of nearly equal fits of Eq. 13: error and parameters along it, and the curves of some of its points."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.figure import Figure

from conveyor.analysis.basins.hyperbola import Hyperbola, critical_height
from figures import style

MARKERS = {
    "pymoo": ("o", style.CONVERGED, "pymoo"),
    "least_squares": ("+", "black", "least squares"),
    "paper": ("D", style.EULER, "$A$, $B$, $C$ of the paper"),
}
CURVES = 5  # in panel c


def plot(*, converged: pd.DataFrame, fit: pd.DataFrame, fit_euler: pd.DataFrame, paper_error: float) -> Figure:
    """Draw the fits of the critical heights `converged`, and mark the error `paper_error` (m²)."""
    figure = style.figure(style.PAGE, 62.0)
    errors, triples, heights = figure.subplots(1, 3)
    valley = fit[fit.fit == "valley"]
    flat = valley[valley.error <= paper_error]

    errors.axhline(1e6 * paper_error**0.5, color="black", linewidth=0.6, linestyle=":")
    style.note(
        errors,
        "paper's fit",
        (1.0, 1e6 * paper_error**0.5),
        (0, -2),
        xycoords=("axes fraction", "data"),
        ha="right",
        va="top",
    )
    fits = (
        (fit, style.CONVERGED, "fit to the converged solution"),
        (fit_euler, style.EULER, "fit to the published method"),
    )
    for table, colour, label in fits:
        curve = table[table.fit == "valley"]
        errors.plot(curve.B, 1e6 * curve.error**0.5, color=colour, linewidth=0.8, label=label)
    errors.set_yscale("log")
    errors.set_yticks([4.0, 6.0, 10.0, 20.0], ["4", "6", "10", "20"])
    errors.minorticks_off()
    errors.set_ylabel("smallest rms deviation in µm")
    errors.set_ylim(top=2.0 * errors.get_ylim()[1])  # room for the legend above the curves
    errors.legend(loc="upper right", handlelength=1.2)

    triples.plot(1e3 * valley.A, 1e3 * valley.C, color="0.6", linewidth=0.8, label="best $A$ and $C$ for each $B$")
    triples.plot(1e3 * flat.A, 1e3 * flat.C, color="0.6", linewidth=4.0, alpha=0.5, label="error ≤ paper's fit")
    triples.set_xlabel("$A$ in 10$^{-3}$ m²/s²")
    triples.set_ylabel("$C$ in mm")
    for name, (marker, colour, label) in MARKERS.items():
        row = fit[fit.fit == name].iloc[0]
        style_of = {"marker": marker, "color": colour, "linestyle": "", "markersize": 4.0, "markerfacecolor": "none"}
        errors.plot(row.B, 1e6 * row.error**0.5, **style_of)
        triples.plot(1e3 * row.A, 1e3 * row.C, **style_of, label=label)
    # Room for the legend below the curve.
    triples.set_ylim(bottom=1e3 * (valley.C.min() - 0.6 * np.ptp(valley.C)))
    triples.legend(loc="lower left")
    errors.set_xlabel("$B$ in m/s²")

    range_of_fit = np.linspace(*fit.attrs["acceleration"], 200)
    for index, shade in zip(
        np.linspace(0, len(flat) - 1, CURVES).astype(int), np.linspace(0.0, 0.9, CURVES), strict=True
    ):
        row = flat.iloc[index]
        curve = critical_height(range_of_fit, Hyperbola(row.A, row.B, row.C))
        colour = colormaps["viridis"](shade)
        heights.plot(range_of_fit, 1e3 * curve, color=colour, linewidth=0.6, label=f"$B = {row.B:.1f}$ m/s²")
    edge = converged[converged.is_critical]
    heights.plot(
        edge.acceleration,
        1e3 * edge.z0,
        ".",
        color="black",
        markersize=2.0,
        markeredgewidth=0.0,
        label="converged solution",
    )
    heights.set_xlabel(style.AMPLITUDE)
    heights.set_ylabel("critical initial height $z_0$ in mm")
    heights.legend()
    for axes, letter in zip((errors, triples, heights), "abc", strict=True):
        axes.set_title(letter, loc="left", fontweight="bold")
    return figure
