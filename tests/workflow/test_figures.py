"""The table of figures: one entry for each target, plot script, caption and line of the README; how they are saved."""

import json
import re

import matplotlib.pyplot as plt
import pytest

from plot_figure import draw
from plots import style
from project import FIGURES, ROOT, read_config

ENTRIES = read_config()["figures"]


def drawn(built, figure):
    """The figure of the built project, drawn from its tables once more."""
    paths = {
        role: built.folder / f"results/{reference}.parquet" for role, reference in ENTRIES[figure]["tables"].items()
    }
    return draw(figure, paths, ENTRIES[figure].get("settings", {}))


def stems(folder, pattern):
    return {path.stem for path in (ROOT / folder).glob(pattern)}


def test_every_figure_has_script_and_caption():
    assert stems("scripts/plots", "*.py") - {"style", "__init__"} == set(ENTRIES)
    assert stems("workflow/report", "*.rst") - {"workflow", "claims"} == set(ENTRIES)


def test_readme_lists_every_figure():
    readme = (ROOT / "README.md").read_text()
    rows = re.findall(r"^\| `figures/(\w+)\.pdf` \| ([^|]+) \| ([^|]+) \|", readme, re.MULTILINE)
    assert rows == [(figure, entry["title"], entry["section"]) for figure, entry in ENTRIES.items()]


def test_every_figure_of_the_config_is_a_target(built):
    for ending in ("pdf", "png"):
        assert {path.stem for path in (built.folder / "figures").glob(f"*.{ending}")} == set(FIGURES)


def test_report_shows_every_figure_with_its_caption(built):
    run = built.snakemake("--report", "report.html")
    assert run.returncode == 0, run.stdout
    report = (built.folder / "report.html").read_text()
    for figure in FIGURES:
        assert f"figures/{figure}.png" in report
        assert json.dumps(ENTRIES[figure]["title"]) in report
        caption = (ROOT / f"workflow/report/{figure}.rst").read_text()
        assert json.dumps("<p>" + caption[:40]).strip('"') in report


@pytest.mark.parametrize("figure", FIGURES)
def test_equal_bytes_from_equal_tables(built, tmp_path, figure):
    copies = [tmp_path / f"{figure}.pdf", tmp_path / f"{figure}.png"]
    style.save(drawn(built, figure), map(str, copies))
    for copy in copies:
        assert copy.read_bytes() == (built.folder / "figures" / copy.name).read_bytes()


@pytest.mark.parametrize("figure", FIGURES)
def test_fonts_are_embedded_as_truetype(built, figure):
    content = (built.folder / f"figures/{figure}.pdf").read_bytes()
    assert b"/FontFile2" in content
    assert b"/Type3" not in content


@pytest.mark.parametrize("figure", FIGURES)
def test_figures_fit_the_journal(built, figure):
    picture = drawn(built, figure)
    assert round(picture.get_figwidth() / style.MM, 6) in (style.COLUMN, style.PAGE)
    picture.draw_without_rendering()
    sizes = [text.get_fontsize() for text in picture.findobj(plt.Text) if text.get_text() and text.get_visible()]
    assert min(sizes) >= 7.0
