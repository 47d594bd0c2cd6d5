"""Speed and accuracy in one chart: error of the trajectory over processor time in the jumping scene."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from accuracy import speed
from conveyor import RIVALS
from figures import style
from figures.plots.work_precision import missing_note

# Method, treatment of events, name at the accurate end of the curve, its offset in points, its alignment.
CURVES = (
    ("event", speed.OWN, "this solver", (0, -8), "center"),
    ("euler", "fixed step", "explicit Euler", (5, 0), "left"),
    ("DOP853", "modes", "SciPy DOP853", (5, 0), "left"),
    ("CyRK DOP853", "modes", "CyRK\nDOP853", (0, -13), "center"),
    ("CVODE Adams", "modes", "SUNDIALS\nCVODE", (-6, -4), "right"),
    ("heyoka", "modes", "heyoka", (0, -8), "center"),
)
SMALLEST = 1e-15


def method_name(method: str) -> str:
    """The name of a method in a sentence; methods of SciPy with their package: "SciPy's DOP853"."""
    rival = RIVALS.get(method)
    return f"SciPy's {method}" if rival and rival.module == "scipy" else style.METHODS[method][1]


def draw_curve(axes: Axes, rows: pd.DataFrame, method: str, name: str, offset: tuple, align: str) -> None:
    """Draw the errors of one method over its times, with its name at the accurate end."""
    colour, _ = style.METHODS[method]
    rows = rows.sort_values(["step", "tolerance"], ascending=False)
    size, width, order, weight = (3.5, 2.0, 3, "bold") if method == "event" else (2.5, 1.0, 2, "normal")
    look = {"color": colour, "markersize": size, "linewidth": width, "zorder": order}
    axes.plot(rows.milliseconds, rows.trajectory_error.clip(lower=SMALLEST), "o-", **look)
    last = rows.iloc[-1]
    place = last.milliseconds, max(last.trajectory_error, SMALLEST)
    style.note(axes, name, place, offset, color=colour, ha=align, va="center", weight=weight)


def draw_factor(axes: Axes, factor: speed.Factor, text: str, below: bool) -> None:
    """Draw an arrow from another run to the solver at equal error, with the ratio of their times."""
    look = {"arrowstyle": "-|>", "color": "black", "linewidth": 1.0, "shrinkA": 0.0, "shrinkB": 2.0}
    tip, tail = (factor.own_milliseconds, factor.error), (factor.milliseconds, factor.error)
    axes.annotate("", tip, tail, arrowprops=look, zorder=4)
    # Nearer to the solver, because curves of other methods pass the other end.
    place = factor.own_milliseconds**0.7 * factor.milliseconds**0.3
    label = f"{float(f'{factor.ratio:.2g}'):g}× {text}"
    offset, side = ((0, -3), "top") if below else ((0, 3), "bottom")
    style.note(axes, label, (place, factor.error), offset, ha="center", va=side, weight="bold")


def plot(*, jumping: pd.DataFrame, jumping_times: pd.DataFrame, paper_step: float, equal_error: float) -> Figure:
    """Draw the chart, with a ring around `paper_step` (s) and speed ratios at its error and at `equal_error`."""
    figure = style.figure(style.PAGE, 100.0)
    axes = figure.subplots()
    runs = speed.successful_runs(jumping, jumping_times)
    for method, treatment, *label in CURVES:
        rows = runs[(runs.method == method) & (runs.treatment == treatment)]
        if len(rows):
            draw_curve(axes, rows, method, *label)
    paper = speed.paper_run(runs, paper_step)
    place = paper.milliseconds, paper.trajectory_error
    axes.plot(*place, "o", markersize=9.0, color=style.EULER, fillstyle="none")
    style.note(axes, "paper's method and time step", place, (8, 3), color=style.EULER, va="bottom")
    for factor in speed.factors(runs, paper_step, equal_error):
        is_paper = factor.error == paper.trajectory_error
        other = "the paper's method" if is_paper else method_name(factor.method)
        draw_factor(axes, factor, f"faster than\n{other}", is_paper)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(bottom=SMALLEST / 10.0)
    axes.set_yticks([1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0])
    axes.minorticks_off()
    axes.set_xticks([0.1, 1.0, 10.0, 100.0, 1000.0], [f"$10^{{{power}}}$" for power in (-4, -3, -2, -1, 0)])
    axes.set_xlim(0.05, 4000.0)
    axes.grid(linewidth=0.3, color="0.9")
    style.note(axes, missing_note([jumping]), (0.99, 0.02), xycoords="axes fraction", ha="right")
    axes.set_xlabel(f"processor time for {jumping.attrs['duration']:g} s of motion in s")
    axes.set_ylabel("error of the trajectory\nin units of the plate's motion")
    return figure
