"""Fig. 14: map of the state of motion over the initial velocity and the phase, for a part that starts on the plate."""

import pandas as pd
from matplotlib.figure import Figure

from figures.plots.fig13 import phase_map


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the sweep `map` over psi0 and vz0."""
    return phase_map(tables["map"], "vz0", "initial velocity $\\dot{z}_0$ in m/s", "$z_0 = z_s(0)$")[0]
