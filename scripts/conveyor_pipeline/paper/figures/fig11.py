"""Fig. 11: feeding velocities for initial heights with which two states coexist in a given interval only."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from conveyor_pipeline.figures import style


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, two_states: list[float] | None = None) -> Figure:
    """Draw sweeps over acceleration and z0, and shade the interval `two_states` (m/s²)."""
    figure = style.figure(style.PAGE, 66.0)
    sweeps = {"euler": euler, "converged": converged}
    panels = style.velocity_panels(figure, sweeps, style.AMPLITUDE)
    for axes, sweep in zip(panels, sweeps.values(), strict=True):
        if two_states is not None:
            axes.axvspan(*two_states, color="0.93", linewidth=0.0)
        for state, rows in sweep.groupby("state"):
            style.dots(axes, rows.acceleration, rows.mean_velocity, style.STATE_COLOURS[state], 2.0)
    panels[0].set_ylim(bottom=0.0)
    handles = style.state_handles(euler, converged)
    if two_states is not None:
        handles.append(Patch(color="0.93", label="two states intended (paper)"))
    figure.legend(handles=handles, loc="outside upper center", ncols=4)
    return figure
