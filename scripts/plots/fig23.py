"""Fig. 23: phase portraits of the vertical motion in the first state, the second state and chaos."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style

ROWS = {"euler": style.EULER_LABEL, "converged": style.CONVERGED_LABEL}


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the signals `converged` and `euler`; settings: portraits, three pairs of acceleration (m/s²) and z0 (m),
    and transient, s.
    """
    figure = style.figure(style.PAGE, 112.0)
    panels = figure.subplots(2, 3, sharex="col", sharey="col")
    for line, (role, label) in zip(panels, ROWS.items(), strict=True):
        table = tables[role]
        for axes, (acceleration, z0) in zip(line, settings["portraits"], strict=True):
            run = table[(table.acceleration == acceleration) & (table.z0 == z0)]
            (state,) = run.state.unique()
            settled = run[run.time >= settings["transient"]]
            axes.plot(1e3 * run.z, run.vz, color="0.75", linewidth=0.4)
            axes.plot(1e3 * settled.z, settled.vz, color=style.STATE_COLOURS[state], linewidth=0.8)
            if role == "euler":
                axes.set_title(f"{state}, $\\hat{{a}}$ = {acceleration:g} m/s²")
            else:
                axes.set_xlabel("height $z_p$ in mm")
            axes.set_ylabel("vertical velocity $\\dot{z}_p$ in m/s")
        line[0].set_ylabel(f"{label}\nvertical velocity $\\dot{{z}}_p$ in m/s")
    figure.align_ylabels(panels[:, 0])
    return figure
