"""Errors of the config as lines that name the key, the fault and the remedy."""

import difflib
import math
import re
from collections.abc import Iterable
from reprlib import Repr
from textwrap import shorten
from typing import Any

import yaml
from pydantic import ValidationError

from .entries import ENTRIES, FIGURES
from .model import MODEL
from .schema import options_of, schema_at, unit_of

# Errors with a remedy: searching similar names for thousands of errors would take seconds.
MOST_EXPLAINED = 200
MOST_LINES = 6  # of a message: ten with the four lines that Snakemake adds
SHORT = Repr()
SHORT.maxstring = SHORT.maxother = 60
format_value = SHORT.repr
# A number that YAML 1.1 reads as text, such as 1e-4.
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
# Settings of earlier versions that nobody needed to change. The keys of each section, by the module of scripts/ in
# which they are constants.
CONSTANTS = {
    "accuracy/benchmark": {"benchmark": "cases"},
    "accuracy/map_check": {"map_check": "boundary seed cycles tolerance close repeats significant accepted"},
    "accuracy/precision": {"precision": "sample_interval tolerances steps peers seconds max_evaluations"},
    "accuracy/reference_check": {"precision": "reference"},
    "accuracy/scene_budget": {"scene_budget": "tolerances pixels line"},
    "accuracy/scenes": {"precision": "scenes", "": "published_scenes"},
    "accuracy/settling_times": {"settling_times": "acceleration z0 seed cycles"},
    "accuracy/speed": {"figures.NAME.settings": "paper_step equal_error"},
    "accuracy/stability": {"stability": "contact conveyor damping impact_velocity methods step stiffness"},
    "accuracy/stability_estimates": {"": "stability_estimates"},
    "accuracy/theory": {"": "theory"},
    "calibration/edges": {"identification": "contacts heights edges"},
    "calibration/effort": {
        "calibration": "parts first points rounds enough effective "
        "samples checked checked_parts replicates amplitudes predicted predicted_parts",
    },
    "calibration/inference": {"calibration": "confidence"},
    "calibration/model_check": {"calibration": "decisive significance"},
    "calibration/paper_numbers": {"identification": "inside"},
    "calibration/paper_posterior": {"identification": "evidence search"},
    "calibration/likelihood": {"calibration": "outliers"},
    "calibration/prediction": {"calibration": "beyond"},
    "calibration/settings": {"identification": "bounds ranges"},
    "calibration/study": {"": "calibration_study"},
    "dimensions/portraits": {"dimensions.NAME": "interval octaves theiler largest_error"},
    "docs/companion/build": {"companion": "opening separation"},
    "excitation/limits": {"clean_drive": "matters statement"},
    "fit/regressions": {"regressions.NAME": "seed evaluations"},
    "figures/plots/bifurcation": {"figures.NAME.settings": "lowest_exponent"},
    "figures/plots/fig05": {"figures.NAME.settings": "begin"},
    "figures/plots/fig06": {"figures.NAME.settings": "highest"},
    "figures/plots/fig23": {"figures.NAME.settings": "transient"},
    "figures/plots/stability": {"stability": "paper_step"},
    "motion/critical": {"critical.NAME": "resolution"},
    "motion/spectra": {"spectra.NAME": "last samples_per_cycle"},
    "operating/drift": {"drift": "forgotten lengths"},
    "operating/drive": {"drive": "drawn settled seeds checked recommended"},
    "operating/regimes": {"operating": "same_velocity"},
    "operating/shares": {"operating": "followed cycles"},
    "operating/throws": {"throws": "followed"},
    "operating/track": {"track": "cycles"},
    "orbits/branches": {"orbits": "most"},
    "orbits/certified": {
        "certificates": "longest_period bits order tolerance closeness half_width half_arc",
        "certificates.chaos": "size ratio longest bits order tolerance",
    },
    "orbits/estimates": {"estimates.NAME": "samples"},
    "orbits/seeds": {"orbits": "cycles"},
    "orbits/settings": {"": "lyapunov", "certificates": "also"},
    "orbits/witnesses": {"": "witnesses"},
    "sensitivity/derivatives": {"sensitivity": "rest"},
    "sensitivity/selection": {"sensitivity": "longest_period most"},
    "workflow/config/sharing": {"sharing": "seconds megabytes most_jobs"},
}
# Keys of each section that nothing uses any more.
GONE = {
    "": "precision_estimates rigid_part scaling",
    "companion": "tolerance cycles",
    "stability": "hard rivals stick chatter_steps",
}
# Settings with a new name.
RENAMED = {
    "settling_times.starts": "settling_times.effort, a factor of the number of initial conditions",
    **{f"drift.{key}": "drift.effort, a factor of all its numbers" for key in ("amplitudes", "runs", "cycles")},
    **{f"sensitivity.{key}": "sensitivity.effort, a factor of both numbers" for key in ("doublings", "heights")},
    "sensitivity.curves": "sensitivity.factors, the ranges of the parameters, and sensitivity.effort",
    "scene_budget.points": "scene_budget.effort, a factor of all numbers of points",
    "dimensions.NAME.begin": "solver.settling, in excitation cycles",
}
BOUNDS = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}


