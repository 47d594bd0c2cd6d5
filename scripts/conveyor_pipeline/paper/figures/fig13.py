"""Fig. 13: map of the state of motion over the initial height and the phase; initial velocity zero."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from conveyor import plate_motion
from conveyor_pipeline.common import grid
from conveyor_pipeline.figures import style


def draw_phase_map(table: pd.DataFrame, name: str, label: str, fixed: str) -> tuple[Figure, Axes]:
    """Draw a map over psi0 and the column `name` with its axis label; `fixed` is the common initial condition."""
    figure = style.figure(style.COLUMN, 76.0)
    axes = figure.subplots()
    style.state_map(axes, table, name, "psi0")
    axes.set_title(f"$\\hat{{a}}$ = {table.attrs['model']['acceleration']:g} m/s², {fixed}")
    axes.set_xlabel(label)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.set_ylabel("initial phase $\\psi_0$ in rad")
    style.phase_axis(axes.yaxis)
    axes.set_ylim(top=2.0 * np.pi)
    style.state_legend(figure, table)
    return figure, axes


def plot(*, map: pd.DataFrame) -> Figure:
    """Draw a sweep over psi0 and z0; a line shows the height of the plate."""
    figure, axes = draw_phase_map(map.assign(z0=1e3 * map.z0), "z0", "initial height $z_0$ in mm", "$\\dot{z}_0$ = 0")
    conveyor, _ = grid.conveyor_and_start(map.attrs["model"])
    phases = np.linspace(map.psi0.min(), map.psi0.max(), 200)
    plate = plate_motion(conveyor, phases / (2.0 * np.pi * conveyor.frequency))["z"]
    axes.plot(1e3 * plate[plate >= 0.0], phases[plate >= 0.0], color="white", linewidth=1.0)
    top = plate.argmax()
    style.note(axes, "plate", (1e3 * plate[top], phases[top]), (3, 0), color="white", va="center")
    return figure
