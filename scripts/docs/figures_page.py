"""The page on the cost of each figure."""

import json

from pipeline.templates import render


def make(template: str, costs: str) -> str:
    """The page from its template and the costs of figures and claims as JSON."""
    return render(template, json.loads(costs))
