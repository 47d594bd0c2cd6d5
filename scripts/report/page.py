"""Pages of the report from the templates of this folder."""

from pathlib import Path

from jinja2 import FileSystemLoader, select_autoescape

from pipeline.templates import ENVIRONMENT

FOLDER = Path(__file__).parent


def render(template: str, **values) -> str:
    """The page from a template of this folder; a missing value is an error."""
    environment = ENVIRONMENT.overlay(
        loader=FileSystemLoader(FOLDER), autoescape=select_autoescape(), trim_blocks=True, keep_trailing_newline=False
    )
    return environment.get_template(template).render(values)
