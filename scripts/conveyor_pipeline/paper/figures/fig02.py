"""Fig. 2: the point mass above the plate, with the quantities of the model, as a drawing."""

import math

from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Rectangle

from conveyor_pipeline.figures import style
from conveyor_pipeline.paper.figures.fig01 import arrow

THROW = math.radians(25.0)  # steeper than the 12° of the paper, so that it is visible


def plot() -> Figure:
    """Draw the scheme, which needs no tables."""
    figure = style.figure(style.COLUMN, 32.0)
    axes = figure.subplots()
    axes.set_aspect("equal")
    axes.axis("off")
    plate, part = 1.0, 2.8

    axes.add_patch(Rectangle((2.0, plate - 0.35), 5.6, 0.35, facecolor="0.85", edgecolor="0.2", linewidth=0.8))
    axes.add_patch(Circle((5.6, part), 0.22, facecolor=style.CONVERGED, edgecolor="0.2", linewidth=0.6))
    axes.text(5.95, part, "$m_p$", va="center")
    arrow(axes, (5.6, part - 0.22), (5.6, part - 1.1))
    axes.text(5.72, part - 0.85, "$g$")
    axes.text(6.2, plate - 0.175, "conveyor", va="center", ha="center", size=7.0)

    axes.plot([-0.3, 8.4], [0.0, 0.0], color="0.4", linewidth=0.6, linestyle="--")
    axes.text(6.9, 0.08, "$z = 0$", ha="right")
    for x, height, name in ((2.6, plate, "$z_s(t)$"), (4.2, part, "$z_p(t)$")):
        arrow(axes, (x, 0.0), (x, height), "<|-|>")
        axes.text(x - 0.1, 0.52 * height if height > plate else 0.3 * height, name, ha="right", va="center")
    axes.plot([4.1, 5.38], [part, part], color="0.4", linewidth=0.6)

    arrow(axes, (0.0, 0.0), (1.2, 0.0))
    arrow(axes, (0.0, 0.0), (0.0, 1.2))
    axes.annotate("$x$", (1.2, 0.0), (-1, 4), textcoords="offset points")
    axes.annotate("$z$", (0.0, 1.2), (3, -2), textcoords="offset points")

    centre = (8.6, plate - 0.175)
    reach = 1.1
    tip = centre[0] + reach * math.cos(THROW), centre[1] + reach * math.sin(THROW)
    arrow(axes, (2 * centre[0] - tip[0], 2 * centre[1] - tip[1]), tip, "<|-|>", style.EULER)
    axes.plot([centre[0], centre[0] + reach], [centre[1]] * 2, color="0.4", linewidth=0.6)
    axes.add_patch(Arc(centre, 1.5, 1.5, theta2=math.degrees(THROW), linewidth=0.8))
    axes.text(centre[0] + 0.85, centre[1] + 0.13, "$\\varphi$")
    axes.text(centre[0] + 0.1, centre[1] + 0.35, "$\\hat{a}$", color=style.EULER)
    axes.set_xlim(-0.6, 10.0)
    axes.set_ylim(-0.4, 3.4)
    return figure
