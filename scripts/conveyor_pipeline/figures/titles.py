"""Files and titles of figures, imported by the Snakefile: no slow imports."""

from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]


def package_of(figure: str, part: str = "figures") -> str | None:
    """The package that has a module of a figure: its plot, or the numbers of its caption (part `caption_numbers`)."""
    file = next(PACKAGE.glob(f"*/{part}/{figure}.py"), None)
    return file and f"{PACKAGE.name}.{file.parent.parent.name}.{part}"


def caption_file(figure: str) -> Path | None:
    """The file with title and caption of a figure, beside its plot."""
    return next(PACKAGE.glob(f"*/figures/{figure}.rst"), None)


def split_title(text: str) -> tuple[str, str]:
    """The title and the caption in the text of a file NAME.rst: the title is its first paragraph."""
    title, _, caption = text.partition("\n\n")
    return title, caption


def title_of(figure: str) -> str:
    """The title of a figure."""
    return split_title(caption_file(figure).read_text(encoding="utf-8"))[0]
