"""Style of all figures: sizes, fonts, colours, labels, and the function that saves them."""

import os
import string
from collections.abc import Iterable
from contextlib import AbstractContextManager
from io import BytesIO

# Figures are only written to files. Matplotlib reads this variable on import. It fails if the variable names a backend
# that is not installed, as in the terminal of Jupyter.
os.environ["MPLBACKEND"] = "agg"

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import LogFormatterSciNotation, LogLocator, MaxNLocator, NullFormatter, NullLocator

MM = 1.0 / 25.4
COLUMN = 84.0  # mm, width of a column of the journal
PAGE = 174.0  # mm, width of its page

# Colours of Okabe and Ito, which colour-blind readers can distinguish.
STATE_COLOURS = {"first": "#0072B2", "second": "#E69F00", "chaos": "#009E73", "undecided": "#CC79A7"}
CONVERGED = "#0072B2"
EULER = "#D55E00"
SECOND_ESTIMATE = "#CC79A7"  # next to CONVERGED; not green, which means chaos
PLATE = "#555555"
AMPLITUDE = "acceleration amplitude $\\hat{a}$ in m/s²"
THROW_NUMBER = "throw number $\\Gamma = a_z / (g\\,\\cos\\alpha)$"
VELOCITY = "mean feeding velocity in cm/s"
# Colour and name of every method that the solver is compared with.
METHODS = {
    "event": (CONVERGED, "this solver"),
    "euler": (EULER, "explicit Euler"),
    "semi_implicit_euler": ("#E69F00", "semi-implicit Euler"),
    "rk4": ("#000000", "RK4, fixed step"),
    "RK45": ("#56B4E9", "RK45"),
    "DOP853": ("#009E73", "DOP853"),
    "Radau": ("#CC79A7", "Radau"),
    "LSODA": ("#8C6D31", "LSODA"),
}
# Colour and label of the paper's method and of the converged solution, by role of their tables.
LOOKS = {
    "euler": {"color": EULER, "label": "paper's method (explicit Euler)"},
    "converged": {"color": CONVERGED, "label": "converged solution"},
}
# Curves of both methods in one panel: dashes over a solid line, so that both are visible where they coincide.
CURVES = {
    "converged": LOOKS["converged"] | {"linewidth": 1.4},
    "euler": LOOKS["euler"] | {"linewidth": 0.8, "linestyle": (0, (3, 3))},
}
TEXTBOOK = {"color": "#D55E00", "linewidth": 1.0, "linestyle": (0, (5, 1, 1, 1)), "label": "textbook theory"}
# Wide and pale, because it is drawn behind the curves of the part.
PLATE_CURVE = {"color": "0.8", "linewidth": 2.5, "label": "conveyor"}

RESOLUTION = 600  # dpi of rasterised parts and of PNG files
DIGITS = 9  # of positions, in units of the figure's width and height
PARAMETERS = {
    "font.family": "DejaVu Sans",
    "font.size": 7.5,
    "mathtext.fontset": "dejavusans",
    "axes.labelsize": 7.5,
    "axes.titlesize": 7.5,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.columnspacing": 1.2,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.0,
    "figure.constrained_layout.use": True,
    "pdf.fonttype": 42,  # embedded as TrueType: text stays text
}


def applied() -> AbstractContextManager:
    """A context manager; figures made within it have this style, whatever the user's matplotlibrc says."""
    defaults = {name: value for name, value in mpl.rcParamsDefault.items() if name != "backend"}
    return mpl.rc_context(defaults | PARAMETERS)


def figure(width: float, height: float) -> Figure:
    """An empty figure with a width and a height in mm."""
    return Figure(figsize=(width * MM, height * MM))


def velocity_axis(axis: Axis) -> None:
    """Label an axis of mean feeding velocities (m/s) in cm/s, the unit of the paper's text."""
    axis.set_label_text(VELOCITY)
    axis.set_major_formatter(lambda value, _: f"{100.0 * value:.6g}")


def velocity_panels(figure: Figure, roles: Iterable[str], xlabel: str) -> list[Axes]:
    """Panels of feeding velocities side by side, one per method in the order of `roles`, with common scales."""
    names = [LOOKS[role]["label"] for role in roles]
    panels = figure.subplots(1, len(names), sharex=True, sharey=True, squeeze=False)[0]
    for axes, name in zip(panels, names, strict=True):
        axes.set_title(name)
        axes.set_xlabel(xlabel)
    velocity_axis(panels[0].yaxis)
    return list(panels)


def from_zero(*panels: Axes) -> None:
    """Start the vertical axis, which all panels share, at zero if no value is negative. It ends above all values."""
    curves = [line.get_ydata() for axes in panels for line in axes.lines if line.get_transform() == axes.transData]
    if min((np.nanmin(values) for values in curves if len(values)), default=0.0) >= 0.0:
        highest = max((np.nanmax(values) for values in curves if len(values)), default=1.0)
        panels[0].set_ylim(0.0, max(panels[0].get_ylim()[1], 1.02 * highest))


def note(axes: Axes, text: str, place: tuple, offset: tuple[float, float] = (0.0, 0.0), **options) -> None:
    """Write a small text at a place of the axes, shifted by an offset in points; options of `Axes.annotate`."""
    axes.annotate(text, place, xytext=offset, textcoords="offset points", size=7.0, **options)


def line(rows: pd.DataFrame) -> str:
    """The format of a curve in `Axes.plot`: a single row is a dot."""
    return "o" if len(rows) == 1 else "-"


