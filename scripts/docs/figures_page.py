"""The page of what each figure costs."""

import json

from pipeline.templates import render


def make(template: str, costs: str) -> str:
    """The page from its template and the costs of figures and claims as JSON."""
    return render(template, json.loads(costs))
