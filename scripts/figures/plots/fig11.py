"""Fig. 11: feeding velocities for initial heights chosen such that two states exist in a given interval only."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from figures import style


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the sweeps `converged` and `euler` over acceleration and z0; settings: two_states, m/s²."""
    figure = style.figure(style.PAGE, 66.0)
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    titles = {"euler": style.EULER_LABEL, "converged": style.CONVERGED_LABEL}
    for axes, (role, title) in zip(panels, titles.items(), strict=True):
        axes.axvspan(*settings["two_states"], color="0.93", linewidth=0.0)
        for state, rows in tables[role].groupby("state"):
            colour = style.STATE_COLOURS[state]
            axes.plot(rows.acceleration, rows.mean_velocity, ".", markersize=2.0, markeredgewidth=0.0, color=colour)
        axes.set_title(title)
        axes.set_xlabel("acceleration amplitude $\\hat{a}$ in m/s²")
    panels[0].set_ylabel("mean feeding velocity in m/s")
    panels[0].set_ylim(bottom=0.0)
    two_states = Patch(color="0.93", label="two states wanted")
    panels[0].legend(handles=[*style.state_handles(*tables.values()), two_states], loc="upper left")
    return figure
