"""Fig. 14: map of the state of motion over the initial velocity and the phase; initial position on the plate."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.paper.figures.fig13 import draw_phase_map


def plot(*, map: pd.DataFrame) -> Figure:
    """Draw a sweep over psi0 and vz0."""
    return draw_phase_map(map, "vz0", "initial velocity $\\dot{z}_0$ in m/s", "$z_0 = z_s(0)$")[0]
