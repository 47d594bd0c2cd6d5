"""Fig. 10: critical initial height over the acceleration amplitude, and fits of Eq. 13."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.common.axes import ends
from conveyor_pipeline.figures import style
from conveyor_pipeline.paper.fit.hyperbola import Hyperbola, critical_height


def plot(
    *,
    converged: pd.DataFrame,
    euler: pd.DataFrame,
    fit: pd.DataFrame,
    fit_euler: pd.DataFrame,
    paper_fit: bool = False,
) -> Figure:
    """Draw critical heights and the regressions `fit` and `fit_euler` of Eq. 13, with `paper_fit` also the paper's."""
    figure = style.figure(style.COLUMN, 82.0)
    axes = figure.subplots()
    edge = converged[converged.is_critical]
    curves = [
        (fit, "pymoo", style.CONVERGED, "-", "Eq. 13 fitted to the converged solution"),
        (fit_euler, "pymoo", style.EULER, "-", "Eq. 13 fitted to the paper's method"),
    ]
    if paper_fit:
        curves.append((fit, "paper", "black", ":", "Eq. 13 with the paper's A, B, C"))
    for fits, name, colour, line, label in curves:
        if name not in set(fits.fit):
            continue
        fitted = np.linspace(*fits.attrs["acceleration"], 200)
        hyperbola = Hyperbola(*fits.set_index("fit").loc[name, ["A", "B", "C"]])
        axes.plot(fitted, 1e3 * critical_height(fitted, hyperbola), line, color=colour, linewidth=0.8, label=label)
    hollow = {"markerfacecolor": "none", "markeredgewidth": 0.6}
    rows = euler[euler.is_critical]
    axes.plot(rows.acceleration, 1e3 * rows.z0, "o", markersize=4.0, **style.LOOKS["euler"], **hollow)
    axes.plot(edge.acceleration, 1e3 * edge.z0, ".", markersize=2.6, **style.LOOKS["converged"])
    back = converged[~converged.is_critical & (converged.state_above == "first")]
    if len(back):
        look = {"color": style.CONVERGED, "markersize": 3.0, **hollow}
        label = "converged solution, return to the first state"
        axes.plot(back.acceleration, 1e3 * back.z0, "v", label=label, **look)
    axes.set_xlabel(style.AMPLITUDE)
    axes.set_ylabel("critical initial height $z_0$ in mm")
    nothing = edge.empty and back.empty
    if nothing:
        style.limit_x(axes, ends(converged.attrs["axes"]["acceleration"]))
        axes.set_ylim(top=1e3 * ends(converged.attrs["scan"])[-1])
        change = "change the state of motion" if converged.empty else "end the first state"
        style.say(axes, f"no initial height was found\nto {change}")
    elif fit.empty:
        count = edge.acceleration.nunique()
        axes.plot([], [], " ", label=f"no fit of Eq. 13 to {count} amplitude{'s' if count != 1 else ''}")
    axes.set_ylim(bottom=0.0)
    if not nothing:
        style.legend_above(figure, axes)
    return figure
