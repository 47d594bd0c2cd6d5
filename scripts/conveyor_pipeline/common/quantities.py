"""Numbers of the config with a unit, such as `20 deg` or `0.3 mm`, in the unit of their key.

The package pint knows the units below only, so that each of them means one thing. Unlike in its own list, an angle is
no plain number, and a revolution per minute is a frequency. Imported by the Snakefile; pint is imported on first use.
"""

import re
from functools import cache
from typing import Any

DEFINITIONS = (
    "giga- = 1e9 = G-",
    "mega- = 1e6 = M-",
    "kilo- = 1e3 = k-",
    "centi- = 1e-2 = c-",
    "milli- = 1e-3 = m-",
    "micro- = 1e-6 = µ- = μ- = u-",
    "meter = [length] = m",
    "inch = 0.0254 meter = in",
    "second = [time] = s",
    "minute = 60 second = min",
    "gram = [mass] = g",
    "radian = [angle] = rad",
    "degree = 0.017453292519943295 radian = deg",
    "hertz = 1 / second = Hz",
    "rpm = hertz / 60",
    "newton = kilogram meter / second**2 = N",
    "newton_second = newton second = Ns",
    "pascal = newton / meter**2 = Pa",
    "percent = 0.01",
    "standard_gravity = 9.80665 meter / second**2",
)
# The units of keys, with examples for error messages. A share has one of the units "", "1" and "of …".
KEYS = {
    "m": "m, mm, µm or in",
    "s": "s, ms or min",
    "kg": "kg, g or mg",
    "rad": "rad or deg",
    "Hz": "Hz, kHz or rpm",
    "m/s": "m/s, mm/s or m/min",
    "m/s²": "m/s², mm/s² or g",
    "N s/m": "N s/m or N s/mm",
    "N/m^p": "N/m^1.5, with the exponent of the contact",
    "Pa": "Pa, MPa or GPa",
    "m²": "m² or mm²",
    "m²/s²": "m²/s²",
}
SHARES = "%, or no unit"
STIFFNESS = "N/m^p"
# The exponent is possessive (?+), so that 1e5, a text to YAML 1.1, is not 1 with the unit e5.
QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?+)\s*([^\d\s.,].*?)\s*")
# Other spellings: m/s2 for m/s², the signs °, % and ·.
SPELLINGS = ((r"(?<=[a-z])([23])\b", r"**\1"), ("°", " degree "), ("%", " percent "), ("·", " "))
DIGITS = 15  # of a converted number, so that 0.3 mm is 0.0003


class QuantityError(ValueError):
    """A text that is no quantity of the unit; the message follows the text."""


@cache
def registry() -> Any:
    from pint import UnitRegistry

    units = UnitRegistry(None)
    units.load_definitions(DEFINITIONS)
    return units


def is_quantity(text: str) -> bool:
    """Whether a text begins with a number and goes on."""
    return bool(QUANTITY.fullmatch(text))


def parse(text: str, unit: str) -> Any:
    """A text as pint's quantity; `unit` decides whether g is a gram or the standard acceleration of gravity."""
    number, unit_text = QUANTITY.fullmatch(text).groups()
    for pattern, spelling in SPELLINGS:
        unit_text = re.sub(pattern, spelling, unit_text)
    if unit == "m/s²":
        unit_text = re.sub(r"\b(m?)g\b", r"\1standard_gravity", unit_text)
    try:
        return registry().Quantity(float(number), registry().parse_units(unit_text))
    except Exception as error:  # pint raises errors of many kinds, also those of Python's tokenizer
        raise QuantityError(f"has an unknown unit; give {KEYS.get(unit, SHARES)}") from error


def in_unit(text: str, unit: str) -> float:
    """The number of a text with a unit, in the unit of its key; QuantityError for another dimension.

    A stiffness may have any exponent, see `exponent_of`.

    Examples
    --------
    >>> in_unit("20 deg", "rad"), in_unit("4 g", "m/s²"), in_unit("0.8 g", "kg"), in_unit("85 %", "1")
    (0.3490658503988659, 39.2266, 0.0008, 0.85)
    """
    if not is_quantity(text):
        comma = "; write decimal points, not commas" if re.match(r"\s*[-+]?\d+,\d", text) else ""
        raise QuantityError(f"should be a number, or one with a unit: {KEYS.get(unit, SHARES)}{comma}")
    quantity = parse(text, unit)
    key = unit if unit in KEYS else ""
    if unit == STIFFNESS:
        key = f"N/m**{exponent_of(text) or 1.0!r}"
    if not quantity.is_compatible_with(registry().parse_units(key)):
        raise QuantityError(f"has a unit of another dimension; give {KEYS.get(unit, SHARES)}")
    magnitude = quantity.to(key).magnitude
    # A right angle with fewer digits would be more than a right angle.
    return float(magnitude) if unit == "rad" else float(f"{magnitude:.{DIGITS}g}")


def length_in(text: str) -> str | None:
    """The length at the beginning of a text, such as "0.5 mm" in "0.5 mm peak to peak", or None."""
    match = QUANTITY.fullmatch(text)
    length = f"{match[1]} {match[2].split()[0]}" if match else ""
    try:
        in_unit(length, "m")
    except QuantityError:
        return None
    return length


def exponent_of(text: str) -> float | None:
    """The exponent p of a stiffness in N/m^p, or None for any other quantity.

    Examples
    --------
    >>> exponent_of("5e5 N/m^1.5"), exponent_of("800 N/mm"), exponent_of("0.3 mm")
    (1.5, 1.0, None)
    """
    dimensions = dict(parse(text, STIFFNESS).dimensionality)
    exponent = 1.0 - dimensions.pop("[length]", 0.0)
    return exponent if dimensions == {"[mass]": 1.0, "[time]": -2.0} else None
