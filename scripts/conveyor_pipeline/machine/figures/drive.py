"""The Pareto front of drive design, with the recommended settings and the hypervolume over the generations."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from conveyor_pipeline.figures import style

SEEDS = (style.CONVERGED, style.SECOND_ESTIMATE, "black", "0.6")


def draw_checked(axes: Axes, checked: pd.DataFrame) -> None:
    """The 5 % quantile of the transit velocity of the checked designs, with bars up to the 95 % quantile."""
    velocity = 100.0 * checked.checked_velocity
    above = 100.0 * checked.checked_velocity_95 - velocity
    look = {"color": "black", "fmt": ".", "markersize": 2.5, "linewidth": 0.5, "capsize": 1.5}
    label = "transit of all parts: 5 % quantile, bar up to 95 %"
    axes.errorbar(checked.checked_impact_speed, velocity, [0.0 * above, above], label=label, **look)


def plot(*, front: pd.DataFrame, generations: pd.DataFrame) -> Figure:
    """Draw the front, and how its hypervolume grew."""
    figure = style.figure(style.PAGE, 80.0)
    pareto, growth = figure.subplots(1, 2, width_ratios=(1.7, 1.0))
    look = {"c": front.acceleration, "cmap": "cividis", "s": 10.0, "linewidths": 0.0}
    points = pareto.scatter(front.impact_speed, 100.0 * front.velocity, label="front of the search", **look)
    draw_checked(pareto, front[front.checked])
    chosen = front[front.recommended]
    ring = {"s": 50.0, "facecolors": "none", "edgecolors": style.EULER, "zorder": 3}
    pareto.scatter(chosen.checked_impact_speed, 100.0 * chosen.checked_velocity, label="recommended", **ring)
    pareto.set_xlabel("impact speed (95 % quantile) in m/s")
    pareto.set_ylabel("velocity of the slowest 5 % in cm/s")
    pareto.set_ylim(bottom=min(0.0, 105.0 * front.checked_velocity.min()))
    if front.empty:
        style.say(pareto, "no design within the constraints")
    else:
        figure.colorbar(points, ax=pareto, label=style.AMPLITUDE)
    last = generations.generation.max()
    growth.axvspan(3 * last // 4, last, color="0.92", linewidth=0.0)
    for colour, (seed, rows) in zip(SEEDS, generations.groupby("seed"), strict=False):
        growth.plot(rows.generation, 100.0 * rows.hypervolume, color=colour, label=f"seed {seed}")
    growth.set_xlabel("generation")
    growth.set_ylabel("hypervolume in % of that of all seeds")
    growth.set_xlim(1, last)
    growth.xaxis.set_major_locator(MaxNLocator(6, steps=(1, 2, 5, 10), integer=True))
    growth.set_ylim(0.0, 102.0)
    growth.legend(loc="lower right")
    style.legend_above(figure, pareto, ncols=3)
    return figure
