"""Fig. 15: phase of the excitation over the velocity of the part at its first impact, for several initial heights."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from conveyor.parameters import normal_gravity
from conveyor_pipeline.figures import style

MARKERS = "os^v"
COLOURS = ("#0072B2", "#D55E00", "#000000", "#CC79A7")


def plot(*, impacts: pd.DataFrame) -> Figure:
    """Draw impacts over acceleration and z0 with the straight line of Eqs. 17 and 18."""
    figure = style.figure(style.COLUMN, 70.0)
    axes = figure.subplots()
    model = impacts.attrs["model"]
    ends = np.array([impacts.impact_velocity.min(), 0.0])
    slope = -2.0 * np.pi * model["frequency"] / normal_gravity(model)
    axes.plot(ends, model["psi0"] + slope * ends, color=style.PLATE, linewidth=0.8, label="slope $-\\omega/g$")
    curves = impacts.groupby("acceleration")
    for offset, (marker, colour, (acceleration, rows)) in enumerate(zip(MARKERS, COLOURS, curves, strict=True)):
        shown = rows.iloc[offset :: len(curves)]
        look = {"color": colour, "markersize": 3.5, "markerfacecolor": "none", "markeredgewidth": 0.7}
        label = f"$\\hat{{a}}$ = {acceleration:g} m/s²"
        axes.plot(shown.impact_velocity, shown.impact_phase, marker, label=label, **look)
    axes.set_xlabel("velocity at the first impact $\\dot{z}_1$ in m/s")
    axes.set_ylabel("phase at the first impact $\\psi_1$ in rad")
    style.phase_axis(axes.yaxis)
    axes.set_ylim(0.0, 1.1 * impacts.impact_phase.max())
    axes.legend(loc="upper right")
    return figure
