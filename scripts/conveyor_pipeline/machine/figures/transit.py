"""Transit of parts: velocities over the amplitude, and the relative spread over amplitude and length of the track."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.figures.operating import draw_regimes, mark_advice
from conveyor_pipeline.machine.operating.populations import IDENTICAL, POPULATIONS, VARIED, differences
from conveyor_pipeline.machine.operating.regimes import CHAOS

COLOURS = {IDENTICAL: "#56B4E9", VARIED: "0.25"}
LABELS = {IDENTICAL: "identical parts", VARIED: "varied parts"}
MARKERS = ("o", "s", "^")


def populations_of(transit: pd.DataFrame) -> tuple[str, ...]:
    """The populations to draw: parts without differences are one population."""
    return POPULATIONS if any(differences(transit.attrs).values()) else (IDENTICAL,)


def draw_bands(axes: Axes, transit: pd.DataFrame) -> None:
    """The median, and the band with 90 % of the parts, of each population; the band of varied parts as two lines."""
    for population in populations_of(transit):
        rows = transit[transit.population == population]
        colour = COLOURS[population]
        label = f"{LABELS[population]}: median, and 5 to 95 %"
        axes.plot(
            rows.acceleration, 100.0 * rows.velocity_50, style.line(rows), color=colour, label=label, linewidth=1.3
        )
        ends = 100.0 * rows.velocity_05, 100.0 * rows.velocity_95
        if len(rows) == 1:
            bar = {"linewidth": 8.0, "alpha": 0.35} if population == IDENTICAL else {"linewidth": 1.3}
            axes.vlines(rows.acceleration, *ends, color=colour, **bar)
        elif population == IDENTICAL:
            axes.fill_between(rows.acceleration, *ends, color=colour, alpha=0.35, linewidth=0.0)
        else:
            for end in ends:
                axes.plot(rows.acceleration, end, color=colour, linewidth=0.7, linestyle=(0, (3, 2)))
    axes.axhline(0.0, color="black", linewidth=0.4, zorder=0)


def draw_lengths(axes: Axes, lengths: pd.DataFrame) -> None:
    """The relative spread over the length at each amplitude, with the spread that drift and diffusion predict."""
    if not (lengths.spread > 0.0).any():
        reason = "at no amplitude of the table do\nmotions coexist or is chaos alone"
        style.say(axes, "all velocities are equal,\nor half of the parts do not move" if len(lengths) else reason)
        axes.set(xticks=[], yticks=[])
        return
    numbers = dict.fromkeys(lengths.regime, 0)
    for (acceleration, regime), rows in lengths.groupby(["acceleration", "regime"]):
        colour = style.STATE_COLOURS["chaos"] if regime == CHAOS else style.STATE_COLOURS["first"]
        look = {"color": colour, "fmt": MARKERS[numbers[regime] % len(MARKERS)], "markersize": 3.5, "linewidth": 0.8}
        look |= {"markerfacecolor": "none" if numbers[regime] else colour}
        label = f"{acceleration:.4g} m/s², {'chaos' if regime == CHAOS else 'coexisting motions'}"
        axes.errorbar(rows.length, rows.spread, rows.spread_stderr, label=label, **look)
        if rows.predicted.notna().any():
            axes.plot(rows.length, rows.predicted, color=colour, linewidth=0.9, linestyle=(0, (3, 2)))
        numbers[regime] += 1
    if lengths.predicted.notna().any():
        look = {"color": style.STATE_COLOURS["chaos"], "linewidth": 0.9, "linestyle": (0, (3, 2))}
        axes.plot([], [], label="by drift and diffusion", **look)
        ends = np.array([lengths.length.min(), lengths.length.max()])
        highest = lengths.predicted.max()
        axes.plot(ends, 1.5 * highest * (ends / ends[0]) ** -0.5, color="0.5", linewidth=0.8, label="slope −1/2")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(lengths.length.unique(), [f"{length:g}" for length in lengths.length.unique()])
    axes.xaxis.minorticks_off()


def plot(
    *,
    transit: pd.DataFrame,
    shares: pd.DataFrame,
    regimes: pd.DataFrame,
    lengths: pd.DataFrame,
    advice: pd.DataFrame,
) -> Figure:
    """Draw bands of velocities below the regimes, and relative spreads, with the advised amplitudes."""
    figure = style.figure(style.PAGE, 118.0)
    above, below = figure.subfigures(2, 1, height_ratios=(1.5, 1.0))
    strip, bands = above.subplots(2, 1, sharex=True, height_ratios=(0.12, 1.0))
    spreads, tracks = below.subplots(1, 2)
    handles = draw_regimes(strip, shares, regimes)
    draw_bands(bands, transit)
    style.limit_x(bands, transit.acceleration)
    bands.set_xlabel(style.AMPLITUDE)
    bands.set_ylabel("transit velocity in cm/s")
    bands.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    for population in populations_of(transit):
        rows = transit[transit.population == population]
        spreads.plot(rows.acceleration, rows.spread, style.line(rows), color=COLOURS[population])
    if (transit.spread > 0.0).any():
        spreads.set_yscale("log")
    else:
        style.say(spreads, "no part was followed, half of\nthe parts have not moved,\nor all velocities are equal")
    style.limit_x(spreads, transit.acceleration)
    for axes in (bands, spreads):
        mark_advice(axes, advice)
    spreads.set_xlabel(style.AMPLITUDE)
    spreads.set_ylabel("relative spread")
    draw_lengths(tracks, lengths)
    tracks.set_xlabel("length of the track in m")
    tracks.set_ylabel("relative spread")
    below.legend(*tracks.get_legend_handles_labels(), loc="outside right center")
    above.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    style.letter(bands, spreads, tracks)
    return figure
