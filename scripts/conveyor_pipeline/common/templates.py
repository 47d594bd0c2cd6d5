"""Pages from Jinja templates and data: Python hands over tables and plain numbers, and the templates format them.

A number without a format has up to six digits. A missing value is an error.
"""

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from jinja2 import Environment, StrictUndefined


def format_number(value: float | None, digits: int = 4) -> str:
    """A number in up to so many digits; a dash for None or NaN."""
    return "–" if value is None or math.isnan(value) else f"{value:.{digits}g}"


def format_plain(value: float, digits: int = 6) -> str:
    """A number in up to so many digits, without leading zeros in the exponent: "3e-10"."""
    return f"{value:.{digits}g}".replace("e-0", "e-").replace("e+0", "e")


def format_field(value: Any) -> Any:
    """The value of a field without a format."""
    return format_plain(value) if isinstance(value, float) else value


def format_significant(value: float, digits: int = 3) -> str:
    """A number to some significant digits, without an exponent: "0.0648", "1240"."""
    return np.format_float_positional(float(f"{value:.{digits - 1}e}"), trim="-")


def format_range(ends: tuple[float, float], factor: float = 1.0) -> str:
    """ "0.0648 to 0.141", or one number if both are equal to three digits; "not known" for NaN."""
    if math.isnan(ends[0]):
        return "not known"
    low, high = (format_significant(factor * end) for end in ends)
    return low if low == high else f"{low} to {high}"


def round_up(value: float) -> str:
    """A number rounded up to two digits, "1.3e-9"."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return format_plain(math.ceil(value / unit) * unit, 2)


def format_count(count: int, noun: str) -> str:
    """A number with its noun: "1 design", "1,200 designs"."""
    return f"{count:,} {noun}{'s' if count != 1 else ''}"


def join_list(values: Iterable) -> str:
    """Texts or numbers as a list in a sentence, "a, b and c"."""
    texts = [str(format_field(value)) for value in values]
    return " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]]))


def name_harmonics(model: Mapping[str, Any]) -> str:
    """ "harmonics of the orders 2 and 3" of a model's plate; empty without harmonics."""
    orders = [harmonic["order"] for harmonic in model.get("harmonics", ())]
    if not orders:
        return ""
    return f"harmonics of the orders {join_list(orders)}" if len(orders) > 1 else f"a harmonic of the order {orders[0]}"


ENVIRONMENT = Environment(undefined=StrictUndefined, keep_trailing_newline=True, finalize=format_field)
ENVIRONMENT.filters |= {
    "number": format_number,
    "plain": format_plain,
    "degrees": math.degrees,
    "significant": format_significant,
    "range": format_range,
    "round_up": round_up,
    "counted": format_count,
    "thousands": "{:,}".format,
    "listed": join_list,
    "harmonics": name_harmonics,
}


def render(template: str, values: Mapping[str, Any]) -> str:
    """The page that a template gives with some values.

    Raises
    ------
    jinja2.UndefinedError
        names a value that the template uses and `values` does not have
    """
    return ENVIRONMENT.from_string(template).render(values)
