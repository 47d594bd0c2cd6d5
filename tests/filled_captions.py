"""Captions from their own templates and made-up tables."""

import pandas as pd

from conveyor_pipeline.figures import captions
from conveyor_pipeline.figures.titles import caption_file


def template_of(name: str) -> str:
    """The text of the file with title and caption of a figure."""
    return caption_file(name).read_text(encoding="utf-8")


def caption(name: str, settings: dict | None = None, *, paper: bool = True, **tables: pd.DataFrame) -> str:
    """The caption of a figure from its own template, on one line."""
    return " ".join(captions.make(name, settings or {}, paper, template_of(name), **tables).split())
