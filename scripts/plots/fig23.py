"""Fig. 23: phase portraits of the vertical motion in the first state, the second state and chaos."""

import pandas as pd
from matplotlib.figure import Figure

from plots import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the signals `signals`; settings: portraits, pairs of acceleration (m/s²) and z0 (m), and transient, s."""
    figure = style.figure(style.PAGE, 62.0)
    panels = figure.subplots(1, 3)
    names = ("first", "second", "chaos")
    signals = tables["signals"]
    for axes, state, (acceleration, z0) in zip(panels, names, settings["portraits"], strict=True):
        rows = signals[(signals.acceleration == acceleration) & (signals.z0 == z0)]
        settled = rows[rows.time >= settings["transient"]]
        axes.plot(1e3 * rows.z, rows.vz, color="0.75", linewidth=0.4)
        axes.plot(1e3 * settled.z, settled.vz, color=style.STATE_COLOURS[state], linewidth=0.8)
        axes.set_title(f"{state}, $\\hat{{a}}$ = {acceleration:g} m/s²")
        axes.set_xlabel("height $z_p$ in mm")
    panels[0].set_ylabel("vertical velocity $\\dot{z}_p$ in m/s")
    return figure
