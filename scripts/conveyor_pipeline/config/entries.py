"""Entries of sections with one table per entry: methods, defaults, tables of tighter tolerances, axes."""

import math

from conveyor.parameters import TANGENTIAL
from conveyor_pipeline.common.axes import count_points, ends
from conveyor_pipeline.common.table_settings import without_tangential
from conveyor_pipeline.config.stages import declared

ENTRIES = ("sweeps", "estimates", "critical", "regressions", "dimensions", "signals", "spectra", "impacts")
FIGURES = ("figures", "figures_on_request")
# Sections that follow initial conditions until the motion settles.
SETTLING = ("sweeps", "critical", "impacts", "signals", "spectra")
# Sections whose entries may list several methods.
METHOD_SECTIONS = ("sweeps", "estimates", "critical", "dimensions", "signals", "spectra")
# Files of measurements that an overlay may name: the key in each section that has one.
MEASURED_FILES = declared("MEASURED_FILES")
# Ending of the name of a table with a tighter tolerance; the name of an entry cannot have a dot.
TIGHTER = ".tighter"
# Sections whose tables describe only the motion normal to the track.
NORMAL = ("critical", "dimensions", "impacts")


def variants(name: str, entry: dict) -> dict[str, dict]:
    """The tables of an entry: NAME has the first of its `methods`, NAME_METHOD each further one."""
    if "methods" not in entry:
        return {name: entry}
    alone = {key: value for key, value in entry.items() if key != "methods"}
    first, *others = entry["methods"]
    return {name: alone | {"method": first}} | {f"{name}_{method}": alone | {"method": method} for method in others}


def by_methods(config: dict) -> dict:
    """A config with one method per entry."""
    expanded = dict(config)
    for section in METHOD_SECTIONS:
        expanded[section] = {}
        for name, entry in config[section].items():
            expanded[section] |= variants(name, entry)
    return expanded


def with_tighter(config: dict) -> dict:
    """A config with one method per entry, and each converged table a second time, with a tighter tolerance."""
    expanded = config | {section: dict(config[section]) for section in METHOD_SECTIONS}
    for section in METHOD_SECTIONS:
        for name, entry in config[section].items():
            if entry.get("method", config["solver"]["method"]) == "event":
                tolerance = entry.get("tolerance", config["solver"]["tolerance"]) / config["uncertainty"]["tighter"]
                expanded[section][name + TIGHTER] = entry | {"tolerance": tolerance}
    return expanded


def fill_defaults(config: dict, section: str, entry: dict) -> dict:
    """An entry of a section of trajectories with all settings that its table depends on."""
    solver = {key: config["solver"][key] for key in ("duration", "method", "tolerance", "step")}
    filled = {**solver, **entry}
    if section in SETTLING or entry.get("estimator", "paper") != "paper":
        filled["settling"] = config["solver"]["settling"]
    filled["model"] = {**config["model"], **entry.get("model", {})}
    for axis in entry.get("axes", ()):
        filled["model"].pop(axis, None)
    del filled["step" if filled["method"] == "event" else "tolerance"]
    return filled


def is_normal(section: str, entry: dict) -> bool:
    """Whether a table follows from the motion normal to the track alone."""
    varied = set(entry.get("axes", ())) & set(TANGENTIAL)
    return not varied and (section in NORMAL or entry.get("needs") == "vertical" or entry.get("output") in ("z", "vz"))


def resolve(config: dict, section: str, name: str) -> dict:
    """All settings that the table `section`/`name` depends on."""
    entry = fill_defaults(config, section, config[section][name])
    return entry | {"model": without_tangential(entry["model"])} if is_normal(section, entry) else entry


def values_of(entry: dict, name: str) -> list:
    """The values that a parameter takes in a resolved entry, or the ends of their range."""
    return ends(entry["axes"][name]) if name in entry["axes"] else [entry["model"][name]]


def count_shards(config: dict, entry: dict) -> int:
    """Number of shards of a sweep, each of which one job computes."""
    return math.ceil(count_points(entry["axes"]) / config["sharing"]["rows"])
