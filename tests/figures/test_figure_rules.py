"""The table of figures: one entry for each target, plot script, caption and line of the README."""

import json
import re

from project import FIGURES, ROOT, read_config

ENTRIES = read_config()["figures"]


def stems(folder, pattern):
    return {path.stem for path in (ROOT / folder).glob(pattern)}


def test_every_figure_has_script_and_caption():
    assert stems("scripts/figures/plots", "*.py") - {"__init__"} == set(ENTRIES)
    assert stems("workflow/report", "*.rst") - {"workflow", "claims", "provenance"} == set(ENTRIES)


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
    assert "results/provenance.json" in report
    for figure in FIGURES:
        assert f"figures/{figure}.png" in report
        assert json.dumps(ENTRIES[figure]["title"]) in report
        caption = (built.folder / f"results/captions/{figure}.rst").read_text()
        assert json.dumps("<p>" + caption[:40]).strip('"') in report
