"""Simulation study of the calibration: data sets with known parameters, and whether the calibration finds them.

Conveyors are random. `rich` sets have several parts at each of many amplitudes, `poor` ones a few velocities. In the
other sets, the conveyor differs in one point from the model of the calibration.

Where intervals are wide, the calibration may be poor, or the measurements may leave the parameters open. The likelihood
from so many parts that it needs no smoothing tells one from the other. Where a wrong model is not noticed, the evidence
of the true one says whether any test could have noticed it.
"""

import json
import math

import numpy as np
import pandas as pd

from calibration import prediction
from calibration.calibrate import calibrate
from calibration.effort import HELD_OUT, sizes_of
from calibration.inference import Data, data_of, search
from calibration.likelihood import log_densities, velocities
from calibration.measurements import parse
from calibration.synthetic import csv_text, measure, true_velocity
from conveyor import RANGES, contact_of_groups
from pipeline import grid

PARAMETERS = ("friction", "damping", "stiffness")
RIGHT = ("rich", "poor")  # kinds of data sets whose model is right
# Ranges of the random conveyors; all but angle and friction on a logarithmic scale.
CONVEYORS = {
    "frequency": (15.0, 150.0),  # Hz
    "angle": (0.17, 0.61),  # rad: 10° to 35°
    "mass": (1e-4, 0.2),  # kg
    "friction": (0.1, 0.6),
    "damping": (0.06, 0.8),  # the group L, coefficient of restitution from 0.93 to 0.35 in an impact at 10 g/ω
    "stiffness": (4.0, 1800.0),  # the group K, natural frequency of a part at rest from 2 to 15 times that of the drive
}
THROW_NUMBER = (0.8, 3.5)  # a_z/g of the lowest and of the highest amplitude
AMPLITUDES, PARTS = 10, 3  # of a rich set: amplitudes, and parts at each of them
POOR = 5  # velocities of a poor set, at random amplitudes
DURATION = 0.5  # s over which the velocity of a part is measured, and time on the track before
BAND = {"amplitudes": 49, "predicted": 48}  # in place of the sizes of a calibration: a study needs no next measurement
# What the calibration is not told: rad, rad, and a Hooke contact instead of a Hertz contact.
WRONG = {"phase_shift": 0.8, "inclination": 0.06, "exponent": 1.0}
SEED = 48
NARROW = 0.2  # half of an interval, relative to the best value
# Samples of the posterior that are compared with the true parameters, and parts for their likelihoods.
COMPARED, MANY = 16, 2048


def log_uniform(low: float, high: float, random: np.random.Generator) -> float:
    return math.exp(random.uniform(math.log(low), math.log(high)))


def random_conveyor(settings: dict, random: np.random.Generator) -> tuple[dict, dict]:
    """A model, and the box of initial conditions in the same multiples of g/ω² and g/ω as in the config."""
    model = settings["model"] | {
        "frequency": log_uniform(*CONVEYORS["frequency"], random),
        "angle": random.uniform(*CONVEYORS["angle"]),
        "mass": log_uniform(*CONVEYORS["mass"], random),
        "friction": random.uniform(*CONVEYORS["friction"]),
    }
    group, loss = log_uniform(*CONVEYORS["stiffness"], random), log_uniform(*CONVEYORS["damping"], random)
    stiffness, damping = contact_of_groups(group, loss, grid.row_of(model))
    ratio = settings["model"]["frequency"] / model["frequency"]
    box = {
        "height": [ratio**2 * end for end in settings["height"]],
        "vz0": [ratio * end for end in settings["vz0"]],
        "psi0": settings["psi0"],
    }
    return model | {"stiffness": float(stiffness), "damping": float(damping)}, box


def measured_conveyor(kind: str, stated: dict) -> tuple[dict, float]:
    """The measured conveyor of a data set, and the factor of its stated amplitudes, for a conveyor as it is stated."""
    if kind == "effective_value":
        return stated, math.sqrt(0.5)
    if kind == "exponent":
        # A contact with another exponent, with the same force at the penetration of the static load times ten.
        static = 10.0 * (stated["mass"] * stated["gravity"] / stated["stiffness"]) ** (1.0 / stated["exponent"])
        stiffness = stated["stiffness"] * static ** (stated["exponent"] - WRONG["exponent"])
        return stated | {"exponent": WRONG["exponent"], "stiffness": stiffness}, 1.0
    return (stated | {kind: WRONG[kind]} if kind in WRONG else stated), 1.0


