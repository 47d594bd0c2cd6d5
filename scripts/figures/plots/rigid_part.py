"""A rigid bouncing part in place of the compliant contact: velocities, fold and period doublings over the amplitude."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures import style

MODELS = {
    "contact": ("o", style.CONVERGED, "compliant contact"),
    "rigid part, e(u)": ("s", style.EULER, "rigid part, restitution $e(u)$"),
    "rigid part, one e": ("D", "#CC79A7", "rigid part, constant $e$"),
}
ORDINALS = {1: "first period doubling", 2: "second", 3: "third"}


def draw_velocities(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw mean velocities in both models. Points, not lines: neighbours may lie in different transients."""
    for model, (marker, colour, _) in MODELS.items():
        selected = rows[rows.model == model]
        look = {"color": colour, "markersize": 1.8, "markeredgewidth": 0.0}
        axes.plot(selected.acceleration, selected.mean_velocity, marker, **look)
    axes.set_title(f"initial height $z_0$ = {1e3 * rows.z0.iloc[0]:g} mm")
    axes.set_xlabel(style.AMPLITUDE)


def plot(*, rigid: pd.DataFrame) -> Figure:
    """Draw velocities, folds and period doublings of a rigid part and of the compliant contact."""
    figure = style.figure(style.PAGE, 115.0)
    panels = figure.subplot_mosaic([["low", "high"], ["places", "places"]], height_ratios=[2.0, 1.0])
    velocities = rigid[rigid.kind == "velocity"]
    low, high = velocities.z0.min(), velocities.z0.max()
    for name, height in (("low", low), ("high", high)):
        draw_velocities(panels[name], velocities[velocities.z0 == height])
    panels["low"].set_ylabel(style.VELOCITY)
    panels["high"].sharey(panels["low"])

    places = panels["places"]
    for row, (model, (marker, colour, label)) in enumerate(MODELS.items()):
        found = rigid[(rigid.kind != "velocity") & (rigid.model == model)]
        places.plot(found.acceleration, [row] * len(found), marker, color=colour, markersize=4.0, label=label)
        if model == "contact":
            for bifurcation in found.itertuples():
                number = bifurcation.number
                name = "fold" if bifurcation.kind == "fold" else ORDINALS.get(number, str(number))
                align = "left" if number == len(ORDINALS) else "right"
                style.note(places, name, (bifurcation.acceleration, row), (0, 5), ha=align)
    places.set_yticks([])
    places.set_ylim(len(MODELS) - 0.5, -0.8)
    places.set_xlabel(style.AMPLITUDE)
    places.grid(axis="x", linewidth=0.3)
    style.legend_above(figure, places, ncols=3, fontsize=7.0)
    return figure
