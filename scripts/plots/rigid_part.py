"""A rigid bouncing part in place of the contact: velocities over the amplitude, where jumps begin and double."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from plots import style

MODELS = {
    "contact": ("o", style.CONVERGED),
    "rigid part, e(u)": ("s", style.EULER),
    "rigid part, one e": ("D", "#CC79A7"),
}


def draw_velocities(axes: Axes, rows: pd.DataFrame) -> None:
    """Mean velocities in both models; in chaos, where one run says nothing, points without a line."""
    for model, (marker, colour) in MODELS.items():
        of = rows[rows.model == model]
        regular = of.mean_velocity.where(of.state != "chaos")
        axes.plot(of.acceleration, regular, color=colour, linewidth=1.0)
        chaos = of[of.state == "chaos"]
        axes.plot(chaos.acceleration, chaos.mean_velocity, marker, color=colour, markersize=1.5, markeredgewidth=0)
    axes.set_title(f"start at $z_0$ = {1e3 * rows.z0.iloc[0]:g} mm")
    axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the table of the rigid part."""
    table = tables["rigid"]
    figure = style.figure(style.PAGE, 115.0)
    panels = figure.subplot_mosaic([["low", "high"], ["places", "places"]], height_ratios=[2.0, 1.0])
    velocities = table[table.kind == "velocity"]
    low, high = velocities.z0.min(), velocities.z0.max()
    for name, height in (("low", low), ("high", high)):
        draw_velocities(panels[name], velocities[velocities.z0 == height])
    panels["low"].set_ylabel("mean feeding velocity in m/s")
    panels["high"].sharey(panels["low"])

    places = panels["places"]
    for row, (model, (marker, colour)) in enumerate(MODELS.items()):
        found = table[(table.kind != "velocity") & (table.model == model)]
        places.plot(found.acceleration, [row] * len(found), marker, color=colour, markersize=4.0, label=model)
        if model == "contact":
            for bifurcation in found.itertuples():
                first = bifurcation.number == 1
                places.annotate(
                    bifurcation.kind if first else str(bifurcation.number),
                    (bifurcation.acceleration, row),
                    xytext=(0, 5),
                    textcoords="offset points",
                    ha="center",
                    size=7.0,
                )
    places.set_yticks(range(len(MODELS)), MODELS)
    places.set_ylim(len(MODELS) - 0.5, -0.8)
    places.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    places.grid(axis="x", linewidth=0.3)
    style.legend_above(figure, places, ncols=3)
    return figure
