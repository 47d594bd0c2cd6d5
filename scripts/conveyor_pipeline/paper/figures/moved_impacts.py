"""Why the exponent of Fig. 22 is positive by the paper's method: the perturbation does not move the impacts."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

ACCELERATION = 55.0  # m/s², of the runs over the time
STEPS = ("-", (0, (3, 3)), ":")  # linestyles of the time steps, in ascending order
MARKERS = ("o", "s", "^", "d")  # of the amplitudes


def draw_growth(axes: Axes, moved: pd.DataFrame) -> None:
    """Draw the difference of the feeding velocities over the time, in units of the smallest perturbation."""
    epsilon = moved.epsilon.min()
    rows = moved[(moved.acceleration == ACCELERATION) & (moved.epsilon == epsilon)]
    by_euler = rows[rows.method == "euler"]
    for linestyle, (step, line) in zip(STEPS, by_euler.groupby("step"), strict=False):
        look = {"color": style.EULER, "linestyle": linestyle, "label": f"Euler, {1e6 * step:g} µs"}
        axes.plot(line.time, line.difference / epsilon, **look)
    line = rows[rows.method == "event"]
    axes.plot(line.time, line.difference / epsilon, color=style.CONVERGED, label="converged")
    axes.axhline(1.0, color="black", linewidth=0.6, linestyle=":")
    axes.set_yscale("log")
    axes.set_ylim(5e-3, 20.0)
    axes.set_xlabel("time in s")
    axes.set_ylabel("|Δ$\\dot{x}_p$| / ε in m/s per rad")
    axes.legend(loc="upper left", ncols=2, handlelength=1.6, columnspacing=0.8)


def plot(*, moved: pd.DataFrame) -> Figure:
    """Draw the difference of two runs over the time, and moved impacts and differences over the time shift."""
    figure = style.figure(style.PAGE, 62.0)
    growth, impacts, ends = figure.subplots(1, 3)
    draw_growth(growth, moved)
    by_euler = moved[(moved.method == "euler") & (moved.time == moved.time.max())]
    for marker, (acceleration, rows) in zip(MARKERS, by_euler.groupby("acceleration"), strict=False):
        look = {"marker": marker, "markersize": 3.0, "linestyle": "", "markerfacecolor": "none"}
        look |= {"markeredgewidth": 0.7, "color": style.EULER, "label": f"{acceleration:g} m/s²"}
        time_shift = rows.time_shift / rows.step
        impacts.plot(time_shift, 100.0 * rows.moved / rows.impacts, **look)
        ends.plot(time_shift, rows.difference / rows.epsilon, **look)
    for axes in (impacts, ends):
        style.mark(axes, 1.0, "one step")
        axes.set_xscale("log")
        axes.set_xlabel("time shift ε/ω in time steps")
    impacts.set_ylim(-4.0, 115.0)
    impacts.set_ylabel("impacts that move, in %")
    ends.axhline(1.0, color="black", linewidth=0.6, linestyle=":")
    ends.set_yscale("log")
    ends.set_ylabel(f"|Δ$\\dot{{x}}_p$| / ε after {moved.time.max():g} s, in m/s per rad")
    impacts.legend(loc="center left", handletextpad=0.1)
    style.letter(growth, impacts, ends)
    return figure
