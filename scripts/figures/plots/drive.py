"""The Pareto front of drive design, with the recommended settings and the hypervolume over the generations."""

import pandas as pd
from matplotlib.figure import Figure

from figures import style


def plot(*, front: pd.DataFrame, generations: pd.DataFrame) -> Figure:
    """Draw the front, and how its hypervolume grew."""
    figure = style.figure(style.PAGE, 76.0)
    pareto, growth = figure.subplots(1, 2, width_ratios=(1.7, 1.0))
    points = pareto.scatter(
        front.impact_speed, front.velocity, c=front.acceleration, s=14.0, cmap="cividis", label="front of the search"
    )
    checked = front[front.checked]
    pareto.errorbar(
        checked.impact_speed,
        checked.checked_velocity,
        yerr=2.0 * checked.velocity_stderr,
        color="black",
        linestyle="none",
        marker="_",
        markersize=6.0,
        linewidth=0.8,
        capsize=2.0,
        label="operating run, two standard errors",
    )
    chosen = front[front.recommended]
    pareto.scatter(
        chosen.impact_speed, chosen.velocity, s=60.0, facecolors="none", edgecolors=style.EULER, label="recommended"
    )
    pareto.set_xlabel("impact speed in m/s")
    pareto.set_ylabel("velocity of nearly all\ninitial conditions in m/s")
    figure.colorbar(points, ax=pareto, label=style.AMPLITUDE)
    for seed, rows in generations.groupby("seed"):
        growth.plot(rows.generation, 100.0 * rows.hypervolume, label=f"seed {seed}")
    growth.set_xlabel("generation")
    growth.set_ylabel("hypervolume in % of that of all seeds")
    style.from_zero(growth)
    growth.legend(loc="lower right")
    style.legend_above(figure, pareto, ncols=3)
    return figure
