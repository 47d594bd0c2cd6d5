"""Fig. 1: a vibrating channel that feeds a three-dimensional part, as a drawing."""

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, Polygon

from conveyor_pipeline.figures import style

# Depth (y) is drawn upwards to the right and shortened.
DEPTH = 0.55 * math.cos(math.radians(35.0)), 0.55 * math.sin(math.radians(35.0))
STEEL, SPRING, PART = (0.80, 0.83, 0.86), (0.62, 0.65, 0.68), (0.95, 0.70, 0.30)
LINE = {"edgecolor": "0.2", "linewidth": 0.6, "joinstyle": "round"}


def project(x: float, y: float, z: float) -> tuple[float, float]:
    return x + DEPTH[0] * y, z + DEPTH[1] * y


def face(axes: Axes, corners: list[tuple[float, float, float]], colour: tuple, shade: float) -> None:
    axes.add_patch(Polygon([project(*corner) for corner in corners], facecolor=[shade * c for c in colour], **LINE))


def box(axes: Axes, x: tuple[float, float], y: tuple[float, float], z: tuple[float, float], colour: tuple) -> None:
    """The three visible faces of a cuboid: right, top, front."""
    (x0, x1), (y0, y1), (z0, z1) = x, y, z
    face(axes, [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)], colour, 0.78)
    face(axes, [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)], colour, 1.0)
    face(axes, [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)], colour, 0.9)


def pin(axes: Axes, x: float, y: float, z: tuple[float, float], radius: float, colour: tuple) -> None:
    """An upright cylinder."""
    flat = 2.0 * radius, 0.7 * radius
    (u, low), (_, high) = project(x, y, z[0]), project(x, y, z[1])
    side = [0.85 * c for c in colour]
    axes.add_patch(Ellipse((u, low), *flat, facecolor=side, edgecolor="0.2", linewidth=0.6))
    axes.fill([u - radius, u + radius, u + radius, u - radius], [low, low, high, high], color=side, linewidth=0.0)
    for edge in (u - radius, u + radius):
        axes.plot([edge, edge], [low, high], color="0.2", linewidth=0.6)
    axes.add_patch(Ellipse((u, high), *flat, facecolor=colour, edgecolor="0.2", linewidth=0.6))


def arrow(axes: Axes, tail: tuple[float, float], tip: tuple[float, float], look: str = "-|>", colour="black") -> None:
    line = {"linewidth": 0.9, "color": colour, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tip, tail, arrowprops={"arrowstyle": look, "mutation_scale": 7.0, **line})


def plot() -> Figure:
    """Draw the scheme, which needs no tables."""
    figure = style.figure(style.COLUMN, 32.0)
    axes = figure.subplots()
    axes.set_aspect("equal")
    axes.axis("off")

    # From the back to the front: base, leaf springs, channel with its walls, part, front wall.
    box(axes, (0.6, 8.9), (0.2, 2.8), (-2.6, -2.2), STEEL)
    for x in (1.6, 7.2):
        face(axes, [(x, 0.6, -2.2), (x + 0.25, 0.6, -2.2), (x - 0.15, 0.6, -0.3), (x - 0.4, 0.6, -0.3)], SPRING, 1.0)
    box(axes, (0.0, 9.0), (0.0, 3.0), (-0.3, 0.0), STEEL)
    box(axes, (0.0, 9.0), (2.8, 3.0), (0.0, 1.1), STEEL)
    box(axes, (2.9, 5.3), (0.9, 2.1), (0.0, 0.45), PART)
    box(axes, (2.9, 3.4), (0.9, 2.1), (0.45, 1.3), PART)
    pin(axes, 4.5, 1.5, (0.45, 1.0), 0.32, PART)
    box(axes, (0.0, 9.0), (0.0, 0.2), (0.0, 0.35), STEEL)

    arrow(axes, project(5.7, 1.5, 0.75), project(8.0, 1.5, 0.75), colour=style.EULER)
    axes.text(*project(5.8, 1.5, 0.95), "feeding", color=style.EULER)
    axes.text(*project(3.2, 2.9, 1.4), "part $O$")
    axes.text(2.05, -0.75, "vibrating channel $N$", va="top")
    arrow(axes, (9.3, -0.4), (10.9, 0.1), "<|-|>", style.CONVERGED)
    axes.text(10.5, -0.4, "vibration\nin $x$ and $z$", color=style.CONVERGED, va="top")
    origin = (-2.6, -0.6)
    for tip, name in (((1.3, 0.0), "$x$"), ((0.9 * DEPTH[0] * 2, 0.9 * DEPTH[1] * 2), "$y$"), ((0.0, 1.3), "$z$")):
        end = origin[0] + tip[0], origin[1] + tip[1]
        arrow(axes, origin, end)
        axes.annotate(name, end, (2, 1), textcoords="offset points")
    axes.set_xlim(-2.8, 13.2)
    axes.set_ylim(-2.8, 2.8)
    return figure
