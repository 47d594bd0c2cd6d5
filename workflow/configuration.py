"""The config: checked with errors that name the key and the remedy, and resolved to what one table depends on."""

import ast
import difflib
import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

ROOT = Path(__file__).resolve().parent.parent
SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
# Sections that make tables of their own, instead of one for each of their entries.
TABLES = {
    "orbits": (
        "branches",
        "folds_and_doublings",
        "cascade",
        "certificates",
        "certified_bifurcations",
        "certified_chaos",
        "certificate_times",
    ),
    "attractors": ("strobes",),
    "lyapunov": ("spectrum", "witnesses"),
    "results": (
        "estimators",
        "stability",
        "stability_estimates",
        "scene_budget",
        "budget_times",
        "rigid_part",
        "settling_times",
    ),
}
# Tables of the folder of results that another section than that of their name makes.
SECTION_OF = {"budget_times": "scene_budget"}
# Sections whose tables say what motion a start ends in.
SETTLING = ("sweeps", "critical", "impacts", "signals", "spectra")
# Sections whose entries may be followed by a fixed-step method for their duration.
METHODS = ("sweeps", "estimates", "critical", "signals", "spectra")
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
    low = schema.get("minimum", schema.get("exclusiveMinimum"))
    high = schema.get("maximum", schema.get("exclusiveMaximum", math.inf))
    left = "(" if "exclusiveMinimum" in schema else "["
    right = ")" if "exclusiveMaximum" in schema else "]"
    unit = schema.get("unit", "")
    text = f"= {value!r} is outside {left}{low:g}, {high:g}{right} {unit}".rstrip()
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
        case "minimum" | "maximum" | "exclusiveMinimum" | "exclusiveMaximum":
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
        return config[SECTION_OF.get(name, name) if section == "results" else section]
    if section in ("precision", "wall_times"):
        return config["precision"] if name in config["precision"]["scenes"] else None
    entries = config.get(section)
    return entries.get(name) if isinstance(entries, dict) else None


@cache
def finding_names() -> frozenset[str]:
    """MODULE.FUNCTION of all functions of scripts/findings that give a Finding."""
    return frozenset(
        f"{path.stem}.{node.name}"
        for path in (ROOT / "scripts/findings").glob("*.py")
        for node in ast.parse(path.read_bytes()).body
        if isinstance(node, ast.FunctionDef)
        and getattr(node.returns, "id", None) == "Finding"
        and path.stem != "finding"
    )


def contradictions(config: dict) -> Iterator[str]:
    """What a schema cannot say: one line per contradiction between parts of a config that follows the schema."""
    for section, entries in config.items():
        if not isinstance(entries, dict):
            continue
        for name, entry in entries.items():
            if isinstance(entry, dict):
                for axis in sorted(set(entry.get("axes", ())) & set(entry.get("model", ()))):
                    yield f"{section}.{name}.model.{axis} is an axis of this entry too; keep one of them"
    for section in METHODS:
        for name in config[section]:
            entry = resolve(config, section, name)
            if "step" in entry and not whole_steps(entry["duration"], entry["step"]):
                count = max(1, round(entry["duration"] / entry["step"]))
                reason = f"does not divide its duration of {entry['duration']!r} s; take {entry['duration'] / count!r}"
                yield f"{section}.{name}.step = {entry['step']!r} s {reason}"
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
            for key in ("tables", "caption_tables"):
                for role, reference in entry.get(key, {}).items():
                    if entry_of(config, reference) is None:
                        yield f"{user}.{name}.{key}.{role} = {reference!r} is no entry of the config"
    companion = config["companion"]
    for index, name in enumerate(companion["maps"]):
        if name not in config["sweeps"]:
            yield f"companion.maps[{index}] = {name!r} is no entry of sweeps"
    if companion["opening"] not in companion["presets"]:
        yield f"companion.opening = {companion['opening']!r} is not one of {', '.join(companion['presets'])}"
    for claim, entry in config["claims"].items():
        if entry["finding"] not in finding_names():
            known = ", ".join(sorted(finding_names()))
            yield f"claims.{claim}.finding = {entry['finding']!r} is no function of scripts/findings; there are {known}"
        for name, quantity in entry["quantities"].items():
            low, high = quantity["accepted"]
            if low is not None and high is not None and low > high:
                key = f"claims.{claim}.quantities.{name}.accepted"
                yield f"{key} = {quantity['accepted']!r} is reversed; give [least, largest]"


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
    if section in SETTLING:
        entry["settling"] = config["solver"]["settling"]
    entry["model"] = {**config["model"], **entry.get("model", {})}
    for axis in entry.get("axes", ()):
        del entry["model"][axis]
    del entry["step" if entry["method"] == "event" else "tolerance"]
    return entry


def whole_steps(duration: float, step: float) -> bool:
    """Whether a duration (s) is a whole number of steps (s), up to the rounding of both."""
    count = round(duration / step)
    return count > 0 and abs(duration / step - count) <= 1e-9 * count


def count_points(axes: dict) -> int:
    """Number of points in the product of axes."""
    return math.prod(len(axis) if isinstance(axis, list) else int(axis["num"]) for axis in axes.values())
