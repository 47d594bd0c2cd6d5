"""Fig. 4: feeding velocity and heights of part and plate, below and above the critical amplitude."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame) -> Figure:
    """Draw signals at two amplitudes."""
    figure = style.figure(style.PAGE, 88.0)
    panels = figure.subplots(2, 2, sharex=True, sharey="row")
    for axes, (_, rows) in zip(panels[1], converged.groupby("acceleration"), strict=True):
        axes.plot(rows.time, 1e3 * rows.plate_z, **style.PLATE_CURVE)
        axes.set_xlim(rows.time.min(), rows.time.max())
        axes.set_xlabel("time in s")
    for role, table in {"converged": converged, "euler": euler}.items():
        for column, (acceleration, rows) in enumerate(table.groupby("acceleration")):
            velocity, height = panels[:, column]
            velocity.plot(rows.time, rows.vx, **style.CURVES[role])
            height.plot(rows.time, 1e3 * rows.z, **style.CURVES[role])
            velocity.set_title(f"{('below', 'above')[column]}, $\\hat{{a}}$ = {acceleration:g} m/s²")
    panels[0, 0].set_ylabel("feeding velocity $\\dot{x}_p$ in m/s")
    panels[1, 0].set_ylabel("heights $z_p$, $z_s$ in mm")
    figure.align_ylabels(panels[:, 0])
    figure.get_layout_engine().set(wspace=0.06)
    figure.legend(handles=panels[1, 0].lines, loc="outside upper center", ncols=3)
    return figure
