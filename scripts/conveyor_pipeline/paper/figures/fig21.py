"""Fig. 21: position and feeding velocity of two parts whose phases differ by a small perturbation."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

LEAST = 1e-12  # m/s: below, differences are rounding errors of parts that both slip


def plot(*, converged: pd.DataFrame, euler: pd.DataFrame) -> Figure:
    """Draw signals at two phases, and the distance between them."""
    figure = style.figure(style.PAGE, 116.0)
    panels = figure.subplots(3, 2, sharex=True, sharey="row")
    signals = {"euler": euler, "converged": converged}
    for (position, velocity, difference), (role, table) in zip(panels.T, signals.items(), strict=True):
        colour = style.LOOKS[role]["color"]
        (low, reference), (high, perturbed) = table.groupby("psi0")
        mantissa, exponent = f"{high - low:.0e}".split("e")
        label = f"perturbed: $\\psi_0$ larger by ${mantissa}\\cdot 10^{{{int(exponent)}}}$ rad"
        for axes, name, scale in ((position, "x", 1e3), (velocity, "vx", 1.0)):
            axes.plot(reference.time, scale * reference[name], color=colour, linewidth=1.4, label="reference")
            axes.plot(perturbed.time, scale * perturbed[name], color="black", linewidth=0.6, label=label)
        distance = np.abs(perturbed.vx.to_numpy() - reference.vx.to_numpy())
        difference.semilogy(reference.time, distance, color=colour, linewidth=0.7)
        difference.set_ylim(bottom=LEAST)
        position.set_title(style.LOOKS[role]["label"])
        position.legend(loc="upper left")
        difference.set_xlabel("time in s")
        difference.set_xlim(reference.time.min(), reference.time.max())
    panels[0, 0].set_ylabel("position $x_p$ in mm")
    panels[1, 0].set_ylabel("feeding velocity $\\dot{x}_p$ in m/s")
    panels[2, 0].set_ylabel("distance $|\\Delta\\dot{x}_p|$ in m/s")
    figure.align_ylabels(panels[:, 0])
    return figure
