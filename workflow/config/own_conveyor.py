"""Scale the paper's config to another conveyor, which an overlay with a prefix and a model describes.

Axes, heights, velocities and times keep their values in the characteristic scales of the conveyor. The scaled config
leaves out everything that follows from the paper's own numbers, unless the overlay names it: claims, marks in figures,
fits, first orbits, and the tables of the paper's method.
"""

import itertools
import math
from typing import Any

from scripts.conveyor import normal_gravity
from scripts.pipeline.settings import MODEL_KEYS
from scripts.pipeline.table_settings import INITIAL_CONDITION, without_tangential

from .entries import ENTRIES, FIGURES, METHOD_SECTIONS, by_methods
from .errors import ConfigError
from .files import merge
from .model import MODEL
from .schema import child, full_schema, schema_at, unit_of

# Parameters of the conveyor and the part; the other parameters of the model are settings of a run.
CONVEYOR = tuple(name for name in MODEL_KEYS if name not in ("acceleration", "tension", *INITIAL_CONDITION))
# Settings of figures that mark a number of the paper.
MARKS = ("critical_acceleration", "critical_height", "first_positive", "two_states")
# Of scaled amplitudes, heights and velocities, which stand on axes and in titles; of other numbers.
DIGITS, EXACT = 4, 17
ROUNDED = ("m/s²", "m", "m/s", "m²/s²")
# Names of the scaled quantities, and their units.
SCALED = {"amplitudes": "m/s²", "heights": "m", "velocities": "m/s", "times": "s"}
STEPS = 4000  # the steps per excitation cycle are a multiple of this number, so that samples lie on steps


def names_conveyor(paper: dict, overlay: dict) -> bool:
    """Whether an overlay gives the conveyor or the part a value other than the paper's."""
    model = overlay.get("model", {})
    return any(model[name] != paper["model"].get(name) for name in CONVEYOR if name in model)


def is_own_conveyor(paper: dict, config: dict) -> bool:
    """Whether a complete config has a prefix and a conveyor other than the paper's."""
    return bool(config["prefix"]) and names_conveyor(paper, config)


def scale_ratios(paper: dict, own: dict) -> dict[str, float]:
    """The ratio between two models' scales for each unit: amplitude g / sin φ, height g/ω², velocity g/ω, period.

    Here g is the gravity normal to the track.
    """
    gravity = normal_gravity(own) / normal_gravity(paper)
    amplitude = gravity * math.sin(paper["angle"]) / math.sin(own["angle"])
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


def scale(value: Any, schema: dict, ratios: dict[str, float], digits: int = DIGITS) -> Any:
    """A value with its numbers multiplied by the ratios of their units, unless the schema forbids it.

    Amplitudes, heights and velocities are rounded to `digits`.
    """
    if isinstance(value, dict):
        return {key: scale(item, child(schema, key), ratios, digits) for key, item in value.items()}
    if isinstance(value, list):
        scaled = [scale(item, child(schema, place), ratios, digits) for place, item in enumerate(value)]
        # Rounding must not make two distinct values of a list equal.
        merges = any(one == other for one, other in itertools.pairwise(scaled)) and digits < EXACT
        return scale(value, schema, ratios, EXACT) if merges else scaled
    unit = unit_of(schema)
    if not isinstance(value, float) or ratios.get(unit, 1.0) == 1.0 or not schema.get("scaled", True):
        return value
    return float(f"{value * ratios[unit]:.{digits if unit in ROUNDED else EXACT}g}")


def contact_time(model: dict) -> float:
    """Time scale of the contact under a part at rest (s)."""
    p = model["exponent"]
    weight = model["mass"] * normal_gravity(model)
    return math.sqrt(model["mass"] / (p * model["stiffness"] ** (1.0 / p) * weight ** (1.0 - 1.0 / p)))


def scaled_step(paper: dict, own: dict) -> float:
    """The time step of fixed-step methods (s): the paper's in units of the contact time, or a little shorter."""
    step = paper["solver"]["step"] * contact_time(own) / contact_time(paper["model"])
    return 1.0 / (own["frequency"] * STEPS * math.ceil(1.0 / (own["frequency"] * STEPS * step) - 1e-9))


