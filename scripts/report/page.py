"""What all pages of the report share: templates of this folder, filled in."""

import math
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, select_autoescape

FOLDER = Path(__file__).parent


def written(value: float | None) -> str:
    """A number of the table of claims, as docs/claims.md has it."""
    return "–" if value is None or math.isnan(value) else f"{value:.4g}"


def render(template: str, **values) -> str:
    """A template of this folder, filled in."""
    environment = Environment(
        loader=FileSystemLoader(FOLDER), autoescape=select_autoescape(), undefined=StrictUndefined, trim_blocks=True
    )
    environment.filters["number"] = written
    return environment.get_template(template).render(values)
