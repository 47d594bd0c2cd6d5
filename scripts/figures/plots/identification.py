"""Parameters that the paper's numbers imply: friction alone, Pareto fronts of the misfits, profiles of parameters."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from figures import style
from identification.findings import VELOCITIES, lowest_profile
from identification.misfits import OBJECTIVES, root_mean_square
from identification.search_space import PARAMETERS

EVIDENCE = {
    "all": ("black", "-", "all numbers"),
    "end_left_out": (style.CONVERGED, "-", "without the upper end of Fig. 8"),
    "paper_method": (style.EULER, (0, (3, 2)), "the same, shifted by the error of the paper's method"),
}
READINGS = {
    "allow": ("o", style.CONVERGED, "contact pulls"),
    "frictionless": ("x", "0.4", "pulls, without friction"),
    "clip": ("^", style.EULER, "does not pull"),
}
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
MOST = 25.0  # largest total misfit on the axis


def draw_friction_alone(axes: Axes, frictions: pd.DataFrame, numbers: pd.DataFrame, printed: float) -> None:
    """Draw velocities over friction, thick where the claims accept them."""
    by_name = numbers.drop_duplicates("number").set_index("number")
    for column, (colour, line, label) in FRICTIONS.items():
        one = by_name.loc[VELOCITIES[column]]
        axes.plot(frictions.friction, frictions[column], color=colour, linestyle=line, label=label)
        values = frictions[column].where(frictions[column].between(one.low, one.high))
        axes.plot(frictions.friction, values, color=colour, linewidth=4.5, alpha=0.35, solid_capstyle="butt")
    axes.axvline(printed, ymax=0.75, color="black", linewidth=0.6, linestyle=":")  # ends below the legend
    style.note(axes, "printed", (printed, 0.02), (2, 0), xycoords=("data", "axes fraction"))
    axes.set_xlabel(UNITS["friction"][1])
    axes.set_ylabel("mean feeding velocity in cm/s")
    axes.legend(loc="upper left", handlelength=1.6, borderaxespad=0.0, labelspacing=0.25)
    axes.set_ylim(top=1.35 * frictions.first_high.max())


def printed_misfit(numbers: pd.DataFrame, names: list[str]) -> float:
    """An objective at the printed parameters, by the converged solution."""
    rows = numbers[(numbers["set"] == "printed") & (numbers.method == "converged") & numbers.number.isin(names)]
    return float(root_mean_square(rows.misfit.to_numpy()))


def draw_fronts(axes: Axes, table: pd.DataFrame, numbers: pd.DataFrame) -> None:
    """Draw the velocity misfits of all members of the fronts and of the printed parameters."""
    groups = table.attrs["objectives"]
    x, y = "first_velocity", "second_velocity"
    for reading, (marker, colour, label) in READINGS.items():
        rows = table[(table.tension == reading) & (table[[*OBJECTIVES]] <= table.attrs["search"]["worst"]).all(axis=1)]
        look = {"color": colour, "markersize": 2.0, "markeredgewidth": 0.4, "markerfacecolor": "none"}
        axes.plot(rows[x], rows[y], marker, **look, label=label, rasterized=True)
    printed = printed_misfit(numbers, groups[x]), printed_misfit(numbers, groups[y])
    axes.plot(*printed, "k+", markersize=7.0, label="printed parameters")
    most = 1.6 * max(printed)
    axes.set_xlim(0.0, most)
    axes.set_ylim(0.0, most)
    axes.set_xlabel("misfit of the first state's velocity")
    axes.set_ylabel("misfit of the second state's fall")
    axes.legend(loc="upper right", handlelength=1.0, borderaxespad=0.0, labelspacing=0.25)


def draw_valley(axes: Axes, profiles: pd.DataFrame, optima: pd.DataFrame, model: dict) -> None:
    """Draw damping over stiffness of all fits within the joint confidence region, coloured by the angle of throw."""
    rows = profiles.merge(optima[["evidence", "tension", "rise_of_all"]], on=["evidence", "tension"])
    rows = rows[rows.evidence == "end_left_out"]
    rows = rows[rows.total <= rows.total.min() + rows.rise_of_all]
    scale, degrees = UNITS["stiffness"][0], UNITS["angle"][0] * rows.angle
    for reading, of_reading in rows.groupby("tension", sort=False):
        marker, _, label = READINGS[reading]
        colours = {"c": degrees[of_reading.index], "cmap": "viridis", "vmin": degrees.min(), "vmax": degrees.max()}
        look = {"marker": marker, "s": 9.0, "linewidths": 0.0, **colours}
        points = axes.scatter(scale * of_reading.stiffness, of_reading.damping, label=label, **look)
    axes.plot(scale * model["stiffness"], model["damping"], "k+", markersize=7.0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks([0.5, 1.0, 2.0, 5.0, 10.0], ["0.5", "1", "2", "5", "10"])
    axes.set_yticks([0.1, 0.2, 0.3, 0.5], ["0.1", "0.2", "0.3", "0.5"])
    axes.minorticks_off()
    axes.set_xlabel(UNITS["stiffness"][1])
    axes.set_ylabel(UNITS["damping"][1])
    axes.legend(loc="upper left", handlelength=1.0, borderaxespad=0.0, labelspacing=0.25)
    axes.figure.colorbar(points, ax=axes, label=UNITS["angle"][1], pad=0.02, aspect=25)


def draw_profile(axes: Axes, profiles: pd.DataFrame, optima: pd.DataFrame, parameter: str, printed: float) -> None:
    """Draw the least total misfit over one parameter for each set of evidence, and its confidence level."""
    scale, label = UNITS[parameter]
    for evidence, (colour, line, name) in EVIDENCE.items():
        profile = lowest_profile(profiles, evidence, parameter)
        rows = optima[optima.evidence == evidence]
        axes.plot(scale * profile[parameter], profile.total, color=colour, linestyle=line, label=name)
        level = rows.total.min() + rows.rise.iloc[0]
        axes.axhline(level, color=colour, linestyle=line, linewidth=0.4)
    axes.axvline(scale * printed, color="black", linewidth=0.6, linestyle=":")
    axes.set_ylim(0.0, MOST)
    axes.set_xlabel(label)


def plot(
    *, printed: pd.DataFrame, front: pd.DataFrame, profiles: pd.DataFrame, optima: pd.DataFrame, frictions: pd.DataFrame
) -> Figure:
    """Draw the tables of the stage identification."""
    figure = style.figure(style.PAGE, 122.0)
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.0, 1.0))
    alone, velocities, contacts = upper.subplots(1, 3, width_ratios=(1.0, 0.9, 1.15))
    model = profiles.attrs["model"]
    draw_friction_alone(alone, frictions, printed, model["friction"])
    draw_fronts(velocities, front, printed)
    draw_valley(contacts, profiles, optima, model)
    panels = lower.subplots(1, 4, sharey=True)
    for axes, parameter in zip(panels, PARAMETERS, strict=True):
        draw_profile(axes, profiles, optima, parameter, model[parameter])
    panels[0].set_ylabel("least total misfit")
    lower.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    for axes, letter in zip((alone, velocities, contacts, *panels), "abcdefg", strict=True):
        axes.set_title(letter, loc="left", fontweight="bold")
    return figure
