"""Effect of the tensile contact force: velocity, critical heights, and states of motion over the amplitude."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

MODES = {
    "allow": ("contact pulls, with friction", {"color": "black", "linewidth": 1.4}),
    "frictionless": ("contact pulls, without friction", {"color": "0.7", "linestyle": (0, (4, 2)), "linewidth": 1.0}),
    "clip": ("contact does not pull", {"color": "#D55E00", "linestyle": (0, (1, 1)), "linewidth": 1.4}),
}


def plot(*, sweep: pd.DataFrame, edge: pd.DataFrame) -> Figure:
    """Draw a sweep over tension, z0 and acceleration, and critical heights over tension."""
    figure = style.figure(style.PAGE, 104.0)
    panels = figure.subplot_mosaic([["velocity", "edge"], ["states", "states"]], height_ratios=(2.0, 1.2))
    for mode, (label, look) in MODES.items():
        regular = sweep[(sweep.tension == mode) & (sweep.state != "chaos") & (sweep.period == 1)]
        for state, rows in regular.groupby("state"):
            curve = rows.groupby("acceleration").mean_velocity.median()
            panels["velocity"].plot(curve.index, curve, label=label if state == "first" else None, **look)
        rows = edge[(edge.tension == mode) & edge.is_critical]
        panels["edge"].plot(rows.acceleration, 1e3 * rows.z0, **look)
    style.velocity_axis(panels["velocity"].yaxis)
    panels["velocity"].set_ylim(bottom=0.0)
    panels["velocity"].set_title("motions with the period of the excitation")
    panels["edge"].set_ylabel("critical initial height in mm")
    panels["edge"].set_title("first state below, second above")
    for name in ("velocity", "edge"):
        panels[name].set_xlabel(style.AMPLITUDE)

    axes = panels["states"]
    bars = [(mode, z0) for mode in MODES for z0 in sorted(sweep.z0.unique())]
    states = sweep.pivot(index=["tension", "z0"], columns="acceleration", values="state").loc[bars]
    style.class_map(axes, states.reset_index(drop=True), style.STATE_COLOURS)
    for line in np.arange(1.5, len(bars) - 1.0, 2.0):
        axes.axhline(line, color="white", linewidth=2.0)
    names = {mode: label.removeprefix("contact ") for mode, (label, _) in MODES.items()}
    axes.set_yticks(np.arange(len(bars)), [f"{names[mode]}, $z_0$ = {1e3 * z0:g} mm" for mode, z0 in bars])
    axes.invert_yaxis()
    axes.set_xlabel(style.AMPLITUDE)
    handles = [*panels["velocity"].get_legend_handles_labels()[0], *style.state_handles(sweep)]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure
