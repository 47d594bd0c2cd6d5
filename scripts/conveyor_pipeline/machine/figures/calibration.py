"""Calibration: measured velocities with the predicted band, and the posterior of each parameter and each pair."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter, LogLocator, MaxNLocator, NullFormatter, ScalarFormatter

from conveyor_pipeline.figures import style
from conveyor_pipeline.machine.calibration.search_space import LOGARITHMIC
from conveyor_pipeline.machine.figures.basin_stability import ends_of

MISFIT = "#D55E00"
BAND = "#56B4E9"
BINS = 18
# Ratios of values from which their axis is logarithmic, and from which only powers of ten are labelled.
MUCH, MANY = 12.0, 1e3
LONG = 1e4  # numbers from which on only powers of ten are labelled, too


def draw_velocities(axes: Axes, fit: pd.DataFrame, prediction: pd.DataFrame) -> None:
    """Measured velocities over the predicted band."""
    if len(prediction) == 1:
        # All measurements have one amplitude, where a band has no width.
        below, above = ends_of(prediction.acceleration.to_numpy())
        prediction = pd.concat([prediction.assign(acceleration=below), prediction.assign(acceleration=above)])
    axes.fill_between(
        prediction.acceleration,
        prediction.low,
        prediction.high,
        color=BAND,
        alpha=0.35,
        linewidth=0.0,
        label="predicted for one part, 5 % to 95 %",
    )
    axes.plot(prediction.acceleration, prediction["median"], color=style.CONVERGED, linewidth=0.8, label="median")
    fitting = {"color": "black", "marker": "o", "markersize": 2.6}
    for chosen, look in (
        (fit.fits & ~fit.changed, {**fitting, "label": "measured"}),
        (fit.fits & fit.changed, {**fitting, "markerfacecolor": "white", "label": "measured under other conditions"}),
        (~fit.fits, {"color": MISFIT, "marker": "X", "markersize": 4.0, "label": "does not fit"}),
    ):
        rows = fit[chosen]
        if len(rows):
            options = {"linestyle": "none", "markeredgewidth": 0.6}
            axes.errorbar(rows.acceleration, rows.velocity, yerr=2.0 * rows.sd, elinewidth=0.6, **options, **look)
    axes.axhline(0.0, color="black", linewidth=0.4, zorder=0)
    axes.set_xlabel(style.AMPLITUDE)
    style.velocity_axis(axes.yaxis)
    axes.legend(loc="best")


def label_of(row: pd.Series) -> str:
    """Name and unit of a parameter."""
    name = row.parameter.replace("_", " ")
    return name if row.unit == "1" else f"{name} in {row.unit}"


def scale(axes: Axes, direction: str, name: str, values: np.ndarray) -> None:
    """The scale and the ticks of an axis of a parameter: logarithmic if the values differ by much."""
    axis = getattr(axes, f"{direction}axis")
    if name in LOGARITHMIC and values.max() > MUCH * values.min():
        getattr(axes, f"set_{direction}scale")("log")
        if values.max() > MANY * values.min() or values.max() >= LONG:
            axis.set_major_locator(LogLocator(numticks=4))
        else:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=4))
            axis.set_major_formatter(FormatStrFormatter("%g"))
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(3))
        axis.set_major_formatter(ScalarFormatter(useMathText=True))
        axes.ticklabel_format(axis=direction, scilimits=(-3, 4))


def draw_posterior(panels: np.ndarray, parameters: pd.DataFrame, samples: pd.DataFrame) -> None:
    """Histograms of the parameters on the diagonal of `panels`, shape (d, d), and pairs of parameters below it."""
    rows = list(parameters.itertuples())
    for below, vertical in enumerate(rows):
        for beside, horizontal in enumerate(rows):
            axes = panels[below, beside]
            if beside > below:
                axes.set_visible(False)
                continue
            x = samples[horizontal.parameter].to_numpy()
            scale(axes, "x", horizontal.parameter, x)
            if beside == below:
                log = horizontal.parameter in LOGARITHMIC
                edges = np.geomspace(x.min(), x.max(), BINS) if log else np.linspace(x.min(), x.max(), BINS)
                axes.hist(x, edges, color="0.75")
                axes.axvline(vertical.best, color="black", linewidth=0.8)
                for end in (vertical.low, vertical.high):
                    axes.axvline(end, color="black", linewidth=0.8, linestyle=(0, (3, 2)))
                axes.set_yticks([])
            else:
                y = samples[vertical.parameter].to_numpy()
                scale(axes, "y", vertical.parameter, y)
                axes.plot(x, y, linestyle="none", marker=".", markersize=2.0, color="0.4", rasterized=True)
                axes.plot([horizontal.best], [vertical.best], marker="+", color="black", markersize=7.0)
            if below == len(rows) - 1:
                axes.set_xlabel(label_of(horizontal))
            else:
                axes.tick_params(labelbottom=False)
            if beside == 0 and below > 0:
                axes.set_ylabel(label_of(vertical))
            elif beside != below:
                axes.tick_params(labelleft=False)


def draw_measured(axes: Axes, fit: pd.DataFrame) -> None:
    """Measured velocities alone, because the search has not converged."""
    axes.errorbar(fit.acceleration, fit.velocity, 2.0 * fit.sd, elinewidth=0.6, fmt="ok", markersize=2.6)
    axes.set_title("The search has not converged: no parameters, no prediction")
    axes.set_xlabel(style.AMPLITUDE)
    style.velocity_axis(axes.yaxis)


def plot(*, parameters: pd.DataFrame, samples: pd.DataFrame, fit: pd.DataFrame, prediction: pd.DataFrame) -> Figure:
    """Draw the calibration."""
    if samples.empty:
        figure = style.figure(style.PAGE, 62.0)
        draw_measured(figure.subplots(), fit)
        return figure
    count = len(parameters)
    figure = style.figure(style.PAGE, 62.0 + 32.0 * count)
    above, under = figure.subfigures(2, 1, height_ratios=(62.0, 32.0 * count))
    draw_velocities(above.subplots(), fit, prediction)
    panels = under.subplots(count, count, squeeze=False, sharex="col")
    draw_posterior(panels, parameters, samples)
    under.align_ylabels(panels[:, 0])
    return figure
