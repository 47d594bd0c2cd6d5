"""Fig. 8: feeding velocities for several initial heights, paper's method and converged solution side by side."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from conveyor.packing import plate_peaks
from conveyor_pipeline.common import grid
from conveyor_pipeline.figures import style

# Interquartile range of the velocities of one motion, over the largest velocity, above which runs have not settled.
WIDE = 0.05
DIGITS = 2  # of the longest flight, in excitation cycles, by which motions with one period differ


def plate_velocity(sweep: pd.DataFrame) -> tuple[list[float], list[float]]:
    """End points of the straight line of the plate's largest velocity (m/s) over the amplitude (m/s²)."""
    ends = [sweep.acceleration.min(), sweep.acceleration.max()]
    _, conveyors = grid.product({"acceleration": ends}, sweep.attrs["model"])
    return ends, plate_peaks(conveyors).vx.tolist()


def unsettled(sweep: pd.DataFrame) -> tuple[float, float] | None:
    """The median amplitude (m/s²) at which runs in the second state have not settled, and their low velocity (m/s).

    None if all runs have settled. Jumping motions of other periods or with longer flights have velocities of their own.
    """
    second = sweep[sweep.state == "second"]
    runs = second.groupby(["acceleration", "period", second.longest_flight.round(DIGITS)]).mean_velocity
    low, high = runs.quantile(0.25), runs.quantile(0.75)
    wide = low[high - low > WIDE * sweep.mean_velocity.abs().max()].groupby("acceleration").first()
    if wide.empty:
        return None
    middle = wide.index[len(wide) // 2]
    return float(middle), float(wide.loc[middle])


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, two_states: list[float] | None = None) -> Figure:
    """Draw sweeps over acceleration and z0, and shade the interval `two_states` (m/s²)."""
    figure = style.figure(style.PAGE, 72.0)
    sweeps = {"euler": euler, "converged": converged}
    panels = style.velocity_panels(figure, sweeps, style.AMPLITUDE)
    plate = {"color": style.PLATE, "linewidth": 0.8, "linestyle": "--", "label": "largest velocity of the conveyor"}
    for axes, sweep in zip(panels, sweeps.values(), strict=True):
        if two_states is not None:
            axes.axvspan(*two_states, color="0.93", linewidth=0.0)
        axes.plot(*plate_velocity(sweep), **plate)
        for state, colour in style.STATE_COLOURS.items():
            rows = sweep[sweep.state == state]
            style.dots(axes, rows.acceleration, rows.mean_velocity, colour, 2.0)
        if place := unsettled(sweep):
            largest = max(sweep.mean_velocity.max(), sweep.mean_velocity.min(), key=abs)
            # The text stands between the axis and these runs, or above runs that are near the axis.
            axes.annotate(
                f"not settled\nin {sweep.attrs['duration']:.3g} s",
                place,
                (place[0], (0.15 if place[1] / largest > 0.3 else 0.6) * largest),
                ha="center",
                va="center",
                size=7.0,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
                arrowprops={"arrowstyle": "->", "linewidth": 0.6, "shrinkB": 3.0},
            )
    style.from_zero(*panels)
    handles = [
        Line2D([], [], color=area.get_facecolor(), marker="o", linestyle="", label=area.get_label())
        for area in style.state_handles(*sweeps.values())
    ]
    handles.append(Line2D([], [], **plate))
    if two_states is not None:
        handles.append(Patch(color="0.93", label="two states (paper)"))
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    return figure
