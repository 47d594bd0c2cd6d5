"""The page on scoring another solver on the open benchmark."""

import json

from accuracy.scores import error_bar
from pipeline.templates import render


def scene_row(scene: dict) -> list[str]:
    """The cells of a scene: name, amplitude, initial height, duration, impacts, events, error bar."""
    name = scene["scene"]
    impacts = sum(event["kind"] == "impact" for event in scene["events"])
    return [
        f'<a href="benchmark/{name}.json">{name}</a>',  # HTML: Sphinx does not resolve Markdown links to JSON files
        f"{scene['parameters']['acceleration']['value']:g}",
        f"{1e3 * scene['initial']['z']:g}",
        f"{scene['duration']:g}",
        str(impacts),
        str(len(scene["events"])),
        f"{error_bar(scene):.0e}",
    ]


def make(template: str, scenes: list[str], example: str) -> str:
    """The page from its template, the files of the scenes, and the source of the example."""
    read = [json.loads(text) for text in scenes]
    return render(
        template, {"scenes": [scene_row(scene) for scene in read], "times": len(read[0]["times"]), "example": example}
    )
