"""Pages of the report from the templates of this folder."""

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, select_autoescape

from claims.finding import format_number

FOLDER = Path(__file__).parent


def render(template: str, **values) -> str:
    """The page from a template of this folder; a missing value is an error."""
    environment = Environment(
        loader=FileSystemLoader(FOLDER), autoescape=select_autoescape(), undefined=StrictUndefined, trim_blocks=True
    )
    environment.filters["number"] = format_number
    return environment.get_template(template).render(values)
