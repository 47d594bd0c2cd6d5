"""Parts as bodies: a landing block, velocities of several shapes, and where a point mass has the right velocity."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.operating.body_limits import MOTIONS, RIGHT

COLOURS = ("0.25", "#0072B2", "#D55E00", "#009E73")


def draw_landing(axes: Axes, landing: pd.DataFrame) -> None:
    """The lower edge of the block above the plate at each time, side by side; heights are exaggerated."""
    heights = 1e6 * (landing[["rear", "front", "plate"]] - landing.plate.min())  # µm
    for place, row in enumerate(heights.itertuples()):
        rear, front = place + 0.12, place + 0.88
        axes.plot([place, place + 1.0], [row.plate, row.plate], color="0.6", linewidth=1.0)
        axes.plot([rear, front], [row.rear, row.front], color=COLOURS[1], linewidth=1.6)
        for x, z in ((rear, row.rear), (front, row.front)):
            axes.plot([x, x], [z, z + 60.0], color=COLOURS[1], linewidth=0.8)
        time = f"{landing.time[row.Index]:+.2f}"
        axes.text(place + 0.5, -0.02, time, transform=axes.get_xaxis_transform(), ha="center", va="top")
    axes.set_xticks([])
    axes.set_xlabel("time in cycles after the first contact", labelpad=12.0)
    axes.set_ylabel("height in µm")


def draw_map(axes: Axes, shapes: pd.DataFrame, motion: str) -> None:
    """The relative difference of the median from that of points, over length and height; full cells are right."""
    rows = shapes[shapes.motion == motion]
    for row in rows.itertuples():
        right = abs(row.difference) <= RIGHT
        place, colour, fill = (row.length, row.height), COLOURS[0 if right else 2], "full" if right else "none"
        axes.plot(*place, "s", color=colour, fillstyle=fill, markersize=17.0)
        if np.isfinite(row.difference):
            text = f"{100.0 * row.difference:+.0f}" if row.difference < 1.0 else f"×{1.0 + row.difference:.2g}"
            axes.text(*place, text, ha="center", va="center", color="white" if right else "black", fontsize=7)
    axes.set(xscale="log", yscale="log", xlabel=r"length in $g\,\cos\alpha/\omega^2$")
    first = rows.iloc[0]
    axes.set_title(f"{first.acceleration:.3g} m/s²: {100.0 * first.points_ride:.0f} % of points ride")
    axes.margins(0.12)


def plot(*, bodies: pd.DataFrame, shapes: pd.DataFrame, landing: pd.DataFrame) -> Figure:
    """Draw a landing, velocities, shares and tilts over the amplitude, and three maps."""
    figure = style.figure(style.PAGE, 165.0)
    above, middle, below = figure.subfigures(3, 1, height_ratios=(0.75, 1.15, 1.1))
    land = above.subplots()
    draw_landing(land, landing)
    fast, ride, tilt = middle.subplots(1, 3, width_ratios=(1.6, 1.0, 1.0))
    shapes_of_curves = bodies.groupby(["length", "height"], sort=False, dropna=False)
    for colour, ((length, height), rows) in zip(COLOURS, shapes_of_curves, strict=False):
        name = "point" if np.isnan(length) else f"length {length:.3g}, height/length {height:g}"
        low, median, high = (100.0 * rows[column] for column in ("velocity_05", "velocity_50", "velocity_95"))
        fast.plot(rows.acceleration, median, color=colour, label=name)
        fast.fill_between(rows.acceleration, low, high, color=colour, alpha=0.15, linewidth=0.0)
        ride.plot(rows.acceleration, 100.0 * rows.rides, color=colour)
        tilt.plot(rows.acceleration, rows.largest_tilt, color=colour)
    labels = "transit velocity in cm/s", "parts that ride in %", "largest tilt in rad"
    for axes, label in zip((fast, ride, tilt), labels, strict=True):
        style.limit_x(axes, bodies.acceleration)
        axes.set_xlabel(style.AMPLITUDE if axes is fast else r"$\hat a$ in m/s²")
        axes.set_ylabel(label)
    middle.legend(*fast.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    maps = below.subplots(1, 3, sharey=True)
    for axes, motion in zip(maps, MOTIONS, strict=True):
        draw_map(axes, shapes, motion)
    maps[0].set_ylabel("relative height (height / length)")
    style.letter(land, fast, ride, tilt, *maps)
    return figure
