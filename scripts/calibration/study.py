"""Simulation study of the calibration: data sets with known parameters, and whether the calibration finds them.

Conveyors are random. `rich` sets have several parts at each of many amplitudes, `poor` ones a few velocities. In the
other sets, the conveyor differs in one point from the model of the calibration.
"""

import json
import math

import numpy as np
import pandas as pd

from calibration import prediction
from calibration.calibrate import calibrate
from calibration.measurements import parse
from calibration.synthetic import csv_text, measure, true_velocity
from conveyor.analysis.contact_groups import contact_of_groups
from conveyor.parameters import RANGES
from pipeline import grid

PARAMETERS = ("friction", "damping", "stiffness")


def log_uniform(low: float, high: float, random: np.random.Generator) -> float:
    return math.exp(random.uniform(math.log(low), math.log(high)))


def random_conveyor(settings: dict, random: np.random.Generator) -> tuple[dict, dict]:
    """A model, and the box of initial conditions in the same multiples of g/ω² and g/ω as in the config."""
    ranges = settings["conveyors"]
    model = settings["model"] | {
        "frequency": log_uniform(*ranges["frequency"], random),
        "angle": random.uniform(*ranges["angle"]),
        "mass": log_uniform(*ranges["mass"], random),
        "friction": random.uniform(*ranges["friction"]),
    }
    group, loss = log_uniform(*ranges["stiffness"], random), log_uniform(*ranges["damping"], random)
    stiffness, damping = contact_of_groups(group, loss, grid.packed(model))
    ratio = settings["model"]["frequency"] / model["frequency"]
    box = {
        "height": [ratio**2 * end for end in settings["height"]],
        "vz0": [ratio * end for end in settings["vz0"]],
        "psi0": settings["psi0"],
    }
    return model | {"stiffness": float(stiffness), "damping": float(damping)}, box


def measured_conveyor(kind: str, stated: dict, settings: dict) -> tuple[dict, float]:
    """The measured conveyor of a data set, and the factor of its stated amplitudes, for a conveyor as it is stated."""
    wrong = settings["wrong"]
    if kind == "effective_value":
        return stated, math.sqrt(0.5)
    if kind == "exponent":
        # A contact with another exponent, with the same force at the penetration of the static load times ten.
        static = 10.0 * (stated["mass"] * stated["gravity"] / stated["stiffness"]) ** (1.0 / stated["exponent"])
        stiffness = stated["stiffness"] * static ** (stated["exponent"] - wrong["exponent"])
        return stated | {"exponent": wrong["exponent"], "stiffness": stiffness}, 1.0
    return (stated | {kind: wrong[kind]} if kind in wrong else stated), 1.0


def make(settings: dict, kind: str, number: int, *, threads: int = 1, progress: str | None = None) -> str:
    """The row of one data set, as JSON."""
    random = np.random.default_rng([settings["seed"], number])
    stated, box = random_conveyor(settings, random)
    real, factor = measured_conveyor(kind, stated, settings)
    scale = stated["gravity"] / math.sin(stated["angle"])
    least, most = (scale * end for end in settings["throw_number"])
    if kind == "poor":
        amplitudes = np.sort(random.uniform(least, most, settings["poor"]))
    else:
        amplitudes = np.repeat(np.linspace(least, most, settings["amplitudes"]), settings["parts_of_study"])
    amplitudes = amplitudes.round(3)
    lasts = settings["duration"]
    rows = measure(real, amplitudes, box, settings["calibration"]["noise"], random, duration=lasts)
    pairs = [(factor * acceleration, velocity) for acceleration, velocity in rows]
    text = csv_text(pairs, "synthetic", duration=lasts, before=lasts)
    model = {name: value for name, value in stated.items() if name not in PARAMETERS}
    own = settings["calibration"] | settings["band"] | box | {"model": model, "static_ratio": 1.0}
    found = calibrate(parse(text, "synthetic", own, RANGES), own, threads=threads, progress=progress)
    samples, fit = (pd.DataFrame(found[name]) for name in ("samples", "fit"))
    band = prediction.make(samples, fit, own, threads=threads, progress=progress)["prediction"]
    held = random.uniform(amplitudes[0], amplitudes[-1], settings["held_out"])
    velocity = np.array([true_velocity(real, one, box, random) for one in held])
    low, high = (np.interp(factor * held, band["acceleration"], band[name]) for name in ("low", "high"))
    row = {name: stated[name] for name in ("frequency", "angle", "mass")}
    row |= {"number": number, "kind": kind, "measurements": len(rows)}
    for name, best, below, above in zip(
        *(found["parameters"][key] for key in ("parameter", "best", "low", "high")), strict=True
    ):
        row |= {name: real[name], f"{name}_best": best, f"{name}_low": below, f"{name}_high": above}
    gains = zip(*(found["alternatives"][key] for key in ("log_bayes_factor", "parameter")), strict=True)
    row["log_bayes_factor"], row["alternative"] = max(gains, default=(-math.inf, ""))
    row |= {"in_band": float(np.mean((low <= velocity) & (velocity <= high)))}
    row |= {"p_value": float(fit.p_value.iloc[0]), "effective": found["parameters"]["effective"][0]}
    return json.dumps(row)
