"""The config: checked with errors that name the key and the remedy, brought to one form, resolved to tables.

What it may hold stands in config_model, what its parts must agree on in config_checks.
"""

import re
from typing import Annotated, NotRequired, get_args, get_origin, get_type_hints

from pydantic import Tag, ValidationError
from pydantic_core import ErrorDetails
from typing_extensions import is_typeddict

from workflow.config_checks import contradictions
from workflow.config_model import MODEL, Config
from workflow.config_types import did_you_mean, shown
from workflow.tables_of_config import (
    METHODS,
    TABLES,
    by_methods,
    count_points,
    count_values,
    entry_of,
    kind_of,
    resolve,
    roles_of_solution,
    tighter_reference,
    with_tighter,
)

__all__ = [
    "TABLES",
    "by_methods",
    "canonical",
    "count_points",
    "count_values",
    "entry_of",
    "kind_of",
    "problems",
    "resolve",
    "roles_of_solution",
    "tighter_reference",
    "type_problems",
    "with_tighter",
]

# What YAML calls the types of Python.
KINDS = {
    "dict_type": "a mapping of keys to values",
    "list_type": "a list",
    "string_type": "text",
    "none_required": "null",
}


def key_of(path) -> str:
    """ "sweeps.mine.axes.z0[1]" of the path of an error; the marks of an axis's kinds are left out."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{shown_key(part)}" for part in path if str(part)[:1] != "‹")
    return "".join(parts).lstrip(".") or "config"


def shown_key(part: str) -> str:
    """A key as it is written, or cut and brought to one line."""
    return part if len(part) <= 64 and part.isprintable() else shown(part)


def type_at(path) -> type:
    """The type of the model at the path of an error."""
    kind = Config
    for part in path:
        options = [option for option in get_args(kind) if Tag(part) in getattr(option, "__metadata__", ())]
        if options:
            kind = options[0]
        elif is_typeddict(kind):
            kind = get_type_hints(kind, include_extras=True)[part]
        else:
            kind = get_args(kind)[-1]
        while get_origin(kind) in (Annotated, NotRequired):
            kind = get_args(kind)[0]
    return kind


def explain(error: ErrorDetails) -> str:
    """One line for one error of the types: the key, what is wrong with it, and what would be right."""
    # The config itself has no key.
    *above, name = error["loc"] or [""]
    value = error["input"]
    match error["type"]:
        case "extra_forbidden":
            return f"{key_of(error['loc'])} is an unknown key; {did_you_mean(name, type_at(above).__annotations__)}"
        case "invalid_key":
            return (
                f"{key_of(above)} has a key that YAML reads as {shown(value)}, not as text; use another name, in quotes"
            )
        case "too_short" if error["ctx"]["actual_length"] == 0:
            return f"{key_of(error['loc'])} is empty; give at least one value"
        case "too_short" | "too_long":
            wanted = error["ctx"].get("min_length", error["ctx"].get("max_length"))
            return f"{key_of(error['loc'])} = {shown(value)} has {len(value)} values; give {wanted}"
        case kind if kind in KINDS:
            return f"{key_of(error['loc'])} = {shown(value)} is not {KINDS[kind]}"
    path = above[:-1] if name == "[key]" else error["loc"]
    return f"{key_of(path)} {error['msg']}"


def lacking(errors: list[ErrorDetails]) -> list[str]:
    """One line for each mapping that lacks keys."""
    missing = {}
    for error in errors:
        if error["type"] == "missing":
            *above, name = error["loc"]
            missing.setdefault(key_of(above), []).append(name)
    return [f"{key} lacks {', '.join(names)}" for key, names in missing.items()]


def type_problems(config: dict) -> list[str]:
    """Errors of the types of a config, one line each."""
    try:
        MODEL.validate_python(config)
    except ValidationError as invalid:
        errors = invalid.errors(include_url=False)
        return lacking(errors) + [explain(error) for error in errors if error["type"] != "missing"]
    return []


def problems(config: dict) -> list[str]:
    """All errors of a config, one line each; empty if there are none."""
    if errors := type_problems(config):
        return errors
    typed = MODEL.validate_python(config)
    written = {
        f"{section}.{name}_{method}": f"{section}.{name}"
        for section in METHODS
        for name, entry in typed[section].items()
        for method in entry.get("methods", [])[1:]
    }
    lines = contradictions(by_methods(typed))
    # Of entries that list their methods the key is told that stands in the file.
    for made, key in written.items():
        lines = [re.sub(rf"(?<![\w.]){re.escape(made)}(?=\.)", key, line) for line in lines]
    return list(dict.fromkeys(lines))


def canonical(config: dict) -> dict:
    """A config without problems in its one form: keys in the order of the model, numbers in its types.

    The entries of a section and the axes of an entry keep their order, which means something.
    """
    return MODEL.validate_python(config)
