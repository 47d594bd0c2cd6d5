"""Scale the paper's config to another conveyor, which an overlay with a prefix and a model describes.

Axes, heights, velocities and times keep their values in the characteristic scales of the conveyor. The scaled config
lacks what follows from the paper's own numbers, unless the overlay names it: claims, marks in figures, fits, first
orbits, and the tables of the paper's method.
"""

import math
from typing import Any

from .errors import type_problems
from .files import merge
from .model import MODEL
from .schema import child, full_schema, schema_at, unit_of
from .tables import FIGURES, METHOD_SECTIONS

# Parameters of the conveyor and the part; the other parameters of the model are settings of a run.
MACHINE = ("angle", "frequency", "stiffness", "damping", "friction", "mass", "exponent", "gravity")
# Settings of figures that mark a number of the paper.
MARKS = ("critical_acceleration", "critical_height", "first_positive", "two_states")
DIGITS = 4  # of scaled amplitudes, heights and velocities, which appear on axes and in titles
ROUNDED = ("m/s²", "m", "m/s", "m²/s²")
STEPS = 4000  # the steps per excitation cycle are a multiple of this number, so that samples lie on steps


def as_mapping(value: Any) -> dict:
    """The value, or {} where an overlay has no mapping; another check reports that."""
    return value if isinstance(value, dict) else {}


def is_own_machine(paper: dict, overlay: dict) -> bool:
    """Whether an overlay has a prefix and another conveyor than the paper."""
    model, papers = as_mapping(overlay.get("model")), as_mapping(paper.get("model"))
    return bool(overlay.get("prefix")) and any(name in model and model[name] != papers.get(name) for name in MACHINE)


def scale_ratios(paper: dict, own: dict) -> dict[str, float]:
    """The ratio between two models' scales for each unit: amplitude g / sin φ, height g/ω², velocity g/ω, period."""
    amplitude = own["gravity"] / paper["gravity"] * math.sin(paper["angle"]) / math.sin(own["angle"])
    gravity = own["gravity"] / paper["gravity"]
    frequency = own["frequency"] / paper["frequency"]
    height = gravity / frequency**2
    return {
        "m/s²": amplitude,
        "m": height,
        "m/s": gravity / frequency,
        "s": 1.0 / frequency,
        "Hz": frequency,
        "1/s": frequency,
        "m²": height**2,
        "m²/s²": height * amplitude,
    }


def scale(value: Any, schema: dict, ratios: dict[str, float]) -> Any:
    """A value with all its numbers multiplied by the ratios of their units, which the schema has."""
    if isinstance(value, dict):
        return {key: scale(item, child(schema, key), ratios) for key, item in value.items()}
    if isinstance(value, list):
        return [scale(item, child(schema, place), ratios) for place, item in enumerate(value)]
    unit = unit_of(schema)
    if not isinstance(value, float) or ratios.get(unit, 1.0) == 1.0:
        return value
    scaled = value * ratios[unit]
    return float(f"{scaled:.{DIGITS}g}") if unit in ROUNDED else scaled


def contact_time(model: dict) -> float:
    """Time scale of the contact under a part at rest (s)."""
    p = model["exponent"]
    weight = model["mass"] * model["gravity"]
    return math.sqrt(model["mass"] / (p * model["stiffness"] ** (1.0 / p) * weight ** (1.0 - 1.0 / p)))


def scaled_step(paper: dict, own: dict) -> float:
    """The time step of fixed-step methods (s): the paper's in units of the contact time, or a little shorter."""
    step = paper["solver"]["step"] * contact_time(own) / contact_time(paper["model"])
    return 1.0 / (own["frequency"] * STEPS * math.ceil(1.0 / (own["frequency"] * STEPS * step) - 1e-9))


def drop_other_methods(config: dict, overlay: dict) -> set[str]:
    """Drop the tables of fixed-step methods that neither the overlay nor a figure of it names; return these tables."""
    named = [config[section].get(name, {}) for section in FIGURES for name in as_mapping(overlay.get(section))]
    needed = {reference for entry in named if "paper_only" in entry for reference in entry["tables"].values()}
    dropped = set()
    for section in (*METHOD_SECTIONS, "dimensions"):
        overlays = as_mapping(overlay.get(section))
        for name, entry in list(config[section].items()):
            twin = f"{section}/{name}_euler"
            if "methods" in entry and "methods" not in as_mapping(overlays.get(name)) and twin not in needed:
                entry["method"] = entry.pop("methods")[0]
                dropped.add(twin)
            elif entry.get("method", "event") != "event" and name not in overlays and f"{section}/{name}" not in needed:
                del config[section][name]
                dropped.add(f"{section}/{name}")
    for name, entry in list(config["regressions"].items()):
        if f"critical/{entry['critical']}" in dropped and name not in as_mapping(overlay.get("regressions")):
            del config["regressions"][name]
            dropped.add(f"regressions/{name}")
    return dropped


def machine_problems(paper: dict, overlay: dict) -> list[str]:
    """Errors in the model of an overlay, one line each."""
    config = merge(paper, {"model": overlay["model"]})
    if errors := type_problems(config):
        return errors
    if math.sin(config["model"]["angle"]) == 0.0:
        return [
            "model.angle = 0.0 makes the plate move only horizontally: no amplitude lifts a part; give a larger angle"
        ]
    return []


def scale_config(paper: dict, overlay: dict) -> dict:
    """The paper's config scaled to the conveyor of an overlay, which is then merged over it."""
    own = {**paper["model"], **{name: float(value) for name, value in overlay["model"].items() if name in MACHINE}}
    ratios = scale_ratios(paper["model"], own)
    config = scale(MODEL.validate_python(paper), full_schema(), ratios)
    config["model"] |= {name: own[name] for name in MACHINE}
    if own != paper["model"]:
        config["solver"]["step"] = scaled_step(paper, own)
    for entry in config["estimates"].values():
        entry["epsilon"] = scale(entry["epsilon"], schema_at(["model", entry["perturb"]]), ratios)

    dropped = drop_other_methods(config, overlay)
    del config["orbits"]["seeds"]
    for entry in config["regressions"].values():
        del entry["acceleration"], entry["paper"]
    config["claims"], config["uncertainty"]["claims"] = {}, []
    for section in FIGURES:
        for name, entry in list(config[section].items()):
            if "paper_only" in entry and name not in as_mapping(overlay.get(section)):
                del config[section][name]
                continue
            for key in ("tables", "caption_tables"):
                if key in entry:
                    entry[key] = {role: table for role, table in entry[key].items() if table not in dropped}
            if "settings" in entry:
                entry["settings"] = {key: value for key, value in entry["settings"].items() if key not in MARKS}
    return config


def refused_figures(paper: dict, config: dict) -> dict[str, str]:
    """Figures of the paper's config that another config does not have, with the reasons."""
    return {
        name: entry["paper_only"]
        for section in FIGURES
        for name, entry in paper[section].items()
        if "paper_only" in entry and name not in config[section]
    }
