"""Basin stability: velocity of each attractor over the amplitude; line width: share of initial conditions."""

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from conveyor_pipeline.figures import style

THICKEST = 6.0  # points: line width for all initial conditions
THINNEST = 0.5  # points, so that the rarest motion is visible
ALONE = 0.02  # half of the relative width of a single amplitude
SHOWN = (0.05, 0.5, 1.0)  # shares in the legend


def width(share: np.ndarray | float) -> np.ndarray:
    """Line width in points for a share of the initial conditions."""
    return THINNEST + (THICKEST - THINNEST) * np.asarray(share)


def ends_of(amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the interval around each of some ascending amplitudes, shape (m,): half-way to its neighbours.

    A single amplitude has an interval that is wide enough to be seen.
    """
    if len(amplitudes) == 1:
        return (1.0 - ALONE) * amplitudes, (1.0 + ALONE) * amplitudes
    between = 0.5 * (amplitudes[1:] + amplitudes[:-1])
    return np.concatenate([amplitudes[:1], between]), np.concatenate([between, amplitudes[-1:]])


def throw_axis(axes: Axes, shares: pd.DataFrame) -> None:
    """Add an axis for the throw number above the panel."""
    unit = shares.acceleration.iloc[-1] / shares.vertical.iloc[-1]
    above = axes.secondary_xaxis("top", functions=(lambda x: x / unit, lambda x: x * unit))
    above.set_xlabel(style.THROW_NUMBER)


def draw_motions(axes: Axes, shares: pd.DataFrame, over: str) -> None:
    """Draw the velocity of each motion over a column of the table; line width: its share of the initial conditions."""
    places = np.sort(shares[over].unique())
    begin, end = ends_of(places)
    pieces = [
        [(begin[k], velocity), (end[k], velocity)]
        for k, velocity in zip(np.searchsorted(places, shares[over]), shares.mean_velocity, strict=True)
    ]
    colours = shares.state.map(style.STATE_COLOURS)
    # No antialiasing: it would leave hairlines between the pieces.
    axes.add_collection(LineCollection(pieces, linewidths=width(shares.share), colors=colours, antialiaseds=False))
    style.limit_x(axes, places)


def share_handles(shares: pd.DataFrame) -> list[Artist]:
    """Legend handles of states and of shares of the initial conditions."""
    handles = style.state_handles(shares)
    labels = [f"{100.0 * share:g} %" for share in SHOWN]
    labels[-1] += " of the initial conditions"
    widths = zip(SHOWN, labels, strict=True)
    return handles + [Line2D([], [], color="0.3", linewidth=width(share), label=label) for share, label in widths]


def plot(*, shares: pd.DataFrame) -> Figure:
    """Draw the velocity and the share of initial conditions of each motion."""
    figure = style.figure(style.PAGE, 92.0)
    axes = figure.subplots()
    draw_motions(axes, shares, "acceleration")
    low, high = shares.mean_velocity.min(), shares.mean_velocity.max()
    if low < high:
        axes.set_ylim(min(0.0, low) - 0.05 * (high - low), max(0.0, high) + 0.08 * (high - low))
    if shares.mean_velocity.isna().all():
        style.say(axes, "no motion has a mean velocity")
        axes.set_yticks([])
    else:
        axes.axhline(0.0, color="black", linewidth=0.6, zorder=0)
        handles = share_handles(shares)
        figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), columnspacing=1.2)
    axes.set_xlabel(style.AMPLITUDE)
    style.velocity_axis(axes.yaxis)
    throw_axis(axes, shares)
    return figure
