"""Parameters that the paper's numbers imply: friction alone, the valley of contacts, and posteriors."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from calibration.paper_findings import VELOCITIES
from figures import style

EVIDENCE = {
    "all": ("black", "-", "all numbers"),
    "end_left_out": (style.CONVERGED, "-", "without the upper end of Fig. 8"),
    "paper_method": (style.EULER, (0, (3, 2)), "the same, shifted by the error of the paper's method"),
}
TENSION = {"allow": ("o", "contact pulls"), "clip": ("^", "does not pull")}
FRICTIONS = {
    "first_low": (style.STATE_COLOURS["first"], (0, (3, 2)), "first state, lower end"),
    "first_high": (style.STATE_COLOURS["first"], "-", "first state, upper end"),
    "fall": (style.STATE_COLOURS["second"], "-", "fall of the second state"),
}
UNITS = {
    "friction": (1.0, "friction $\\mu$"),
    "damping": (1.0, "damping $d_c$ in N s/m"),
    "stiffness": (1e-5, "stiffness $k_c$ in 10$^5$ N/m$^{1.5}$"),
    "angle": (180.0 / np.pi, "angle of throw $\\varphi$ in °"),
}
TICKS = {
    "friction": [0.1, 0.2, 0.3, 0.4],
    "damping": [0.1, 0.2, 0.3, 0.5],
    "stiffness": [0.5, 1.0, 2.0, 5.0, 10.0],
    "angle": [8.0, 10.0, 12.0, 14.0, 16.0],
}
DRAWN, BINS = 600, 30  # points of the valley, and bins of the posterior of a parameter
SEED = 1  # of the choice of points


def draw_friction_alone(axes: Axes, frictions: pd.DataFrame, settings: dict) -> None:
    """Draw velocities over friction, thick where the claims accept them."""
    for column, (colour, line, label) in FRICTIONS.items():
        one = settings["numbers"][VELOCITIES[column]]
        axes.plot(frictions.friction, frictions[column], color=colour, linestyle=line, label=label)
        values = frictions[column].where(frictions[column].between(one["low"], one["high"]))
        axes.plot(frictions.friction, values, color=colour, linewidth=4.5, alpha=0.35, solid_capstyle="butt")
    printed = settings["model"]["friction"]
    axes.axvline(printed, ymax=0.75, color="black", linewidth=0.6, linestyle=":")  # ends below the legend
    style.note(axes, "printed", (printed, 0.02), (2, 0), xycoords=("data", "axes fraction"))
    axes.set_xlabel(UNITS["friction"][1])
    axes.set_ylabel("mean feeding velocity in cm/s")
    axes.legend(loc="upper left", handlelength=1.6, borderaxespad=0.0, labelspacing=0.25)
    axes.set_ylim(top=1.35 * frictions.first_high.max())


def draw_valley(axes: Axes, samples: pd.DataFrame, model: dict) -> None:
    """Draw damping over stiffness of points drawn from the posterior, coloured by the angle of throw."""
    rows = samples[samples.evidence == "end_left_out"]
    rows = rows.sample(DRAWN, replace=True, weights=rows.weight, random_state=SEED, ignore_index=True)
    degrees = UNITS["angle"][0] * rows.angle
    for tension, of_tension in rows.groupby("tension", sort=False):
        marker, label = TENSION[tension]
        colours = {"c": degrees[of_tension.index], "cmap": "viridis", "vmin": degrees.min(), "vmax": degrees.max()}
        look = {"marker": marker, "s": 7.0, "linewidths": 0.0, "rasterized": True, **colours}
        points = axes.scatter(UNITS["stiffness"][0] * of_tension.stiffness, of_tension.damping, label=label, **look)
    axes.plot(UNITS["stiffness"][0] * model["stiffness"], model["damping"], "k+", markersize=7.0)
    axes.set_yscale("log")
    axes.set_yticks(TICKS["damping"], [f"{tick:g}" for tick in TICKS["damping"]])
    axes.set_ylabel(UNITS["damping"][1])
    label_axis(axes, "stiffness")
    axes.legend(loc="upper left", handlelength=1.0, borderaxespad=0.0, labelspacing=0.25)
    axes.figure.colorbar(points, ax=axes, label=UNITS["angle"][1], pad=0.02, aspect=25)


def label_axis(axes: Axes, parameter: str) -> None:
    """Make the horizontal axis the logarithmic one of a parameter."""
    axes.set_xscale("log")
    axes.set_xticks(TICKS[parameter], [f"{tick:g}" for tick in TICKS[parameter]])
    axes.minorticks_off()
    axes.set_xlabel(UNITS[parameter][1])


def draw_posterior(axes: Axes, samples: pd.DataFrame, parameter: str, printed: float) -> None:
    """Draw the posterior of one parameter for each set of evidence, in bins of equal ratios."""
    scale = UNITS[parameter][0]
    edges = scale * np.geomspace(samples[parameter].min(), samples[parameter].max(), BINS + 1)
    for evidence, (colour, line, name) in EVIDENCE.items():
        rows = samples[samples.evidence == evidence]
        shares, _ = np.histogram(scale * rows[parameter], edges, weights=100.0 * rows.weight)
        axes.stairs(shares, edges, color=colour, linestyle=line, label=name)
    axes.axvline(scale * printed, color="black", linewidth=0.6, linestyle=":")
    label_axis(axes, parameter)


def plot(*, samples: pd.DataFrame, frictions: pd.DataFrame) -> Figure:
    """Draw the parameters that the paper's numbers imply."""
    figure = style.figure(style.PAGE, 118.0)
    upper, lower = figure.subfigures(2, 1)
    alone, contacts = upper.subplots(1, 2, width_ratios=(1.0, 1.15))
    model = samples.attrs["model"]
    draw_friction_alone(alone, frictions, frictions.attrs)
    draw_valley(contacts, samples, model)
    panels = lower.subplots(1, 4, sharey=True)
    for axes, parameter in zip(panels, UNITS, strict=True):
        draw_posterior(axes, samples, parameter, model[parameter])
    panels[0].set_ylabel("posterior in %")
    lower.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    style.letter(alone, contacts, *panels)
    return figure
