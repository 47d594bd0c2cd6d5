"""Cost and visible effect of cheaper variants of the table behind each figure."""

import math

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from conveyor_pipeline.figures import style
from conveyor_pipeline.study.accuracy.limits import PIXELS

TOLERANCES = {1e-4: "#D55E00", 1e-6: "#E69F00", 1e-8: "#009E73", 1e-10: "#56B4E9", 1e-12: "#0072B2"}
VARIANTS = {"half the time": ("s", "#CC79A7"), "rigid part": ("^", "black")}
NONE = 3e-4  # place of zero on the logarithmic axis
RING = {"linestyle": "", "marker": "o", "markersize": 8.0, "markerfacecolor": "none", "color": "black"}
FULL = {"linestyle": "", "marker": "|", "color": "black", "markersize": 9.0}


def marker_and_colour(row) -> tuple[str, str]:
    """Marker and colour of a variant; a tolerance has the colour of the nearest one in TOLERANCES."""
    if row.variant in VARIANTS:
        return VARIANTS[row.variant]
    nearest = min(TOLERANCES, key=lambda tolerance: abs(tolerance / row.tolerance - row.tolerance / tolerance))
    return "o", TOLERANCES[nearest]


def power_of_ten(value: float) -> str:
    """The power of ten that is nearest to a value, for a label."""
    return f"$10^{{{round(math.log10(value))}}}$"


def figure_label(figure: str) -> str:
    """The name of a figure for readers, "Fig. 3" or "work precision"."""
    number = figure.removeprefix("fig")
    return f"Fig. {int(number)}" if number.isdigit() else figure.replace("_", " ")


def plot(*, budget: pd.DataFrame, times: pd.DataFrame) -> Figure:
    """Draw costs and visible changes of each table's variants."""
    table = budget.merge(times, on=["table", "variant", "tolerance"], how="left")
    drawn = table[table.table != "none"]
    names = list(dict.fromkeys(drawn.table))
    figures = drawn.groupby("table").figure.unique().map(lambda drawing: ", ".join(map(figure_label, drawing)))
    rows = drawn.drop_duplicates(["table", "variant", "tolerance"])
    rows = rows.assign(place=rows.table.map(names.index), seen=rows.changed.clip(lower=NONE))

    figure = style.figure(style.PAGE, 22.0 + 8.0 * len(names))
    cost, changes = figure.subplots(1, 2, sharey=True)
    full = rows[rows.variant == "full model"]
    cost.plot(1e3 * full.seconds, full.place, **FULL)
    cheaper = (rows.variant != "full model") & (rows.tolerance.notna() | rows.variant.isin(VARIANTS))
    # The chosen variant is drawn last, so that its own colour is inside the ring.
    for row in rows[cheaper].sort_values("chosen", kind="stable").itertuples():
        marker, colour = marker_and_colour(row)
        look = {"color": colour, "markerfacecolor": "white" if row.visible else colour}
        for axes, x in ((cost, 1e3 * row.seconds), (changes, row.seen)):
            axes.plot(x, row.place, marker, markersize=3.5, markeredgewidth=0.7, **look)
    chosen = rows[rows.chosen]
    cost.plot(1e3 * chosen.seconds, chosen.place, markeredgewidth=0.8, **RING)
    changes.plot(chosen.seen, chosen.place, markeredgewidth=0.8, **RING)
    changes.axvline(PIXELS, color="black", linewidth=0.6, linestyle=":")
    cost.set_yticks(range(len(names)), [f"{figures[name]}\n{name}" for name in names])
    cost.set_ylim(len(names) - 0.5, -0.5)
    for axes in (cost, changes):
        axes.set_xscale("log")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(axis="y", linewidth=0.3)
    cost.set_xlabel("processor time per point in ms")
    changes.set_xticks([NONE, 1e-3, 1e-2, 1e-1, 1.0], ["none", "0.001", "0.01", "0.1", "1"])
    changes.set_xlabel("share of drawn values with a visible change")
    handles = [
        Line2D([], [], linestyle="", marker="o", color=colour, label=f"tolerance {power_of_ten(tolerance)}")
        for tolerance, colour in TOLERANCES.items()
    ]
    handles += [
        Line2D([], [], linestyle="", marker=marker, color=colour, label=name)
        for name, (marker, colour) in VARIANTS.items()
    ]
    handles += [
        Line2D([], [], linestyle="", marker="o", color="0.5", markerfacecolor="white", label="open: visible"),
        Line2D([], [], label="chosen", **RING),
        Line2D([], [], label=f"full model, tolerance {power_of_ten(full.tolerance.iloc[0])}", **FULL),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=5)
    return figure
