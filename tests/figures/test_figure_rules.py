"""The table of figures: one entry for each target, plot script and caption."""

from project import FIGURES, ROOT, read_config

CONFIG = read_config()
# Modules of the package that draws all figures.
SHARED = {"captions", "settings", "style", "titles"}
ENTRIES = CONFIG["figures"] | CONFIG["figures_on_request"]


def stems(pattern):
    """The names of files in all floors."""
    return {path.stem for path in (ROOT / "scripts/conveyor_pipeline").glob(f"*/{pattern}")} - SHARED


def test_every_figure_has_script_and_caption():
    assert stems("figures/*.py") - {"__init__"} == set(ENTRIES)
    assert stems("figures/*.rst") == set(ENTRIES)
    assert stems("caption_numbers/*.py") - {"__init__"} <= set(ENTRIES)


def test_every_figure_of_the_config_is_a_target(built):
    for ending in ("pdf", "png"):
        assert {path.stem for path in (built.folder / "figures").glob(f"*.{ending}")} == set(FIGURES)
