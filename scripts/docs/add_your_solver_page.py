"""The page on scoring another solver on the open benchmark."""

import json

from accuracy.scores import error_bar
from pipeline.templates import render


def make(template: str, scenes: list[str], example: str) -> str:
    """The page from its template, the files of the scenes, and the source of the example."""
    return render(template, {"scenes": [*map(json.loads, scenes)], "error_bar": error_bar, "example": example})
