"""Titles of figures, imported by the Snakefile: no slow imports."""

from pathlib import Path

PLOTS = Path(__file__).parent / "plots"


def split_title(text: str) -> tuple[str, str]:
    """The title and the caption in the text of a file plots/NAME.rst: the title is its first paragraph."""
    title, _, caption = text.partition("\n\n")
    return title, caption


def title_of(figure: str) -> str:
    """The title of a figure."""
    return split_title((PLOTS / f"{figure}.rst").read_text(encoding="utf-8"))[0]
