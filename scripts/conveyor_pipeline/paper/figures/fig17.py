"""Fig. 17: mean feeding velocity over the initial height in chaotic motion, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame) -> Figure:
    """Draw sweeps over z0."""
    figure = style.figure(style.PAGE, 60.0)
    sweeps = {"euler": euler, "converged": converged}
    panels = style.velocity_panels(figure, sweeps, "initial height $z_0$ in mm")
    for axes, (role, rows) in zip(panels, sweeps.items(), strict=True):
        colour = style.LOOKS[role]["color"]
        axes.plot(1e3 * rows.z0, rows.mean_velocity, ".-", color=colour, linewidth=0.4, markersize=2.5)
        axes.set_title(f"{style.LOOKS[role]['label']}, $\\hat{{a}}$ = {rows.attrs['model']['acceleration']:g} m/s²")
    style.from_zero(*panels)
    return figure
