"""What a clean drive is worth: change of the transit velocity by one harmonic over its phase, share and order."""

import itertools

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.excitation.effects import MEASURES, changes_of

COLOURS = {2: "#0072B2", 3: "#D55E00"}
OTHER = "#009E73"
ORDINALS = {2: "second", 3: "third"}
PALEST = 0.35
SURE = 2.0  # standard errors


def around(values: pd.DataFrame) -> pd.DataFrame:
    """The rows from -π to π, with one of both ends repeated at the other."""
    ends = values[np.isclose(values.phase.abs(), np.pi)]
    return pd.concat([values, ends.assign(phase=-ends.phase)]).sort_values("phase")


def draw_changes(axes: Axes, changes: pd.DataFrame) -> None:
    """The change over the phase, a line for each order and share."""
    shares = sorted(changes.share.unique())
    strengths = dict(zip(shares, np.linspace(PALEST, 1.0, len(shares)) if len(shares) > 1 else [1.0], strict=True))
    for (order, share), group in changes.groupby(["order", "share"]):
        label = f"{100 * share:g} % of a {ORDINALS.get(order, f'{order}th')} harmonic"
        look = {"color": COLOURS.get(order, OTHER), "alpha": strengths[share], "label": label, "linewidth": 1.2}
        rows = around(group)
        axes.plot(rows.phase, 100.0 * rows.change, marker="o", markersize=2.0, **look)


def plot(*, drives: pd.DataFrame) -> Figure:
    changes = changes_of(drives)
    amplitudes = drives[["acceleration", "regime"]].drop_duplicates().sort_values("acceleration")
    figure = style.figure(style.PAGE, 105.0)
    panels = figure.subplots(len(MEASURES), len(amplitudes), sharex=True, sharey=True, squeeze=False)
    for (row, (name, label)), (column, place) in itertools.product(
        enumerate(MEASURES.items()), enumerate(amplitudes.itertuples())
    ):
        axes = panels[row][column]
        panel_changes = changes[(changes.measure == name) & (changes.acceleration == place.acceleration)]
        error = 100.0 * SURE * panel_changes.stderr.median()
        axes.axhspan(-error, error, color="0.88", linewidth=0.0, zorder=0)
        axes.axhline(0.0, color="black", linewidth=0.4, zorder=0)
        draw_changes(axes, panel_changes)
        if row == 0:
            axes.set_title(f"{place.acceleration:g} m/s², {place.regime}")
        if column == 0:
            axes.set_ylabel(f"change of\n{label} in %")
    panels[0][0].set_ylim(np.array([-1.1, 1.1]) * 100.0 * changes.change.abs().max())
    for axes in panels[-1]:
        axes.set_xlabel("phase of the\nharmonic in rad")
        axes.set_xticks([-np.pi, 0.0, np.pi], ["−π", "0", "π"])
        axes.set_xlim(-np.pi, np.pi)
    style.legend_above(figure, panels[0][0], ncols=drives[drives.order > 0].order.nunique())
    return figure
