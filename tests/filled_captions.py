"""Captions from their own templates and made-up tables."""

import pandas as pd

from conveyor_pipeline.figures import captions
from conveyor_pipeline.figures.titles import caption_file, split_title


def template_of(name: str) -> str:
    """The template of a caption, without the title."""
    return split_title(caption_file(name).read_text(encoding="utf-8"))[1]


def caption(name: str, settings: dict | None = None, *, paper: bool = True, **tables: pd.DataFrame) -> str:
    """The caption of a figure from its own template, on one line."""
    template = template_of(name)
    return " ".join(captions.caption(template, name, tables, settings or {}, paper).split())
