"""Pages from Jinja templates and data."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from jinja2 import Environment, StrictUndefined


def format_significant(value: float, digits: int = 3) -> str:
    """A number to some significant digits, without an exponent: "0.0648", "1240"."""
    return np.format_float_positional(float(f"{value:.{digits - 1}e}"), trim="-")


def format_range(ends: tuple[float, float], factor: float = 1.0) -> str:
    """ "0.0648 to 0.141", or one number if both are equal to three digits; "not known" for NaN."""
    if math.isnan(ends[0]):
        return "not known"
    low, high = (format_significant(factor * end) for end in ends)
    return low if low == high else f"{low} to {high}"


FILTERS = {"degrees": math.degrees, "significant": format_significant, "range": format_range}
ENVIRONMENT = Environment(undefined=StrictUndefined, keep_trailing_newline=True)
ENVIRONMENT.filters |= FILTERS


def render(template: str, values: Mapping[str, Any]) -> str:
    """The page that a template gives with some values.

    Raises
    ------
    jinja2.UndefinedError
        names a value that the template uses and `values` does not have
    """
    return ENVIRONMENT.from_string(template).render(values)
