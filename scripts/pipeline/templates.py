"""Fill the fields of a template: Markdown, YAML or reStructuredText with the syntax of Jinja."""

from collections.abc import Mapping
from typing import Any

from jinja2 import Environment, StrictUndefined


def fill(template: str, values: Mapping[str, Any]) -> str:
    """A page from its template; jinja2.UndefinedError names a field that has no value."""
    return Environment(undefined=StrictUndefined, keep_trailing_newline=True).from_string(template).render(values)
