"""Fig. 5: contact force and friction force, below and above the critical amplitude."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

FORCES = {"contact_force": "contact force $F_c$ in mN", "friction_force": "friction force $F_r$ in mN"}
BEGIN = 0.96  # s, from which two excitation cycles remain


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame) -> Figure:
    """Draw the last two excitation cycles of signals at two amplitudes."""
    figure = style.figure(style.PAGE, 88.0)
    panels = figure.subplots(2, 2, sharex=True)
    for role, table in {"converged": converged, "euler": euler}.items():
        for column, (acceleration, rows) in enumerate(table[table.time >= BEGIN].groupby("acceleration")):
            panels[0, column].set_title(f"{('below', 'above')[column]}, $\\hat{{a}}$ = {acceleration:g} m/s²")
            for axes, force in zip(panels[:, column], FORCES, strict=True):
                axes.plot(rows.time, 1e3 * rows[force], **style.CURVES[role])
    for line, label in zip(panels, FORCES.values(), strict=True):
        for axes in line:
            axes.set_ylabel(label)
    for axes in panels[1]:
        axes.set_xlim(BEGIN, converged.time.max())
        axes.locator_params(axis="x", nbins=5)
        axes.set_xlabel("time in s")
    figure.align_ylabels()
    figure.get_layout_engine().set(wspace=0.06)
    figure.legend(handles=panels[0, 0].lines, loc="outside upper center", ncols=2)
    return figure