class ConfigError(Exception):
    """A config that cannot be used; the message has at most six lines."""

    def __init__(self, lines: list[str]):
        head = "The config cannot be used"
        if (more := len(lines) - MOST_LINES + 1) > 0:
            lines = lines[: MOST_LINES - 1]
            head += f"; the first {len(lines)} errors, {more} more"
        super().__init__("\n".join([f"{head}:", *lines]))


def suggest_name(name: Any, known: Iterable[str]) -> str:
    """The remedy for an unknown name."""
    close = difflib.get_close_matches(str(name)[:100], known, n=1)
    return f"did you mean {close[0]}?" if close else f"there are {shorten(', '.join(known) or 'none', 300)}"


def format_key(path: Iterable[str | int]) -> str:
    """ "sweeps.mine.axes.z0[1]" for the path of a value."""
    names = (part if len(str(part)) <= 64 and str(part).isprintable() else format_value(part) for part in path)
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in names).lstrip(".") or "config"


def fault_of_removed(path: list[str | int]) -> str:
    """What to do about a setting of an earlier version; empty for keys that never were settings."""
    # Each entry and each figure has its own name.
    key = format_key([path[0], "NAME", *path[2:]] if path[0] in (*ENTRIES, *FIGURES) else path)
    section, _, name = key.rpartition(".")
    if key in RENAMED:
        return f"; give {RENAMED[key]}"
    if name in GONE.get(section, "").split():
        return ", because what used it is gone; remove it"
    module = next((module for module, keys in CONSTANTS.items() if name in keys.get(section, "").split()), None)
    if module is None:
        return ""
    file = module if module.startswith("workflow/") else f"scripts/{module}"
    return f"; remove it (its value is a constant in {file}.py)"


def explain(error: dict) -> str:
    """One line for an error of pydantic."""
    # Without the names of forms ("(span)"), and without "[key]" behind a name of the user's choice.
    path = [part for part in error["loc"] if str(part)[:1] != "(" and part != "[key]"]
    kind, value, is_name = error["type"], error["input"], error["loc"][-1:] == ("[key]",)
    key, above, schema = format_key(path), format_key(path[:-1]), schema_at(path)
    shown = f"{key} = {format_value(value)}"
    if kind == "invalid_key" or (is_name and not isinstance(value, str)):
        # {frequency: 50,0} has the key 0.
        has_comma = type(value) is int and any("properties" in option for option in options_of(schema_at(path[:-1])))
        remedy = "write decimal points, not commas" if has_comma else "put it in quotes"
        return f"{above} has a key that YAML reads as {value!r}, not as text; {remedy}"
    if is_name:
        names = schema_at(path[:-1])["propertyNames"]
        remedy = suggest_name(value, names["enum"]) if "enum" in names else f"give {names['patternErrorMessage']}"
        return f"{above} has the unknown name {format_value(value)}; {remedy}"
    if kind == "missing":
        return f"{key} is missing"
    if kind == "extra_forbidden" and (fault := fault_of_removed(path)):
        return f"{key} is no setting any more{fault}"
    if kind == "extra_forbidden" and path[0] in FIGURES and path[2:] == ["title"]:
        return f"{key} is no setting any more; remove it (the title is in scripts/figures/plots/{path[1]}.rst)"
    if kind == "extra_forbidden":
        known = [name for option in options_of(schema_at(path[:-1])) for name in option.get("properties", {})]
        return f"{key} is an unknown key; {suggest_name(path[-1], known)}"
    if kind == "value_error":
        return f"{shown} {error['ctx']['error']}"
    if kind == "string_pattern_mismatch":
        return f"{shown} should be {schema['patternErrorMessage']}"
    if kind in ("float_type", "int_type", "form") and isinstance(value, str) and NUMBER.fullmatch(value):
        is_quoted = isinstance(yaml.safe_load(value), int | float)
        remedy = "remove the quotes" if is_quoted else "write it with a decimal point and a signed exponent (1.0e-4)"
        return f"{shown} is text to YAML; {remedy}"
    if kind == "dict_type" and value is None and path:
        return f"{key} is empty; give keys below it, or delete it"
    if kind == "string_type" and isinstance(value, int | float):
        return f"{shown} is no text to YAML; put it in quotes"
    # "Input should be …", "List should have …"
    unit, fault = unit_of(schema), error["msg"].partition(" ")[2]
    for name, bound in error.get("ctx", {}).items():
        fault = f"should be {BOUNDS[name]} {bound:g}" if name in BOUNDS else fault
    fault = fault.replace(" after validation", "").replace("dictionary", "mapping")
    is_degrees = kind == "less_than_equal" and unit == "rad" and value <= 360
    remedy = f"; angles are in radians, {value:g}° are {math.radians(value):.4f} rad" if is_degrees else ""
    return f"{shown} {fault}{f' ({unit})' if unit not in ('', '1') else ''}{remedy}"


def type_problems(config: Any, ignored: str = "") -> list[str]:
    """Errors of the types of a config, one line each, without errors of the kind `ignored`."""
    try:
        MODEL.validate_python(config)
    except ValidationError as invalid:
        errors = [error for error in invalid.errors(include_url=False) if error["type"] != ignored]
        more = [f"{format_key(error['loc'])}: {error['msg']}" for error in errors[MOST_EXPLAINED:]]
        return [explain(error) for error in errors[:MOST_EXPLAINED]] + more
    return []
