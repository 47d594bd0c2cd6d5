"""Switching on and off: velocities, and the share of parts that jump, over the amplitude on the way up and down."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.operating.populations import FAST, VARIED
from conveyor_pipeline.machine.operating.ramps import AT_REST, DOWN, SLOWLY, STAY, UP

COLOURS = {UP: "#0072B2", DOWN: "#D55E00"}


def draw_ways(velocities: Axes, shares: Axes, rows: pd.DataFrame) -> None:
    """Draw median and slowest 5 %, and the share of parts that jump, by the way of the amplitude."""
    for way, group in rows[rows.way != STAY].groupby("way", sort=False):
        look = {"color": COLOURS[way], "linewidth": 1.2}
        velocities.plot(group.acceleration, 100.0 * group.velocity_50, label=f"{way}: median", **look)
        slowest = {"linestyle": (0, (3, 2)), "label": f"{way}: slowest 5 %"}
        velocities.plot(group.acceleration, 100.0 * group.velocity_05, **look | {"linewidth": 0.8} | slowest)
        shares.plot(group.acceleration, 100.0 * group.jumping, **look)
    velocities.axhline(0.0, color="black", linewidth=0.4, zorder=0)
    velocities.set_ylabel("velocity in cm/s")
    shares.set_ylabel("jumping parts in %")
    shares.set_ylim(-4.0, 104.0)
    shares.set_xlabel(style.AMPLITUDE)


def draw_stay(velocities: Axes, shares: Axes, motion: pd.DataFrame) -> None:
    """Draw what parts do at the full amplitude: a dot for the median, an open one for the slowest 5 %."""
    look = {"color": "black", "linestyle": "none", "marker": "o", "markersize": 4.0}
    velocities.plot(motion.acceleration, 100.0 * motion.velocity_50, **look, label="stays: median")
    open_one = look | {"markerfacecolor": "none"}
    velocities.plot(motion.acceleration, 100.0 * motion.velocity_05, **open_one, label="stays: slowest 5 %")
    shares.plot(motion.acceleration, 100.0 * motion.jumping, **look)


def plot(*, start: pd.DataFrame, limits: pd.DataFrame, motions: pd.DataFrame) -> Figure:
    """Draw slow ramps on the left, and the switched drive at the fast amplitude on the right."""
    figure = style.figure(style.PAGE, 108.0)
    panels = figure.subplots(2, 2, sharex="col", height_ratios=(1.4, 1.0))
    draw_ways(panels[0, 0], panels[1, 0], start[start.aim == SLOWLY])
    style.limit_x(panels[1, 0], start.acceleration[start.aim == SLOWLY])
    half = limits[(limits.population == VARIED) & (limits.share == 0.5)].dropna(subset="acceleration")
    for row in half.itertuples():
        for axes in panels[:, 0]:
            axes.axvline(row.acceleration, color=COLOURS[row.way], linewidth=0.8, linestyle=":")
    switched = start[(start.aim == FAST) & (start.parts == AT_REST)]
    if len(switched):
        draw_ways(panels[0, 1], panels[1, 1], switched)
        draw_stay(panels[0, 1], panels[1, 1], motions[(motions.aim == FAST) & (motions.parts == AT_REST)])
    else:
        for axes in panels[:, 1]:
            style.say(axes, "no amplitude is recommended")
    for axes, title in zip(panels[0], ("slowly", f"within {start.attrs['rise']:g} s"), strict=True):
        axes.set_title(title)
    handles, labels = (panels[0, 1] if len(switched) else panels[0, 0]).get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, columnspacing=1.2)
    style.letter(*panels.T.flat)
    return figure
