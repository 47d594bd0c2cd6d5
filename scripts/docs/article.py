"""The article as a PDF: pandoc makes Typst of its text, and Typst a page."""

import tempfile
from pathlib import Path

import pypandoc
import typst

# Headings of the text: the first one is the title.
OPTIONS = ("--standalone", "--shift-heading-level-by=-1", "--wrap=preserve")


def make(text: str, frame: str) -> bytes:
    """The PDF of a text in Markdown within a frame, a template of pandoc for Typst.

    Figures are named by their paths below the folder in which this runs, from a slash on. The same text, fonts and
    figures give equal bytes: Typst's own fonts are used, and no date.
    """
    with tempfile.TemporaryDirectory(dir=".") as folder:
        template = Path(folder, "frame.typ")
        template.write_text(frame, encoding="utf-8")
        source = pypandoc.convert_text(text, "typst", "markdown", extra_args=[*OPTIONS, f"--template={template}"])
        page = Path(folder, "article.typ")
        page.write_text(source, encoding="utf-8")
        return typst.compile(page, root=".", ignore_system_fonts=True, timestamp=0)
