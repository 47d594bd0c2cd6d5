"""Fig. 14: map of the state of motion over the initial velocity and the phase, for a part that starts on the plate."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the sweep `map` over psi0 and vz0."""
    figure = style.figure(style.COLUMN, 76.0)
    axes = figure.subplots()
    table = tables["map"]
    style.state_map(axes, table, "vz0", "psi0")
    axes.set_title(f"$\\hat{{a}}$ = {table.attrs['model']['acceleration']:g} m/s², $z_0 = z_s(0)$")
    axes.set_xlabel("initial velocity $\\dot{z}_0$ in m/s")
    axes.set_ylabel("initial phase $\\psi_0$ in rad")
    style.phase_axis(axes.yaxis)
    figure.legend(handles=style.state_handles(table), loc="outside upper center", ncols=4)
    return figure
