"""The measured drive: measured and fitted waveform, path of the plate, and spectrum with the floor of the noise."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

COLOURS = {"along": "#0072B2", "normal": "#D55E00"}
NAMES = {"along": "along the track", "normal": "normal to the track"}
MEASURED = "0.55"
MILLI = 1e3  # mm per m


def draw_waveform(axes: Axes, axis: str, samples: pd.DataFrame, waveform: pd.DataFrame) -> None:
    """Samples of one axis over the phase, with the fitted waveform and its fundamental."""
    style.dots(axes, samples.cycle, samples[axis], MEASURED, 2.4, label="measured")
    fundamental = {"color": "black", "linewidth": 0.7, "linestyle": (0, (3, 2)), "label": "without harmonics"}
    axes.plot(waveform.cycle, waveform[f"{axis}_fundamental"], **fundamental)
    axes.plot(waveform.cycle, waveform[axis], color=COLOURS[axis], label="with the harmonics above the noise")
    axes.set_xlim(0.0, 1.0)
    axes.set_ylabel(f"{NAMES[axis]}\nin m/s²")


def draw_path(axes: Axes, waveform: pd.DataFrame) -> None:
    """The path of the plate, with and without harmonics."""
    for ending, look in (
        ("", {"color": style.PLATE, "linewidth": 1.6}),
        ("_fundamental", {"color": "black", "linewidth": 0.7, "linestyle": (0, (3, 2))}),
    ):
        path = [MILLI * waveform[f"{axis}_displacement{ending}"] for axis in COLOURS]
        axes.plot(*path, **look)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("displacement along the track in mm")
    axes.set_ylabel("normal to the track in mm")
    axes.set_title("path of the plate")


def draw_spectrum(axes: Axes, spectrum: pd.DataFrame, harmonics: pd.DataFrame, frequency: float) -> None:
    """Amplitude spectra with the floor of the noise; dots mark harmonics above it."""
    for axis, colour in COLOURS.items():
        axes.plot(spectrum.frequency, spectrum[axis], color=colour, linewidth=0.6, label=NAMES[axis])
        floor = {"color": colour, "linewidth": 0.8, "linestyle": ":", "label": f"noise {NAMES[axis]}"}
        axes.plot(spectrum.frequency, spectrum[f"{axis}_floor"], **floor)
        above = harmonics[harmonics[f"{axis}_above_noise"]]
        peaks = [
            spectrum[axis][(spectrum.frequency - order * frequency).abs() < 0.25 * frequency].max()
            for order in above.order
        ]
        axes.plot(above.order * frequency, peaks, "o", color=colour, markersize=3.0)
    floors = spectrum[[f"{axis}_floor" for axis in COLOURS]].to_numpy()
    axes.set_yscale("log")
    axes.set_ylim(bottom=max(0.3 * np.median(floors), 1e-9 * spectrum[list(COLOURS)].to_numpy().max()))
    axes.set_xlim(0.0, spectrum.frequency.max())
    axes.set_xlabel("frequency in Hz")
    axes.set_ylabel("amplitude in m/s²")
    axes.legend(loc="upper right", ncols=4)


def plot(
    *,
    parameters: pd.DataFrame,
    harmonics: pd.DataFrame,
    samples: pd.DataFrame,
    waveform: pd.DataFrame,
    spectrum: pd.DataFrame,
) -> Figure:
    figure = style.figure(style.PAGE, 130.0)
    panels = figure.subplot_mosaic(
        [["along", "path"], ["normal", "path"], ["spectrum", "spectrum"]],
        height_ratios=[1, 1, 1.2],
        width_ratios=[1.25, 1],
    )
    for axis in COLOURS:
        draw_waveform(panels[axis], axis, samples, waveform)
    panels["along"].tick_params(labelbottom=False)
    panels["normal"].set_xlabel("phase in cycles")
    style.legend_above(figure, panels["along"], ncols=3)
    draw_path(panels["path"], waveform)
    frequency = parameters.set_index("parameter").value["frequency"]
    draw_spectrum(panels["spectrum"], spectrum, harmonics, frequency)
    return figure
