"""Fig. 23: phase portraits of the vertical motion in the first state, the second state and chaos."""

import pandas as pd
from matplotlib.figure import Figure

from figures import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the signals `converged` and `euler`; settings: portraits, three pairs of acceleration (m/s²) and z0 (m),
    and transient, s.
    """
    titles = style.panels(tables)
    figure = style.figure(style.PAGE, 8.0 + 52.0 * len(titles))
    panels = figure.subplots(len(titles), 3, sharex="col", sharey="col", squeeze=False)
    for line, (role, label) in zip(panels, titles.items(), strict=True):
        table = tables[role]
        for axes, (acceleration, z0) in zip(line, settings["portraits"], strict=True):
            run = table[(table.acceleration == acceleration) & (table.z0 == z0)]
            (state,) = run.state.unique()
            settled = run[run.time >= settings["transient"]]
            axes.plot(1e3 * run.z, run.vz, color="0.75", linewidth=0.4)
            axes.plot(1e3 * settled.z, settled.vz, color=style.STATE_COLOURS[state], linewidth=0.8)
            if axes in panels[0]:
                axes.set_title(f"{state}, $\\hat{{a}}$ = {acceleration:g} m/s²")
            if axes in panels[-1]:
                axes.set_xlabel("height $z_p$ in mm")
            axes.set_ylabel("vertical velocity $\\dot{z}_p$ in m/s")
        line[0].set_ylabel(f"{label}\nvertical velocity $\\dot{{z}}_p$ in m/s")
    figure.align_ylabels(panels[:, 0])
    return figure