def drop_other_methods(config: dict, overlay: dict) -> None:
    """Drop the tables of fixed-step methods that neither the overlay nor its figures name."""
    figures = [config[section].get(name, {}) for section in FIGURES for name in overlay.get(section, ())]
    needed = {reference for figure in figures if "paper_only" in figure for reference in figure["tables"].values()}
    for section in METHOD_SECTIONS:
        for name, entry in list(config[section].items()):
            if "methods" in entry and f"{section}/{name}_euler" not in needed:
                entry["methods"] = entry["methods"][:1]
            is_named = name in overlay.get(section, ()) or f"{section}/{name}" in needed
            if entry.get("method", "event") != "event" and not is_named:
                del config[section][name]
    for name, entry in list(config["regressions"].items()):
        if entry["critical"] not in config["critical"] and name not in overlay.get("regressions", ()):
            del config["regressions"][name]


def drop_figures(config: dict, overlay: dict) -> None:
    """Drop what belongs to the paper in figures: whole figures, marks, and tables that the config no longer has.

    The figure of the sensitivities needs derivatives in dimensionless groups, which a plate with harmonics has not.
    """
    single = by_methods(merge(config, overlay))

    def remains(reference: str) -> bool:
        section, name = reference.split("/")
        return section not in ENTRIES or name in single[section]

    for section in FIGURES:
        for name, entry in list(config[section].items()):
            no_harmonics = name == "sensitivity" and overlay["model"].get("harmonics")
            if ("paper_only" in entry or no_harmonics) and name not in overlay.get(section, ()):
                del config[section][name]
            for key in {"tables", "caption_tables"} & entry.keys():
                entry[key] = {role: table for role, table in entry[key].items() if remains(table)}
            # A figure of the paper that the overlay names cannot be drawn without its marks.
            if "settings" in entry and "paper_only" not in entry:
                entry["settings"] = {key: value for key, value in entry["settings"].items() if key not in MARKS}


def scale_config(paper: dict, overlay: dict) -> dict:
    """The paper's config scaled to the conveyor of an overlay, which is then merged over it.

    ConfigError if there is no scale for amplitudes. The overlay must have passed the type checks.
    """
    changed = {name: value for name, value in overlay["model"].items() if name in CONVEYOR}
    own = paper["model"] | {name: value if name == "harmonics" else float(value) for name, value in changed.items()}
    if math.sin(own["angle"]) == 0.0:
        raise ConfigError(["model.angle = 0.0 means that no amplitude can lift a part; give a larger angle"])
    ratios = scale_ratios(paper["model"], own)
    config = scale(MODEL.validate_python(paper), full_schema(), ratios)
    config["model"] |= {name: own[name] for name in CONVEYOR if name in own}
    if own != paper["model"]:
        config["solver"]["step"] = scaled_step(paper, own)
    for entry in config["estimates"].values():
        entry["epsilon"] = scale(entry["epsilon"], schema_at(["model", entry["perturb"]]), ratios)
    # How the user's parts differ is not known.
    config["parts"] |= {name: 0.0 for name in paper["parts"] if name != "seed"}
    config["claims"], config["uncertainty"]["claims"] = {}, []
    drop_other_methods(config, overlay)
    # With the paper's motion normal to the track, the tables of that motion stay as they are.
    if without_tangential(own) != without_tangential(paper["model"]):
        del config["orbits"]["seeds"]
        for entry in config["regressions"].values():
            del entry["acceleration"], entry["paper"]
    drop_figures(config, overlay)
    return config


def describe_scaling(paper: dict, config: dict) -> str:
    """What was scaled to another conveyor, by which factors, and what was dropped, on one line."""
    ratios = scale_ratios(paper["model"], config["model"])
    factors = {name: ratios[unit] for name, unit in SCALED.items()}
    factors["time steps of fixed-step methods"] = scaled_step(paper, config["model"]) / paper["solver"]["step"]
    changed = [f"{name} × {factor:.4g}" for name, factor in factors.items() if abs(factor - 1.0) > 1e-9]
    kept = [name for name, factor in factors.items() if abs(factor - 1.0) <= 1e-9]
    kept += ["lengths of track and parts", "longest time of transit"]
    scaled = f"Scaled, except for values that your config gives itself: {', '.join(changed)}. " if changed else ""
    figures = [name for name in paper["figures"] if name not in config["figures"]]
    dropped = [
        *([] if config["claims"] else ["the paper's claims"]),
        *(["figures " + ", ".join(figures)] if figures else []),
        "marks of the paper in figures",
        "tables of the paper's method that your config does not name",
        *([] if "seeds" in config["orbits"] else ["the paper's first orbits and the interval of its fit"]),
        *([] if any(value for name, value in config["parts"].items() if name != "seed") else ["differences of parts"]),
    ]
    unscaled = f"Not scaled: {', '.join(kept)}. "
    return f"{config['prefix']} is a conveyor other than the paper's. {scaled}{unscaled}Dropped: {'; '.join(dropped)}."
