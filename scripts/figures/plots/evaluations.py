"""Error over work that does not depend on the machine: evaluations of the force, cycles, points, evaluated fits."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from figures import style
from figures.plots.work_precision import NAMES, draw_panel, legend_handles, missing_note

QUANTITIES = {
    "exponent": ("simulated cycles", "relative error of $\\lambda_1$"),
    "dimension": ("points", "error of the dimension"),
    "fit": ("evaluations", "relative gap to the best fit"),
}


def draw_estimates(axes: Axes, rows: pd.DataFrame, work: str, error: str) -> None:
    """Draw the error of the estimates of one quantity over their work."""
    colours = (style.EULER, "black", style.CONVERGED)
    for colour, (name, curve) in zip(colours, rows.groupby("estimator", sort=False), strict=False):
        axes.loglog(curve.work, curve.error.clip(lower=1e-16), ".-", color=colour, linewidth=0.8, label=name)
    axes.xaxis.set_minor_formatter(NullFormatter())  # labels of a short axis would overlap
    axes.set_xlabel(work)
    axes.set_ylabel(error)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), handlelength=1.2)


def plot(
    *, jumping: pd.DataFrame, riding: pd.DataFrame, bouncing: pd.DataFrame, estimates: pd.DataFrame, paper_step: float
) -> Figure:
    """Draw the errors over the work, with a ring around the paper's step, `paper_step` (s)."""
    figure = style.figure(style.PAGE, 150.0)
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.5, 1.0))
    scenes = {"jumping": jumping, "riding": riding, "bouncing": bouncing}
    panels = upper.subplots(1, len(scenes), sharex=True, sharey=True)
    for axes, (name, table) in zip(panels, scenes.items(), strict=True):
        draw_panel(axes, table, "evaluations", "trajectory_error", paper_step)
        axes.set_title(NAMES[name])
        axes.set_xlabel("force evaluations")
    panels[0].set_ylabel("error of the trajectory\nin plate amplitudes")
    upper.legend(handles=legend_handles(list(scenes.values())), loc="outside upper center", ncols=4)
    if missing := missing_note(list(scenes.values())):
        upper.supxlabel(missing, size=7.0)
    for axes, (quantity, labels) in zip(lower.subplots(1, len(QUANTITIES)), QUANTITIES.items(), strict=True):
        draw_estimates(axes, estimates[estimates.quantity == quantity], *labels)
    return figure
