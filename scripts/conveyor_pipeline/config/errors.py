"""Errors of the config as lines that name the key, the fault and the remedy."""

import difflib
import math
import re
from collections.abc import Iterable
from reprlib import Repr
from textwrap import shorten
from typing import Any

from pydantic import TypeAdapter, ValidationError

from conveyor_pipeline.common.quantities import KEYS, in_unit, length_in
from conveyor_pipeline.common.settings import MODEL_TYPES, is_number
from conveyor_pipeline.config.entries import ENTRIES
from conveyor_pipeline.config.model import MODEL
from conveyor_pipeline.config.schema import options_of, schema_at, unit_of

# Errors with a remedy: searching similar names for thousands of errors would take seconds.
MOST_EXPLAINED = 200
MOST_LINES = 6  # of a message: ten with the four lines that Snakemake adds
SHORT = Repr()
SHORT.maxstring = SHORT.maxother = 60
format_value = SHORT.repr
BOUNDS = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}


class ConfigError(Exception):
    """A config that cannot be used; the message has at most six lines."""

    def __init__(self, lines: list[str]):
        head = "The config cannot be used"
        if (remaining := len(lines) - MOST_LINES + 1) > 0:
            lines = lines[: MOST_LINES - 1]
            head += f"; the first {len(lines)} errors, {remaining} more"
        super().__init__("\n".join([f"{head}:", *lines]))


def suggest_name(name: Any, known: Iterable[str]) -> str:
    """The remedy for an unknown name."""
    close = difflib.get_close_matches(str(name)[:100], known, n=1)
    return f"did you mean {close[0]}?" if close else f"there are {shorten(', '.join(known) or 'none', 300)}"


def format_key(path: Iterable[str | int]) -> str:
    """ "sweeps.mine.axes.z0[1]" for the path of a value."""
    names = (part if len(str(part)) <= 64 and str(part).isprintable() else format_value(part) for part in path)
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in names).lstrip(".") or "config"


def given_at(config: Any, path: Iterable[str | int], validated: Any) -> Any:
    """The value of a config at a path as the user gives it; a text with a unit is `validated` as a number."""
    try:
        for part in path:
            config = config[part]
    except (KeyError, IndexError, TypeError):
        return validated
    return config if isinstance(config, str) else validated


def acceleration_of(text: str, config: Any) -> str:
    """The remedy for an amplitude that is given as a length: the accelerations of both readings; else empty."""
    length = length_in(text)
    try:
        frequency = TypeAdapter(MODEL_TYPES["frequency"]).validate_python(config["model"]["frequency"])
    except (KeyError, TypeError, ValidationError):
        return ""
    if length is None:
        return ""
    peak = (2.0 * math.pi * frequency) ** 2 * in_unit(length, "m")
    return (
        f"; at model.frequency = {frequency:g} Hz, {length} zero to peak are {peak:.4g} m/s², and "
        f"{length} peak to peak are {0.5 * peak:.4g} m/s²"
    )


def explain(error: dict, config: Any) -> str:
    """One line for an error of pydantic in a config."""
    # Without the names of forms ("(span)"), and without "[key]" behind a name of the user's choice.
    path = [part for part in error["loc"] if str(part)[:1] != "(" and part != "[key]"]
    kind = error["type"]
    is_name = error["loc"][-1:] == ("[key]",)
    value = error["input"] if is_name else given_at(config, path, error["input"])
    key, above, schema = format_key(path), format_key(path[:-1]), schema_at(path)
    shown = f"{key} = {format_value(value)}"
    if kind == "invalid_key" or (is_name and not isinstance(value, str)):
        # {frequency: 50,0} has the key 0.
        has_comma = type(value) is int and any("properties" in option for option in options_of(schema_at(path[:-1])))
        remedy = "write decimal points, not commas" if has_comma else "put it in quotes"
        return f"{above} has the key {value!r}, which is not text; {remedy}"
    if is_name:
        names = schema_at(path[:-1])["propertyNames"]
        remedy = suggest_name(value, names["enum"]) if "enum" in names else f"give {names['patternErrorMessage']}"
        return f"{above} has the unknown name {format_value(value)}; {remedy}"
    if kind == "missing":
        unit = f" in {unit_of(schema)}" if unit_of(schema) in KEYS else ""
        return f"{key} is missing; give it{unit} ({schema['description'].partition(';')[0]})"
    if kind == "extra_forbidden":
        # {frequency: 50,5 Hz} has the key "5 Hz".
        if value is None and re.match(r"\d", str(path[-1])):
            return f"{above} has the key {path[-1]!r}; write decimal points, not commas"
        known = [name for option in options_of(schema_at(path[:-1])) for name in option.get("properties", {})]
        return f"{key} is an unknown key; {suggest_name(path[-1], known)}"
    if kind == "value_error":
        return f"{shown} {error['ctx']['error']}"
    if kind == "string_pattern_mismatch":
        (expected,) = {form["patternErrorMessage"] for form in options_of(schema) if "patternErrorMessage" in form}
        return f"{shown} should be {expected}"
    if kind == "dict_type" and path:
        return (
            f"{key} is empty; give keys below it, or delete it"
            if value is None
            else f"{shown} should have keys below it"
        )
    if kind == "string_type" and isinstance(value, int | float):
        return f"{shown} is a number, not text; put it in quotes"
    # "Input should be …", "List should have …"
    unit = unit_of(schema)
    fault = error["msg"].partition(" ")[2]
    for name, bound in error.get("ctx", {}).items():
        fault = f"should be {BOUNDS[name]} {bound:g}" if name in BOUNDS else fault
    if kind.endswith("_parsing"):
        fault = fault.partition(",")[0]  # without "unable to parse string as a number"
    fault = fault.replace(" after validation", "").replace("dictionary", "mapping")
    remedy = ""
    has_unit = isinstance(value, str) and not is_number(value)
    if kind == "less_than_equal" and unit == "rad" and not has_unit and (degrees := float(value)) <= 360:
        remedy = f"; angles are in radians, {degrees:g}° are {math.radians(degrees):.4f} rad: write {degrees:g} deg"
    if kind in ("less_than", "less_than_equal") and unit == "m" and not has_unit and float(value) < 1000:
        remedy = f"; if it is in millimetres, write {float(value):g} mm"
    is_share = unit.startswith("of ") and kind in ("less_than", "less_than_equal") and not has_unit
    if is_share and 1 < (percent := float(value)) < 100:
        remedy = f"; this is a share: write {percent:g} % or {percent / 100:g}"
    # Entries may have frequencies of their own.
    if has_unit and kind == "quantity" and unit == "m/s²" and path[0] not in ENTRIES:
        remedy = acceleration_of(value, config)
    if has_unit and BOUNDS.keys() & error.get("ctx", {}).keys() and unit in KEYS:
        remedy = f", and is {error['input']:.4g}; give {KEYS[unit]}"
    names_unit = unit not in ("", "1") and kind != "quantity"
    return f"{shown} {fault}{f' ({unit})' if names_unit else ''}{remedy}"


def type_problems(config: Any) -> list[str]:
    """Errors of the types of a config, one line each."""
    try:
        MODEL.validate_python(config)
    except ValidationError as invalid:
        errors = invalid.errors(include_url=False)
        unexplained = [f"{format_key(error['loc'])}: {error['msg']}" for error in errors[MOST_EXPLAINED:]]
        return [explain(error, config) for error in errors[:MOST_EXPLAINED]] + unexplained
    return []
