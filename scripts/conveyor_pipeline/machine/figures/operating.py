"""Operating chart over the amplitude: regimes, velocities, and the share of initial conditions with the fastest one."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from conveyor import throw_velocity
from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.figures.basin_stability import ends_of, throw_axis
from conveyor_pipeline.machine.operating.regimes import BESIDE, CHAOS, ONE, SEVERAL, UNKNOWN, summarize_amplitudes

LOOKS = {
    ONE: {"facecolor": "#56B4E9"},
    SEVERAL: {"facecolor": "#F0E442"},
    BESIDE: {"facecolor": "white", "edgecolor": style.STATE_COLOURS["chaos"], "hatch": "//////"},
    CHAOS: {"facecolor": style.STATE_COLOURS["chaos"]},
    UNKNOWN: {"facecolor": style.STATE_COLOURS["undecided"]},
}
LABEL = 0.09  # height of a label in the lowest panel that has labels, over the height of this panel


def draw_regimes(strip: Axes, shares: pd.DataFrame, regimes: pd.DataFrame) -> list[Patch]:
    """Draw a strip with the regime at each amplitude, below an axis for the throw number. Returns legend handles."""
    amplitudes = np.sort(shares.acceleration.unique())
    begin, end = ends_of(amplitudes)
    for row in regimes.itertuples():
        left, right = begin[np.searchsorted(amplitudes, row.begin)], end[np.searchsorted(amplitudes, row.end)]
        strip.axvspan(left, right, linewidth=0.0, **LOOKS[row.regime])
    strip.set_yticks([])
    strip.spines[["left", "bottom"]].set_visible(False)
    strip.tick_params(bottom=False)
    throw_axis(strip, shares)
    return [Patch(**look, label=regime) for regime, look in LOOKS.items() if (regimes.regime == regime).any()]


def mark_advice(axes: Axes, advice: pd.DataFrame) -> None:
    """Draw a line with a label at each advised amplitude, above all that is drawn before."""
    middle = np.mean(axes.get_xlim())
    lines = advice.acceleration.nunique()
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    axes.set_ylim(top=scale.inverted().transform(low + (high - low) / (1.0 - LABEL * lines)))
    for line, (acceleration, aims) in enumerate(advice.groupby("acceleration", sort=False).aim):
        axes.axvline(acceleration, color="black", linewidth=0.6, linestyle=":")
        # The label lies on the side with more room, and the second one below the first.
        side, offset = ("right", -2) if acceleration > middle else ("left", 2)
        label = "\n" * line + " and ".join(aims)
        place = {"xycoords": ("data", "axes fraction"), "va": "top", "ha": side}
        style.note(axes, label, (acceleration, 1.0), (offset, -1), **place)


def plot(*, shares: pd.DataFrame, regimes: pd.DataFrame, advice: pd.DataFrame) -> Figure:
    """Draw shares and regimes of motion, with the advised amplitudes."""
    figure = style.figure(style.PAGE, 108.0)
    strip, velocities, share = figure.subplots(3, 1, sharex=True, height_ratios=(0.35, 3.0, 2.0))
    handles = draw_regimes(strip, shares, regimes)
    amplitudes = np.sort(shares.acceleration.unique())

    best = summarize_amplitudes(shares)
    alone = {"marker": "o"} if len(amplitudes) == 1 else {}
    if best.best.isna().all():
        style.say(share, "the fastest motion is not known at any amplitude")
    else:
        velocities.fill_between(best.acceleration, best.slowest, best.best, color="0.88", linewidth=0.0)
        velocities.plot(best.acceleration, best.best, color="black", label="fastest motion", **alone)
        look = {"color": "black", "linewidth": 0.8, "linestyle": (0, (3, 2))}
        velocities.plot(best.acceleration, best["mean"], label="mean over all initial conditions", **look, **alone)
        velocities.plot(
            best.acceleration, best.slowest, color="0.5", linewidth=0.8, linestyle=":", label="slowest motion", **alone
        )
    velocities.plot(amplitudes, throw_velocity(amplitudes, **shares.attrs["model"]), **style.TEXTBOOK, **alone)
    velocities.axhline(0.0, color="black", linewidth=0.4, zorder=0)
    style.velocity_axis(velocities.yaxis)

    low, high = (100.0 * (best.best_share + side * best.stderr).clip(0.0, 1.0) for side in (-2.0, 2.0))
    share.fill_between(best.acceleration, low, high, color="0.75", linewidth=0.0, step="mid")
    share.plot(best.acceleration, 100.0 * best.best_share, color="black", drawstyle="steps-mid", **alone)
    share.set_ylim(0.0, 104.0)
    share.set_ylabel("share of the\nfastest motion in %")
    share.set_xlabel(style.AMPLITUDE)
    style.limit_x(share, amplitudes)
    mark_advice(velocities, advice)
    figure.align_ylabels([velocities, share])
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
    velocities.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return figure
