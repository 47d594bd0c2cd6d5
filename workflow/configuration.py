"""The config: checked with errors that name the key and the remedy, and resolved to what one table depends on."""

import difflib
import math
from collections.abc import Iterator
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

ROOT = Path(__file__).resolve().parent.parent
SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
# Sections that make tables of their own, instead of one for each of their entries.
TABLES = {
    "orbits": ("branches", "folds_and_doublings", "cascade"),
    "attractors": ("strobes",),
    "lyapunov": ("spectrum", "witnesses"),
    "results": ("estimators", "stability", "stability_estimates", "scene_budget", "rigid_part"),
}
# What YAML calls the types of JSON schema.
KINDS = {
    "null": "null",
    "array": "a list",
    "integer": "a whole number",
    "number": "a number",
    "object": "a mapping of keys to values",
    "string": "text",
}


def key_of(path) -> str:
    """ "sweeps.mine.axes.z0[1]" of the path of a schema error."""
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path).lstrip(".") or "config"


def reads_as_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def explain_range(value, schema: dict) -> str:
    """How a number misses the range of its schema, with the unit and the usual mix-up of units."""
    low, high = schema.get("minimum", schema.get("exclusiveMinimum")), schema.get("maximum", math.inf)
    left = "(" if "exclusiveMinimum" in schema else "["
    unit = schema.get("unit", "")
    text = f"= {value!r} is outside {left}{low:g}, {high:g}] {unit}".rstrip()
    if unit == "rad" and abs(value) > high:
        text += f"; angles are in radians, {value:g}° are {math.radians(value):.4f} rad"
    return text


def explain(error: ValidationError) -> str:
    """One line for one schema error: the key, what is wrong with it, and what would be right."""
    key, value, schema = key_of(error.absolute_path), error.instance, error.schema
    match error.validator:
        case "additionalProperties":
            known = sorted(schema.get("properties", {}))
            lines = []
            for name in sorted(set(value) - set(known)):
                close = difflib.get_close_matches(str(name), known, n=1)
                remedy = f"did you mean {close[0]}?" if close else f"known keys: {', '.join(known)}"
                lines.append(f"{key_of([*error.absolute_path, name])} is an unknown key; {remedy}")
            return "\n".join(lines)
        case "required":
            missing = [name for name in schema["required"] if name not in value]
            return f"{key} lacks {', '.join(missing)}"
        case "minimum" | "maximum" | "exclusiveMinimum":
            if key.endswith(".num"):
                return f"{key} = {value!r} makes an empty axis; give at least 1"
            return f"{key} {explain_range(value, schema)}"
        case "minItems":
            return f"{key} is empty; give a list of at least one value, or {{start: …, stop: …, num: …}}"
        case "minProperties":
            return f"{key} is empty; give at least one axis: {', '.join(schema['properties'])}"
        case "enum":
            return f"{key} = {value!r} is not one of {', '.join(map(str, schema['enum']))}"
        case "pattern" if not reads_as_number(value):
            return f"{key} = {value!r} is not {schema['expected']}"
        case "type" | "pattern":
            if isinstance(value, str) and reads_as_number(value):
                return (
                    f"{key} = {value!r} is text to YAML; write it with a decimal point and a signed exponent (1.0e-4)"
                )
            wanted = schema["type"]
            kinds = " or ".join(KINDS[kind] for kind in ([wanted] if isinstance(wanted, str) else wanted))
            unit = f" ({schema['unit']})" if "unit" in schema else ""
            return f"{key} = {value!r} is not {kinds}{unit}"
    return f"{key}: {error.message}"


def numbers(value, path=()) -> Iterator[tuple[tuple, float]]:
    """All (path, number) pairs below a config value."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from numbers(item, (*path, name))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            yield from numbers(item, (*path, index))
    elif isinstance(value, float):
        yield path, value


def entry_of(config: dict, reference: str) -> dict | None:
    """What the config says about the table SECTION/NAME, or None if there is no such table."""
    section, name = reference.split("/")
    if name in TABLES.get(section, ()):
        return config[name if section == "results" else section]
    if section in ("precision", "wall_times"):
        return config["precision"] if name in config["precision"]["scenes"] else None
    entries = config.get(section)
    return entries.get(name) if isinstance(entries, dict) else None


def contradictions(config: dict) -> Iterator[str]:
    """What a schema cannot say: one line per contradiction between parts of a config that follows the schema."""
    for section, entries in config.items():
        if not isinstance(entries, dict):
            continue
        for name, entry in entries.items():
            if isinstance(entry, dict):
                for axis in sorted(set(entry.get("axes", ())) & set(entry.get("model", ()))):
                    yield f"{section}.{name}.model.{axis} is an axis of this entry too; keep one of them"
    for figure, entry in config["figures"].items():
        for file in (f"scripts/plots/{figure}.py", f"workflow/report/{figure}.rst"):
            if not (ROOT / file).is_file():
                yield f"figures.{figure} has no {file}; a figure needs a plot script and a caption of its name"
        for reference in entry["tables"].values():
            table = entry_of(config, reference)
            if table and entry["needs"] == "feeding" and table.get("needs") == "vertical":
                yield f"figures.{figure} needs feeding, but {reference} is computed for vertical needs only"
    for user in ("figures", "claims"):
        for name, entry in config[user].items():
            for role, reference in entry["tables"].items():
                if entry_of(config, reference) is None:
                    yield f"{user}.{name}.tables.{role} = {reference!r} is no entry of the config"
    companion = config["companion"]
    for index, name in enumerate(companion["maps"]):
        if name not in config["sweeps"]:
            yield f"companion.maps[{index}] = {name!r} is no entry of sweeps"
    if companion["opening"] not in companion["presets"]:
        yield f"companion.opening = {companion['opening']!r} is not one of {', '.join(companion['presets'])}"
    for claim, entry in config["claims"].items():
        for key in ("paper", "accepted"):
            if len(entry[key]) != len(entry["quantities"]):
                counts = f"{len(entry[key])} items for {len(entry['quantities'])} quantities"
                yield f"claims.{claim}.{key} has {counts}; give one for each"


def problems(config: dict) -> list[str]:
    """All errors of a config, one line each; empty if there are none."""
    validator = Draft202012Validator(yaml.safe_load(SCHEMA.read_text()))
    lines = [explain(error) for error in sorted(validator.iter_errors(config), key=lambda error: str(error.json_path))]
    lines += [
        f"{key_of(path)} = {value!r} is not a finite number" for path, value in numbers(config) if value - value != 0
    ]
    # An error below two branches of the schema is reported once.
    return list(dict.fromkeys(lines)) or list(contradictions(config))


def resolve(config: dict, section: str, name: str) -> dict:
    """Everything that the table `section`/`name` depends on, defaults filled in, and nothing else."""
    entry = {
        **{key: config["solver"][key] for key in ("duration", "method", "tolerance", "step")},
        **config[section][name],
    }
    entry["model"] = {**config["model"], **entry.get("model", {})}
    for axis in entry.get("axes", ()):
        del entry["model"][axis]
    del entry["step" if entry["method"] == "event" else "tolerance"]
    return entry


def count_points(axes: dict) -> int:
    """Number of points in the product of axes."""
    return math.prod(len(axis) if isinstance(axis, list) else int(axis["num"]) for axis in axes.values())
