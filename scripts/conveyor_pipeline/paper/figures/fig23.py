"""Fig. 23: phase portraits of the vertical motion in the first state, the second state and chaos."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from conveyor_pipeline.figures import style

SMALL = 1e-4  # m, up to which heights are in µm, because ticks in mm would have too many digits
TRANSIENT = 0.5  # share of a run that is grey; the rest is coloured


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame, portraits: list[list[float]]) -> Figure:
    """Draw three `portraits`, given by acceleration (m/s²) and z0 (m)."""
    signals = {"euler": euler, "converged": converged}
    figure = style.figure(style.PAGE, 112.0)
    panels = figure.subplots(len(signals), 3, sharex="col", sharey="col", squeeze=False)
    for line, (role, table) in zip(panels, signals.items(), strict=True):
        for axes, (acceleration, z0) in zip(line, portraits, strict=True):
            run = table[(table.acceleration == acceleration) & (table.z0 == z0)]
            (state,) = run.state.unique()
            settled = run[run.time >= TRANSIENT * run.time.max()]
            highest = converged[(converged.acceleration == acceleration) & (converged.z0 == z0)].z.max()
            factor, unit = (1e3, "mm") if highest > SMALL else (1e6, "µm")
            axes.plot(factor * run.z, run.vz, color="0.75", linewidth=0.4)
            axes.plot(factor * settled.z, settled.vz, color=style.STATE_COLOURS[state], linewidth=0.8)
            if axes in panels[0]:
                axes.set_title(f"{style.state_label(state)}, $\\hat{{a}}$ = {acceleration:g} m/s²")
            axes.xaxis.set_major_locator(MaxNLocator(5))
            if axes in panels[-1]:
                axes.set_xlabel(f"height $z_p$ in {unit}")
            axes.set_ylabel("vertical velocity $\\dot{z}_p$ in m/s")
        line[0].set_ylabel(f"{style.LOOKS[role]['label']}\nvertical velocity $\\dot{{z}}_p$ in m/s")
    figure.align_ylabels(panels[:, 0])
    return figure