def gain_of_distant(samples: pd.DataFrame, best: dict, true: dict, data: Data, settings: dict, threads: int) -> float:
    """The largest logarithmic likelihood of distant samples of the posterior, minus that of the true parameters.

    Distant are samples whose friction or damping differs from the best value by more than NARROW; NaN if none does.
    """
    far = np.any([np.abs(samples[name] / best[name] - 1.0) > NARROW for name in ("friction", "damping")], axis=0)
    distant = samples[far]
    if distant.empty:
        return math.nan
    chosen = distant.iloc[np.linspace(0, len(distant) - 1, COMPARED).round().astype(int)]
    values = {name: np.append(true[name], chosen[name]) for name in PARAMETERS}
    simulated = velocities(values, data.conditions, settings, parts=MANY, seed=settings["seed"], threads=threads)
    arguments = (data.velocity, simulated[:, data.of], data.sd, data.plate, settings["noise"])
    of_true, *others = log_densities(*arguments, spread=np.zeros(())).sum(axis=1)
    return float(max(others) - of_true)


def make(settings: dict, kind: str, number: int, *, threads: int = 1, progress: str | None = None) -> str:
    """The row of one data set, as JSON."""
    random = np.random.default_rng([SEED, number])
    stated, box = random_conveyor(settings, random)
    real, factor = measured_conveyor(kind, stated)
    scale = stated["gravity"] / math.sin(stated["angle"])
    least, most = (scale * end for end in THROW_NUMBER)
    if kind == "poor":
        amplitudes = np.sort(random.uniform(least, most, POOR))
    else:
        amplitudes = np.repeat(np.linspace(least, most, AMPLITUDES), PARTS)
    amplitudes = amplitudes.round(3)
    sizes = sizes_of(settings["calibration"]["effort"])
    rows = measure(real, amplitudes, box, settings["calibration"]["noise"], random, duration=DURATION)

    def as_stated(conveyor: dict, scale: float) -> tuple[list, dict]:
        """The measurements and the settings if a conveyor, and amplitudes times `scale`, are stated."""
        model = {name: value for name, value in conveyor.items() if name not in PARAMETERS}
        own = sizes | settings["calibration"] | box | {"model": model, "static_friction": 0.0}
        pairs = [(scale * acceleration, velocity) for acceleration, velocity in rows]
        return parse(csv_text(pairs, "synthetic", duration=DURATION, before=DURATION), "synthetic", own, RANGES), own

    measured, own = as_stated(stated, factor)
    tables = calibrate(measured, own, threads=threads, progress=progress)
    samples, fit = (pd.DataFrame(tables[name]) for name in ("samples", "fit"))
    band = prediction.predict(samples, fit, own | BAND, beyond=0.0, threads=threads, progress=progress)["prediction"]
    held = random.uniform(amplitudes[0], amplitudes[-1], HELD_OUT)
    velocity = np.array([true_velocity(real, one, box, random) for one in held])
    low, high = (np.interp(factor * held, band["acceleration"], band[name]) for name in ("low", "high"))
    row = {name: stated[name] for name in ("frequency", "angle", "mass")}
    row |= {"number": number, "kind": kind, "measurements": len(rows)}
    for name, best, below, above in zip(
        *(tables["parameters"][key] for key in ("parameter", "best", "low", "high")), strict=True
    ):
        row |= {name: real[name], f"{name}_best": best, f"{name}_low": below, f"{name}_high": above}
    gains = zip(*(tables["alternatives"][key] for key in ("log_bayes_factor", "parameter")), strict=True)
    row["log_bayes_factor"], row["alternative"] = max(gains, default=(-math.inf, ""))
    row |= {"in_band": float(np.mean((low <= velocity) & (velocity <= high)))}
    row |= {"p_value": float(fit.p_value.iloc[0]), "effective": tables["parameters"]["effective"][0]}
    if kind in RIGHT:
        best = {name: row[f"{name}_best"] for name in PARAMETERS}
        row["gain_of_distant"] = gain_of_distant(samples, best, real, data_of(measured, own["model"]), own, threads)
    else:
        options = {"threads": threads, "progress": progress}
        assumed, true = (
            search(data_of(rows_of, with_settings["model"]), with_settings, **options).log_evidence
            for rows_of, with_settings in ((measured, own), as_stated(real, 1.0))
        )
        row["gain_of_truth"] = true - assumed
    return json.dumps(row)
