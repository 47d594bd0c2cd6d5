"""Errors of the config as lines that name the key, the fault and the remedy."""

import difflib
import math
from collections.abc import Iterable
from reprlib import Repr
from textwrap import shorten
from typing import Any

from pydantic import ValidationError

from .model import MODEL
from .schema import options_of, schema_at, unit_of

MOST_LINES = 6  # of a message: ten with the four lines that Snakemake adds
SHORT = Repr()
SHORT.maxstring = SHORT.maxother = 60
format_value = SHORT.repr


class ConfigError(Exception):
    """A config that cannot be used; the message has at most six lines."""

    def __init__(self, lines: list[str]):
        if len(lines) < MOST_LINES:
            super().__init__("\n".join(["The config cannot be used:", *lines]))
            return
        first, more = lines[: MOST_LINES - 1], len(lines) - MOST_LINES + 1
        super().__init__("\n".join([f"The config cannot be used; the first {len(first)} errors, {more} more:", *first]))


def suggest_name(name: Any, known: Iterable[str]) -> str:
    """The remedy for an unknown name."""
    close = difflib.get_close_matches(str(name)[:100], known, n=1)
    return f"did you mean {close[0]}?" if close else f"there are {shorten(', '.join(known) or 'none', 300)}"


def format_key(path: Iterable[str | int]) -> str:
    """ "sweeps.mine.axes.z0[1]" for the path of a value."""
    names = (part if len(str(part)) <= 64 and str(part).isprintable() else format_value(part) for part in path)
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in names).lstrip(".") or "config"


def path_of(location: tuple) -> list[str | int]:
    """The path of a value, without the marks of alternatives in the location of an error of pydantic."""
    return [part for part in location if str(part)[:1] != "("]


def reads_as_number(value: Any) -> bool:
    try:
        return isinstance(value, str) and float(value) is not None
    except ValueError:
        return False


def explain(error: dict) -> str:
    """One line for an error of pydantic."""
    *above, name = path_of(error["loc"]) or [""]
    key, value = format_key([*above, name]), format_value(error["input"])
    if error["type"] == "invalid_key" or (name == "[key]" and error["type"] == "string_type"):
        section = format_key(above if error["type"] == "invalid_key" else above[:-1])
        return f"{section} has a key that YAML reads as {value}, not as text; use another name, in quotes"
    if name == "[key]":
        names = schema_at(above[:-1])["propertyNames"]
        known, expected = names.get("enum"), names.get("patternErrorMessage")
        remedy = suggest_name(error["input"], known) if known else f"give {expected}"
        return f"{format_key(above[:-1])} has the unknown name {value}; {remedy}"
    schema = schema_at([*above, name])
    match error["type"]:
        case "extra_forbidden":
            known = [name for option in options_of(schema_at(above)) for name in option.get("properties", {})]
            return f"{key} is an unknown key; {suggest_name(name, known)}"
        case "value_error":
            return f"{key} = {value} {error['ctx']['error']}"
        case "string_pattern_mismatch":
            return f"{key} = {value} should be {schema['patternErrorMessage']}"
        case "float_type" | "int_type" | "height" if reads_as_number(error["input"]):
            return f"{key} = {value} is text to YAML; write it with a decimal point and a signed exponent (1.0e-4)"
        case "greater_than" | "greater_than_equal" | "less_than" | "less_than_equal":
            return f"{key} = {value} is outside {describe_range(schema, error['input'])}"
    # "Input should be …", "List should have …"
    message = error["msg"].partition(" ")[2].replace(" after validation", "").replace("dictionary", "mapping")
    return f"{key} = {value} {message} {unit_of(schema) and f'({unit_of(schema)})'}".rstrip()


def describe_range(schema: dict, value: float) -> str:
    """The range of a number with its unit, and the remedy for an angle in degrees."""
    schema, unit = next(option for option in options_of(schema) if option.get("type") != "string"), unit_of(schema)
    low, high = (schema.get(end, schema.get(f"exclusive{end.capitalize()}")) for end in ("minimum", "maximum"))
    ends = "[" if "minimum" in schema else "(", "]" if "maximum" in schema else ")"
    is_degrees = unit == "rad" and high < abs(value) <= 360
    remedy = f"; angles are in radians, {value:g}° are {math.radians(value):.4f} rad" if is_degrees else ""
    return f"{ends[0]}{low:g}, {high:g}{ends[1]} {unit}".rstrip() + remedy


def type_problems(config: Any) -> list[str]:
    """Errors of the types of a config, one line each."""
    try:
        MODEL.validate_python(config)
    except ValidationError as invalid:
        errors = invalid.errors(include_url=False)
        missing = {}
        for error in errors:
            if error["type"] == "missing":
                missing.setdefault(format_key(path_of(error["loc"][:-1])), []).append(str(error["loc"][-1]))
        lines = [f"{key} lacks {', '.join(names)}" for key, names in missing.items()]
        return lines + [explain(error) for error in errors if error["type"] != "missing"]
    return []
