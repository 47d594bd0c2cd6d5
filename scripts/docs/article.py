"""The article as a PDF: pandoc converts its text to Typst, and Typst typesets it."""

import tempfile
from pathlib import Path

import pypandoc
import typst

# Shifts headings, because the first heading of the text is the title.
OPTIONS = ("--standalone", "--shift-heading-level-by=-1", "--wrap=preserve")


def make(text: str, frame: str) -> bytes:
    """The PDF of a text in Markdown; `frame` is a pandoc template for Typst.

    Paths of figures begin with a slash, which stands for the current folder. The same text and figures give equal
    bytes, because only the fonts of Typst are used, and no date.
    """
    with tempfile.TemporaryDirectory(dir=".") as folder:
        template = Path(folder, "frame.typ")
        template.write_text(frame, encoding="utf-8")
        source = pypandoc.convert_text(text, "typst", "markdown", extra_args=[*OPTIONS, f"--template={template}"])
        page = Path(folder, "article.typ")
        page.write_text(source, encoding="utf-8")
        return typst.compile(page, root=".", ignore_system_fonts=True, timestamp=0)