def dots(axes: Axes, x: Iterable, y: Iterable, colour: str, size: float, **options) -> None:
    """Draw dots of a size in points, without edges and lines; options of `Axes.plot`."""
    axes.plot(x, y, ".", color=colour, markersize=size, markeredgewidth=0.0, **options)


def mark(axes: Axes, x: float, label: str) -> None:
    """Draw a thin vertical line at x with a label at its upper end."""
    axes.axvline(x, color="black", linewidth=0.6, linestyle=":")
    note(axes, label, (x, 1.0), (2, -1), xycoords=("data", "axes fraction"), va="top")


def borders(places: np.ndarray) -> np.ndarray:
    """The borders of cells around ascending places; a single one gets a cell of a tenth of its size."""
    if len(places) == 1:
        half = 0.05 * abs(places[0]) or 0.5
        return np.array([places[0] - half, places[0] + half])
    middle = 0.5 * (places[1:] + places[:-1])
    return np.concatenate([[2.0 * places[0] - middle[0]], middle, [2.0 * places[-1] - middle[-1]]])


def class_map(axes: Axes, classes: pd.DataFrame, colours: dict[str, str]) -> None:
    """Draw a map of named classes; `classes` has x in its columns and y in its index, `colours` is keyed by class."""
    numbers = {name: number for number, name in enumerate(colours)}
    axes.pcolormesh(
        borders(classes.columns.to_numpy()),
        borders(classes.index.to_numpy()),
        classes.replace(numbers).to_numpy(dtype=float),
        cmap=ListedColormap(list(colours.values())),
        vmin=-0.5,
        vmax=len(colours) - 0.5,
        shading="flat",
        rasterized=True,
    )


def state_map(axes: Axes, table: pd.DataFrame, x: str, y: str) -> None:
    """Draw a map of the column `state` of a sweep over its axes `x` and `y`, in the units of the table."""
    class_map(axes, table.pivot(index=y, columns=x, values="state"), STATE_COLOURS)


def limit_x(axes: Axes, places: Iterable[float]) -> None:
    """Let the x axis end at the smallest and the largest place; a single one is in the middle of a short axis."""
    low, high = min(places), max(places)
    axes.set_xlim((low, high) if low < high else (0.95 * low, 1.05 * high))


def letter(*panels: Axes, **options) -> None:
    """Write a, b, c, … above the left ends of panels; options of `Axes.set_title`."""
    for axes, name in zip(panels, string.ascii_lowercase, strict=False):
        axes.set_title(name, loc="left", weight="bold", **options)


def say(axes: Axes, text: str) -> None:
    """Write in the middle of empty axes why there is nothing to show."""
    box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
    note(axes, text, (0.5, 0.5), xycoords="axes fraction", ha="center", va="center", bbox=box)


def state_label(state: str) -> str:
    """The name of a state of motion in legends and titles: "first state", "chaos"."""
    return f"{state} state" if state in ("first", "second") else state


def state_handles(*tables: pd.DataFrame) -> list[Artist]:
    """Legend handles of the states of motion that occur in the tables."""
    occur = set().union(*(table.state.unique() for table in tables))
    return [Patch(color=colour, label=state_label(state)) for state, colour in STATE_COLOURS.items() if state in occur]


def state_legend(figure: Figure, table: pd.DataFrame) -> None:
    """Draw a legend of the states in a table above a figure of one column, in which three states fit side by side."""
    handles = state_handles(table)
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles) if len(handles) <= 3 else 2)


def phase_axis(axis: Axis) -> None:
    """Set the ticks of an axis of phases (rad) to multiples of π/2."""
    names = ("0", "π/2", "π", "3π/2", "2π")
    axis.set_ticks(0.5 * np.pi * np.arange(len(names)), names)


def label_powers(axis: Axis) -> None:
    """Label a logarithmic axis at powers of ten, and between them where fewer than two powers are visible.

    Labels of all minor ticks would overlap. Call this after the data are drawn.
    """
    low, high = np.log10(axis.get_view_interval())
    if np.floor(high) - np.ceil(low) >= 1.0:
        axis.set_minor_formatter(NullFormatter())
        return
    for set_formatter in (axis.set_major_formatter, axis.set_minor_formatter):
        set_formatter(LogFormatterSciNotation(minor_thresholds=(np.inf, np.inf)))  # labels all ticks
    if high - low > 1.0:
        axis.set_minor_locator(LogLocator(subs=(2.0, 5.0)))
    else:
        axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
        axis.set_minor_locator(NullLocator())


def legend_above(figure: Figure, axes: Axes, **options) -> None:
    """Draw a legend of the artists of `axes` above all panels, where it hides no data."""
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", **options)


def lay_out(figure: Figure) -> None:
    """Lay a figure out for a PDF page, and keep this layout in all files.

    Positions are rounded, because their last digits depend on the order of objects in memory, which differs between
    runs.
    """
    FigureCanvasPdf(figure)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for part in figure.subfigs:
        part.bbox_relative.set_points(part.bbox_relative.get_points().round(DIGITS))
    for axes in figure.axes:
        axes.set_position([round(number, DIGITS) for number in axes.get_position(original=True).bounds])


def encode(figure: Figure) -> dict[str, bytes]:
    """A figure as PDF and as PNG, without dates, so that equal figures have equal bytes."""
    files = {"pdf": BytesIO(), "png": BytesIO()}
    with applied():
        lay_out(figure)
        for form, file in files.items():
            metadata = {"CreationDate": None} if form == "pdf" else None
            figure.savefig(file, format=form, dpi=RESOLUTION, metadata=metadata)
    return {form: file.getvalue() for form, file in files.items()}
