"""Fig. 16: velocity, heights and forces of a part in chaotic motion."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, acceleration: float, z0: float) -> Figure:
    """Draw the signals at one `acceleration` (m/s²) and one `z0` (m)."""
    figure = style.figure(style.PAGE, 100.0)
    (velocity, contact), (height, friction) = figure.subplots(2, 2, sharex=True)
    for role, table in {"euler": euler, "converged": converged}.items():
        rows = table[(table.acceleration == acceleration) & (table.z0 == z0)]
        look = style.LOOKS[role]
        velocity.plot(rows.time, rows.vx, linewidth=0.7, **look)
        height.plot(rows.time, 1e3 * rows.z, linewidth=0.7, **look)
        contact.plot(rows.time, 1e3 * rows.contact_force, linewidth=0.7, **look)
        friction.plot(rows.time, 1e3 * rows.friction_force, linewidth=0.7, **look)
    height.plot(rows.time, 1e3 * rows.plate_z, color=style.PLATE, linewidth=0.7, label="conveyor")
    velocity.set_ylabel("feeding velocity $\\dot{x}_p$ in m/s")
    height.set_ylabel("heights $z_p$, $z_s$ in mm")
    contact.set_ylabel("contact force $F_c$ in mN")
    friction.set_ylabel("friction force $F_r$ in mN")
    for axes in (height, friction):
        axes.set_xlabel("time in s")
        axes.set_xlim(rows.time.min(), rows.time.max())
    figure.align_ylabels()
    figure.legend(handles=height.lines, loc="outside upper center", ncols=3)
    return figure
