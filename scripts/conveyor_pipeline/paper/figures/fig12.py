"""Fig. 12: map of the state of motion over the acceleration amplitude and the initial height."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(*, map: pd.DataFrame) -> Figure:
    """Draw a sweep over acceleration and z0."""
    figure = style.figure(style.COLUMN, 70.0)
    axes = figure.subplots()
    style.state_map(axes, map.assign(z0=1e3 * map.z0), "acceleration", "z0")
    axes.set_xlabel(style.AMPLITUDE)
    axes.set_ylabel("initial height $z_0$ in mm")
    style.state_legend(figure, map)
    return figure
