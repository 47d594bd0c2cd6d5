"""Error against work: all methods in three scenes, and the estimators of exponent, dimension and fit."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from plots import style

SCENES = {"jumping": "jumping", "riding": "always in contact", "bouncing": "micro-bounces"}
# (method, treatment): label, colour, marker.
LOOKS = {
    ("event", "exact"): ("this solver", style.CONVERGED, "o"),
    ("euler", "fixed step"): ("Euler", style.PUBLISHED, "D"),
    ("semi_implicit_euler", "fixed step"): ("semi-implicit Euler", "#E69F00", "s"),
    ("rk4", "fixed step"): ("RK4", "#CC79A7", "^"),
    ("RK45", "sign"): ("RK45, sign", "0.65", "<"),
    ("DOP853", "sign"): ("DOP853, sign", "0.65", ">"),
    ("Radau", "sign"): ("Radau, sign", "0.65", "v"),
    ("LSODA", "sign"): ("LSODA, sign", "0.65", "p"),
    ("RK45", "modes"): ("RK45, modes", "black", "<"),
    ("DOP853", "modes"): ("DOP853, modes", "black", ">"),
    ("Radau", "modes"): ("Radau, modes", "black", "v"),
    ("LSODA", "modes"): ("LSODA, modes", "black", "p"),
}
LEAST, LARGEST = 1e-14, 1.0
TOP = 10.0  # room for the crosses of failed runs
QUANTITIES = {
    "exponent": ("simulated cycles", "relative error of $\\lambda_1$"),
    "dimension": ("points", "error of the dimension"),
    "fit": ("evaluations", "relative gap to the best fit"),
}


def draw_scene(axes: Axes, table: pd.DataFrame, work: str, published_step: float) -> None:
    """Error of the mean velocity over one measure of work; failed runs as crosses at the upper edge."""
    for (method, treatment), (label, colour, marker) in LOOKS.items():
        rows = table[(table.method == method) & (table.treatment == treatment)]
        good = rows[rows.outcome == "ok"].sort_values(work)
        failed = rows[rows.outcome != "ok"]
        own = method == "event"
        axes.plot(
            good[work],
            good.velocity_error.clip(LEAST, LARGEST),
            marker=marker,
            color=colour,
            markersize=3.5 if own else 2.5,
            linewidth=1.4 if own else 0.6,
            markerfacecolor=colour if own else "white",
            markeredgewidth=0.6,
            label=label,
            zorder=3 if own else 2,
        )
        published = good[np.isclose(good.step.astype(float), published_step)]
        if method == "euler":
            axes.plot(published[work], published.velocity_error, marker, color=colour, markersize=5.0, zorder=4)
        axes.plot(failed[work], np.full(len(failed), LARGEST), "x", color=colour, markersize=3.5)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(LEAST, TOP)
    axes.set_yticks(10.0 ** np.arange(-14, 1, 4))


def failures(table: pd.DataFrame) -> str:
    """What went wrong in a scene, counted."""
    counts = table[table.outcome != "ok"].outcome.value_counts()
    return "failed: " + (", ".join(f"{count} {outcome}" for outcome, count in counts.items()) or "none")


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the tables of work and times of the scenes and that of the estimators; settings: published_step, s."""
    figure = style.figure(style.PAGE, 200.0)
    panels = figure.subplots(3, 3)
    keys = ["method", "treatment", "tolerance", "step"]
    for column, (scene, title) in enumerate(SCENES.items()):
        table = tables[scene].merge(tables[f"{scene}_times"], on=keys)
        for row, work in enumerate(("seconds", "evaluations")):
            draw_scene(panels[row, column], table, work, settings["published_step"])
        panels[0, column].set_title(f"{title}\n{failures(table)}", size=7.0)
        panels[0, column].set_xlabel("wall time in s")
        panels[1, column].set_xlabel("force evaluations")
    for row in range(2):
        panels[row, 0].set_ylabel("relative error of the mean velocity")
    estimators = tables["estimators"]
    colours = (style.PUBLISHED, "black", style.CONVERGED)
    for axes, (quantity, (work, label)) in zip(panels[2], QUANTITIES.items(), strict=True):
        rows = estimators[estimators.quantity == quantity]
        for colour, (name, curve) in zip(colours, rows.groupby("estimator", sort=False), strict=False):
            axes.loglog(curve.work, curve.error.clip(lower=1e-16), ".-", color=colour, linewidth=0.8, label=name)
        axes.set_xlabel(work)
        axes.set_ylabel(label)
        # Room for the legend above the curves.
        low, high = axes.get_ylim()
        axes.set_ylim(low, high * (high / low) ** 0.3)
        axes.legend(loc="upper right", handlelength=1.2)
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure
