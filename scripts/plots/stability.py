"""Where methods stop working: maps of the outcome over the step, and other ways to fail."""

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from plots import style

OUTCOMES = {"right": "#BFD9EA", "wrong state": "#F3D9A0", "energy grows": "#D55E00", "blow-up": "#444444"}
METHODS = {"euler": "Euler", "semi_implicit_euler": "semi-implicit Euler", "rk4": "RK4"}
AXES = {"stiffness": "stiffness in N/m", "damping": "damping in N s/m", "impact velocity": "impact velocity in m/s"}


def draw_map(axes: Axes, rows: pd.DataFrame, panel: str) -> None:
    """Outcome over the step and one other quantity, with the theoretical limit of stability."""
    codes = rows.assign(code=rows.outcome.map(list(OUTCOMES).index)).pivot(index="y", columns="x", values="code")
    axes.pcolormesh(
        codes.columns.to_numpy(),
        codes.index.to_numpy(),
        codes.to_numpy(),
        cmap=ListedColormap(list(OUTCOMES.values())),
        vmin=-0.5,
        vmax=len(OUTCOMES) - 0.5,
        shading="nearest",
        rasterized=True,
    )
    theory = rows.groupby("y").theory.first()
    axes.plot(theory, theory.index, color="black", linewidth=1.2, linestyle=(0, (4, 2)))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(rows.x.min(), rows.x.max())
    axes.set_xlabel("step in s")
    axes.set_ylabel(AXES[panel])


def plot(tables: dict[str, pd.DataFrame], settings: dict) -> Figure:
    """From the table of stability."""
    figure = style.figure(style.PAGE, 170.0)
    panels = figure.subplots(3, 3)
    table = tables["stability"]
    for row, panel in enumerate(("stiffness", "damping")):
        for axes, (method, label) in zip(panels[row], METHODS.items(), strict=True):
            draw_map(axes, table[(table.panel == panel) & (table.method == method)], panel)
            axes.set_title(label)
    draw_map(panels[2, 0], table[table.panel == "impact velocity"], "impact velocity")
    panels[2, 0].set_title("Euler, one Hertz impact")

    looks = {"euler": ("Euler", style.PUBLISHED), "event": ("this solver", style.CONVERGED)}
    chatter, estimate = panels[2, 1], panels[2, 2]
    for method, (label, colour) in looks.items():
        rows = table[(table.panel == "chatter") & (table.method == method)]
        chatter.loglog(rows.x, rows.y.clip(lower=1e-18), ".-", color=colour, label=label)
        rows = table[(table.panel == "estimate") & (table.method == method)]
        estimate.semilogx(rows.x, rows.y, ".-", color=colour, label=label)
    chatter.set_title("slip while sticking")
    chatter.set_xlabel("step in s")
    chatter.set_ylabel("slip velocity in m/s")
    chatter.legend()
    estimate.axhline(0.0, color="black", linewidth=0.6)
    estimate.set_title("published exponent")
    estimate.set_xlabel("perturbation in rad")
    estimate.set_ylabel("exponent of $\\dot{x}_p$ in 1/s")
    handles = [Patch(color=colour, label=outcome) for outcome, colour in OUTCOMES.items()]
    handles.append(Line2D([], [], color="black", linestyle=(0, (4, 2)), label="limit in theory"))
    figure.legend(handles=handles, loc="outside upper center", ncols=5)
    return figure
