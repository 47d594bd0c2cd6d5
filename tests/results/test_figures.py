"""All figures as they have been made: the journal's size, units on every axis, fonts, equal bytes, fine maps."""

import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.legend
import matplotlib.text
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from draw import draw
from figures import style
from made import FIGURES, RESULTS, entries
from workflow.tables_of_config import kind_of

ENTRIES = entries()


def in_one_process(names):
    """Parameters: one process looks at all of a figure, which it draws once."""
    return [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in names]


FIGURE = in_one_process(ENTRIES)
MAP = in_one_process(("fig12", "fig13", "fig14", "fig18", "fig19"))
PAGE_HEIGHT = 234.0  # mm, of the journal's page
UNITS = {
    "m/s²",
    "$g/\\omega^2$ and $g/\\omega$",
    "m/s",
    "m",
    "mm",
    "µm",
    "mN",
    "Hz",
    "s",
    "ms",
    "rad",
    "1/s",
    "m²/s²",
    "10$^{-3}$ m²/s²",
    "N/m",
    "N s/m",
    "10$^5$ N/m$^{1.5}$",
    "cm/s",
    "°",
    "%",
    "% for 1 % more",
    "µm for 1 % more",
}
# Counts and ratios.
NO_UNIT = (
    "dimension",
    "error",
    "evaluations",
    "cycles",
    "points",
    "share",
    "relative",
    "samples",
    "changes",
    "friction",
    "misfit",
    "group",
)


@cache
def drawn(name):
    """A figure once more from its tables, and the page that it is saved as; its layout is the one of that page."""
    entry = ENTRIES[name]
    paths, kinds = {}, {}
    for role, reference in entry["tables"].items():
        section, table = reference.split("/")
        paths[role] = RESULTS / (f"{table}.parquet" if section == "results" else f"{reference}.parquet")
        kinds[role] = kind_of(reference)
    figure = draw(name, paths, kinds, entry.get("settings", {}), asked={})
    with TemporaryDirectory() as folder:
        copy = Path(folder, f"{name}.pdf")
        style.save(figure, [str(copy)])
        page = copy.read_bytes()
    FigureCanvasAgg(figure).draw()
    return figure, page


@pytest.mark.parametrize("name", FIGURE)
def test_size_and_type_are_the_journal_s(name):
    figure, _ = drawn(name)
    assert round(figure.get_figwidth() / style.MM, 6) in (style.COLUMN, style.PAGE)
    assert figure.get_figheight() / style.MM <= PAGE_HEIGHT
    texts = [text for text in figure.findobj(matplotlib.text.Text) if text.get_text() and text.get_visible()]
    assert min(text.get_fontsize() for text in texts) >= 7.0


@pytest.mark.parametrize("name", FIGURE)
def test_legends_and_labels_are_not_cut(name):
    figure, _ = drawn(name)
    whole = figure.bbox.padded(1.0)  # pixel
    named = [label for axes in figure.axes for label in (axes.title, axes.xaxis.label, axes.yaxis.label)]
    for artist in [*figure.findobj(matplotlib.legend.Legend), *(one for one in named if one.get_text())]:
        if artist.get_visible() and (artist.axes is None or artist.axes.axison):
            extent = artist.get_window_extent(figure.canvas.get_renderer())
            assert whole.contains(extent.x0, extent.y0) and whole.contains(extent.x1, extent.y1), artist


@pytest.mark.parametrize("name", FIGURE)
def test_axes_have_units(name):
    """An axis, or one that shares its scale, names a quantity with its unit, unless its ticks are words."""
    for axes in drawn(name)[0].axes:
        if not axes.axison:
            continue
        for axis, shared in (("xaxis", axes.get_shared_x_axes()), ("yaxis", axes.get_shared_y_axes())):
            siblings = [getattr(one, axis) for one in shared.get_siblings(axes)]
            labels = {one.get_label_text() for one in siblings} - {""}
            assert labels or any(in_words(one) for one in siblings), f"{axis} without a label"
            for label in labels:
                unit = " ".join(label.split()).rsplit(" in ", 1)[-1]
                assert unit in UNITS or any(word in label for word in NO_UNIT), label


def in_words(axis):
    """Whether the ticks of an axis are words, or absent."""
    texts = [label.get_text() for label in axis.get_ticklabels()]
    return not texts or any(re.search("[a-z]{3}", text) for text in texts)


@pytest.mark.parametrize("name", FIGURE)
def test_pages_are_equal_vectors_with_embedded_fonts(name):
    """Equal to the byte to those of another process, which has drawn nothing else."""
    _, page = drawn(name)
    assert (FIGURES / f"{name}.pdf").read_bytes() == page
    assert b"/FontFile2" in page
    assert b"/Type3" not in page


@pytest.mark.parametrize("name", MAP)
def test_maps_are_rasterised_finely(name):
    figure, page = drawn(name)
    width = max(map(int, re.findall(rb"/Width (\d+)", page)))
    wanted = figure.axes[0].get_position().width * figure.get_figwidth() * style.RESOLUTION
    assert width == pytest.approx(wanted, rel=0.02)
