"""The article: its text in Markdown, which pandoc converts to Typst, and the PDF, which Typst typesets."""

import os
import tempfile
from pathlib import Path
from typing import Any

import pypandoc
import typst

from conveyor_pipeline.pages import pages

# Shifts headings, because the first heading of the text is the title.
OPTIONS = ("--standalone", "--shift-heading-level-by=-1", "--wrap=preserve")


def typeset(text: str, frame: str) -> bytes:
    """The PDF of a text in Markdown; `frame` is a pandoc template for Typst.

    Paths of figures begin with a slash, which stands for the current folder. The same text and figures give equal
    bytes, because only the fonts of Typst are used, no date, and no pandoc or pandoc settings of the user.
    """
    # Otherwise pypandoc would prefer a newer pandoc on the user's path.
    os.environ["PYPANDOC_PANDOC"] = str(Path(pypandoc.__file__).parent / "files/pandoc")
    with tempfile.TemporaryDirectory(dir=".") as folder:
        template = Path(folder, "frame.typ")
        template.write_text(frame, encoding="utf-8")
        options = [*OPTIONS, f"--template={template}", f"--data-dir={folder}"]
        source = pypandoc.convert_text(text, "typst", "markdown", extra_args=options)
        page = Path(folder, "article.typ")
        page.write_text(source, encoding="utf-8")
        return typst.compile(page, root=".", ignore_system_fonts=True, timestamp=0)


def make(frame: str, **arguments: Any) -> dict[str, str | bytes]:
    """The text of the article, for which `arguments` are those of pages.make, and its PDF."""
    (text,) = pages.make(**arguments)
    return {"text": text, "pdf": typeset(text, frame)}
