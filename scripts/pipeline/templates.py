"""Pages from Jinja templates and data."""

from collections.abc import Mapping
from typing import Any

from jinja2 import Environment, StrictUndefined

ENVIRONMENT = Environment(undefined=StrictUndefined, keep_trailing_newline=True)


def render(template: str, values: Mapping[str, Any]) -> str:
    """The page that a template gives with some values.

    Raises
    ------
    jinja2.UndefinedError
        names a value that the template uses and `values` does not have
    """
    return ENVIRONMENT.from_string(template).render(values)
