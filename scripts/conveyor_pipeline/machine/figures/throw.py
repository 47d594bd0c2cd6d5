"""Textbook theory of throw conveyors and converged motions of several conveyors over the throw number."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.figures.basin_stability import draw_motions, share_handles
from conveyor_pipeline.paper.claims.about_proofs import lowest_fold


def proved_fold(throws: pd.DataFrame, bifurcations: pd.DataFrame) -> float:
    """Throw number of the lowest proved fold of the paper's conveyor, NaN if none is proved."""
    paper = throws[throws.conveyor == "paper"].iloc[0]
    return lowest_fold(bifurcations) * paper.vertical / paper.acceleration


def plot(*, throws: pd.DataFrame, bifurcations: pd.DataFrame) -> Figure:
    """Draw one panel for each conveyor."""
    names = list(throws.conveyor.unique())
    rows = -(-len(names) // 2)
    figure = style.figure(style.PAGE, 52.0 * rows + 17.0)
    panels = figure.subplots(rows, 2, sharex=True, squeeze=False)
    for axes, name in zip(panels.flat, names, strict=False):
        conveyor_throws = throws[throws.conveyor == name]
        textbook = conveyor_throws.drop_duplicates("vertical")
        draw_motions(axes, conveyor_throws, "vertical")
        axes.plot(textbook.vertical, textbook.textbook, **style.TEXTBOOK)
        axes.autoscale_view(scalex=False)
        axes.axhline(0.0, color="black", linewidth=0.4, zorder=0)
        axes.axvspan(conveyor_throws.vertical.min(), 1.0, color="0.94", linewidth=0.0, zorder=-1)
        axes.set_title(name)
    style.mark(panels[0, 0], proved_fold(throws, bifurcations), "proved fold")
    for axes in panels[-1]:
        axes.set_xlabel(style.THROW_NUMBER)
    for axes in panels.flat:
        style.velocity_axis(axes.yaxis)
    for axes in panels.flat[len(names) :]:
        axes.set_axis_off()
    handles = [Line2D([], [], **style.TEXTBOOK), *share_handles(throws)]
    figure.legend(handles=handles, loc="outside upper center", ncols=-(-len(handles) // 2), columnspacing=1.0)
    return figure
