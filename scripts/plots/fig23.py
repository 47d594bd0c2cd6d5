"""Fig. 23: phase portraits of the vertical motion in the first state, the second state and chaos."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the signals `converged` and `published`; settings: portraits, pairs of acceleration (m/s²) and z0 (m) in the
    order of the states, and transient, s.
    """
    figure = style.figure(style.PAGE, 66.0)
    panels = figure.subplots(1, 3)
    for axes, state, (acceleration, z0) in zip(panels, style.STATE_COLOURS, settings["portraits"], strict=False):
        runs = {role: table[(table.acceleration == acceleration) & (table.z0 == z0)] for role, table in tables.items()}
        settled = {role: rows[rows.time >= settings["transient"]] for role, rows in runs.items()}
        axes.plot(1e3 * runs["converged"].z, runs["converged"].vz, color="0.8", linewidth=0.4, label="transient")
        axes.plot(
            1e3 * settled["converged"].z,
            settled["converged"].vz,
            color=style.STATE_COLOURS[state],
            linewidth=1.6,
            label=style.CONVERGED_LABEL,
        )
        axes.plot(
            1e3 * settled["published"].z,
            settled["published"].vz,
            color="black",
            linewidth=0.4,
            label=style.PUBLISHED_LABEL,
        )
        axes.set_title(f"{state}, $\\hat{{a}}$ = {acceleration:g} m/s²")
        axes.set_xlabel("height $z_p$ in mm")
    panels[0].set_ylabel("vertical velocity $\\dot{z}_p$ in m/s")
    style.legend_above(figure, panels[0], ncols=3)
    return figure
