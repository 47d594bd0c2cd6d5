"""Fig. 7: amplitude spectrum of the feeding velocity, below and above the critical amplitude."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.paper.figures.fig06 import plot_signal


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame) -> Figure:
    """Draw spectra at two amplitudes."""
    return plot_signal(converged, euler, "vx", "$\\dot{x}_p$")
