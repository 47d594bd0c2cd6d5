"""The table of figures: one entry for each target, plot script and caption."""

from project import FIGURES, ROOT, read_config

CONFIG = read_config()
ENTRIES = CONFIG["figures"] | CONFIG["figures_on_request"]


def stems(folder, pattern):
    return {path.stem for path in (ROOT / folder).glob(pattern)}


def test_every_figure_has_script_and_caption():
    assert stems("scripts/figures/plots", "*.py") - {"__init__"} == set(ENTRIES)
    assert stems("scripts/figures/plots", "*.rst") == set(ENTRIES)
    assert stems("scripts/figures/caption_numbers", "*.py") - {"__init__"} <= set(ENTRIES)


def test_every_figure_of_the_config_is_a_target(built):
    for ending in ("pdf", "png"):
        assert {path.stem for path in (built.folder / "figures").glob(f"*.{ending}")} == set(FIGURES)
