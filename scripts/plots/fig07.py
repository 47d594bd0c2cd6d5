"""Fig. 7: amplitude spectrum of the feeding velocity, below and above the critical amplitude."""

import pandas as pd
from matplotlib.figure import Figure

from plots.fig06 import plot_signal


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the spectra `converged` and `euler` at two amplitudes; settings: highest, Hz, of what is shown."""
    return plot_signal(tables, "vx", "$\\dot{x}_p$", settings["highest"])
