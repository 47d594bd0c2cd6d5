"""The paper's config, brought to another machine: an overlay with a prefix and a model makes the same figures for it.

Every axis, height, velocity and time keeps its value in the machine's own scales. What follows from the paper's numbers
is left out: its statements, marks and fits, the orbits to begin with, and its method beside the converged solution.
What an overlay names itself is left as it says, and comes back if it was left out.
"""

import math
from collections.abc import Callable

from workflow.config_files import merged
from workflow.config_model import MODEL
from workflow.configuration import type_problems
from workflow.tables_of_config import METHODS

# Parameters that make a machine; the others of the model say how it runs.
MACHINE = ("angle", "frequency", "stiffness", "damping", "friction", "mass", "exponent", "gravity")
FIGURES = ("figures", "figures_on_request")
# Settings of figures that mark a number of the paper.
MARKS = ("critical_acceleration", "critical_height", "first_positive", "two_states")
DIGITS = 4  # of scaled amplitudes, heights and velocities: they stand on axes and in titles
# Of the paper's steps in an excitation cycle, so that a portrait's samples lie on steps.
STEPS = 4000


def mapping(value) -> dict:
    """The value, or nothing if an overlay has something else in its place: that is told elsewhere."""
    return value if isinstance(value, dict) else {}


def is_own(paper: dict, overlay: dict) -> bool:
    """Whether an overlay has a prefix and a machine that is not the paper's."""
    model = mapping(overlay.get("model"))
    return bool(overlay.get("prefix")) and any(
        model.get(name, paper["model"][name]) != paper["model"][name] for name in MACHINE
    )


def ratios(paper: dict, own: dict) -> dict[str, float]:
    """By what numbers of each unit are multiplied, from the paper's model to another one.

    The amplitude at which the plate's vertical acceleration is that of gravity, g / sin φ; the height g/ω²; the
    velocity g/ω; the period of the excitation.
    """
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


def scale(ratio: float, digits: int | None = None) -> Callable[[float], float]:
    """A function that multiplies by a ratio and, where that is not one, rounds to so many digits."""

    def scaled(value: float) -> float:
        if ratio == 1.0:
            return value
        return value * ratio if digits is None else float(f"{value * ratio:.{digits}g}")

    return scaled


def contact_time(model: dict) -> float:
    """Time scale of the contact of a part at rest (s), by which a step is chosen."""
    p = model["exponent"]
    weight = model["mass"] * model["gravity"]
    return math.sqrt(model["mass"] / (p * model["stiffness"] ** (1.0 / p) * weight ** (1.0 - 1.0 / p)))


def step_of(paper: dict, own: dict) -> float:
    """The step of fixed-step methods (s): the paper's in units of the time of a contact, or a little shorter."""
    step = paper["solver"]["step"] * contact_time(own) / contact_time(paper["model"])
    return 1.0 / (own["frequency"] * STEPS * math.ceil(1.0 / (own["frequency"] * STEPS * step) - 1e-9))


def without_twins(config: dict, overlay: dict) -> set[str]:
    """Leave out what another method than the converged one computes, unless the overlay or a figure of it asks for it.

    Returns the tables that are left out.
    """
    named = [config[of].get(name, {}) for of in FIGURES for name in mapping(overlay.get(of))]
    needed = {reference for entry in named if "paper_only" in entry for reference in entry["tables"].values()}
    gone = set()
    for section in (*METHODS, "dimensions"):
        asked = mapping(overlay.get(section))
        for name, entry in list(config[section].items()):
            own = mapping(asked.get(name))
            twin = f"{section}/{name}_euler"
            if "methods" in entry and "methods" not in own and twin not in needed:
                entry["method"] = entry.pop("methods")[0]
                gone.add(twin)
            elif entry.get("method", "event") != "event" and name not in asked and f"{section}/{name}" not in needed:
                del config[section][name]
                gone.add(f"{section}/{name}")
    for name, entry in list(config["regressions"].items()):
        if f"critical/{entry['critical']}" in gone and name not in mapping(overlay.get("regressions")):
            del config["regressions"][name]
            gone.add(f"regressions/{name}")
    return gone


def model_problems(paper: dict, overlay: dict) -> list[str]:
    """What is wrong with the machine of an overlay, one line each."""
    config = merged(paper, {"model": overlay["model"]})
    if errors := type_problems(config):
        return errors
    if math.sin(config["model"]["angle"]) == 0.0:
        return ["model.angle = 0.0 moves the plate to and fro only: no amplitude lifts a part; give a larger one"]
    return []


def fitted(paper: dict, overlay: dict) -> dict:
    """The paper's config for the machine of an overlay, which is to be merged over it."""
    own = {**paper["model"], **{name: float(value) for name, value in overlay["model"].items() if name in MACHINE}}
    rounded = ("m/s²", "m", "m/s", "m²/s²")
    scales = {
        unit: scale(ratio, DIGITS if unit in rounded else None) for unit, ratio in ratios(paper["model"], own).items()
    }
    config = MODEL.validate_python(paper, context=scales)
    config["model"] |= {name: own[name] for name in MACHINE}
    if own != paper["model"]:
        config["solver"]["step"] = step_of(paper, own)
    for entry in config["estimates"].values():
        unit = {"z0": "m", "vz0": "m/s"}.get(entry["perturb"])
        entry["epsilon"] = scales[unit](entry["epsilon"]) if unit else entry["epsilon"]

    gone = without_twins(config, overlay)
    del config["orbits"]["seeds"]
    for entry in config["regressions"].values():
        del entry["acceleration"], entry["paper"]
    config["claims"], config["uncertainty"]["claims"] = {}, []
    for section in FIGURES:
        asked = mapping(overlay.get(section))
        for name, entry in list(config[section].items()):
            if "paper_only" in entry and name not in asked:
                del config[section][name]
            else:
                without_the_papers(entry, gone)
    return config


def without_the_papers(figure: dict, gone: set[str]) -> None:
    """Leave out of a figure the tables that there are not, and the marks of the paper's numbers."""
    for key in ("tables", "caption_tables"):
        if key in figure:
            figure[key] = {role: reference for role, reference in figure[key].items() if reference not in gone}
    if "settings" in figure:
        figure["settings"] = {key: value for key, value in figure["settings"].items() if key not in MARKS}


def refusals(paper: dict, config: dict) -> dict[str, str]:
    """Figures of the paper's config that another one does not have, and why."""
    return {
        name: entry["paper_only"]
        for section in FIGURES
        for name, entry in paper[section].items()
        if "paper_only" in entry and name not in config[section]
    }
