"""All figures of the results: the journal's size, units on every axis, fonts, equal pages, fine maps."""

import re
from typing import NamedTuple

import matplotlib.legend
import matplotlib.text
import pytest
from matplotlib.figure import Figure

from conveyor_pipeline.common import tables
from conveyor_pipeline.config.tables import kind_of
from conveyor_pipeline.figures import plots, style
from made import FIGURES, RESULTS, ROOT, entries

ENTRIES = entries()
MAPS = ("fig12", "fig13", "fig14", "fig18", "fig19")
PAGE_HEIGHT = 234.0  # mm, of the journal's page
ABOVE_LETTERS = 0.02  # inch, of the height of a line of text
UNITS = {
    "m/s²",
    "$g/\\omega^2$ and $g/\\omega$",
    "$g\\,\\cos\\alpha/\\omega^2$",
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
    "m/s per rad",
    "time steps",
    "m²/s²",
    "10$^{-3}$ m²/s²",
    "N/m",
    "N s/m",
    "10$^5$ N/m$^{1.5}$",
    "cm/s",
    "°",
    "%",
    "% per % of the parameter",
    "µm per % of the parameter",
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
    "throw number",
    "measured / theory",
)


class Drawn(NamedTuple):
    """A figure that is drawn again from its tables, with the layout of the saved page."""

    name: str
    figure: Figure


def draw_again(name):
    """The figure `name`, drawn from its tables."""
    entry = ENTRIES[name]
    read = {
        role: tables.read(RESULTS / f"{reference.removeprefix('results/')}.parquet", kind_of(reference))
        for role, reference in entry["tables"].items()
    }
    marks = entry.get("marks", {}) if RESULTS == ROOT / "results" else {}  # with a prefix, figures have none
    return plots.draw(name, entry.get("settings", {}) | marks, **read)


@pytest.fixture(scope="module", params=ENTRIES)
def drawn(request):
    """Each figure in turn; pytest runs the tests of one figure one after the other."""
    figure = draw_again(request.param)
    with style.applied():
        style.lay_out(figure)
    return Drawn(request.param, figure)


def test_size_and_type_are_the_journal_s(drawn):
    figure = drawn.figure
    assert round(figure.get_figwidth() / style.MM, 6) in (style.COLUMN, style.PAGE)
    assert figure.get_figheight() / style.MM <= PAGE_HEIGHT
    texts = [text for text in figure.findobj(matplotlib.text.Text) if text.get_text() and text.get_visible()]
    assert min(text.get_fontsize() for text in texts) >= 7.0


def test_legends_and_labels_are_not_cut(drawn):
    figure = drawn.figure
    whole = figure.bbox.padded(ABOVE_LETTERS * figure.dpi)
    named = [label for axes in figure.axes for label in (axes.title, axes.xaxis.label, axes.yaxis.label)]
    for artist in [*figure.findobj(matplotlib.legend.Legend), *(one for one in named if one.get_text())]:
        if artist.get_visible() and (artist.axes is None or artist.axes.axison):
            extent = artist.get_window_extent()
            assert whole.contains(extent.x0, extent.y0) and whole.contains(extent.x1, extent.y1), artist


def test_axes_have_units(drawn):
    """An axis, or one that shares its scale, names a quantity with its unit, unless its ticks are words."""
    for axes in drawn.figure.axes:
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


def test_pages_have_embedded_fonts_and_fine_maps(drawn):
    page = (FIGURES / f"{drawn.name}.pdf").read_bytes()
    assert b"/FontFile2" in page
    assert b"/Type3" not in page
    if drawn.name in MAPS:
        width = max(map(int, re.findall(rb"/Width (\d+)", page)))
        wanted = drawn.figure.axes[0].get_position().width * drawn.figure.get_figwidth() * style.RESOLUTION
        assert width == pytest.approx(wanted, rel=0.02)


@pytest.mark.skipif(RESULTS == ROOT / "results", reason="half a minute; the pages of the reduced config show as much")
@pytest.mark.parametrize("name", ENTRIES)
def test_pages_equal_the_pages_of_another_process(name, tmp_path):
    (tmp_path / "page.pdf").write_bytes(style.encode(draw_again(name))["pdf"])
    assert (tmp_path / "page.pdf").read_bytes() == (FIGURES / f"{name}.pdf").read_bytes()
