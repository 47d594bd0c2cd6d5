"""Calibrations of random conveyors whose contact is known: the intervals contain it, and the model is not rejected."""

import math

import numpy as np
import pytest
from project import si_config
from synthetic import csv_text, measure

from conveyor.analysis.dimensionless_groups import contact_of_groups
from conveyor_pipeline.common import grid
from conveyor_pipeline.config.tables import settings_of
from conveyor_pipeline.machine.calibration.calibrate import make

PARAMETERS = ("friction", "damping", "stiffness")
# Ranges of the random conveyors; all but angle and friction on a logarithmic scale.
FREQUENCY, ANGLE, MASS = (15.0, 150.0), (0.17, 0.61), (1e-4, 0.2)  # Hz, rad, kg
FRICTION, LOSS, GROUP = (0.1, 0.6), (0.06, 0.8), (4.0, 1800.0)
THROW_NUMBER = (0.8, 3.5)  # a_z/g of the lowest and of the highest amplitude
AMPLITUDES, PARTS, DURATION, NOISE = 10, 3, 0.5, 0.02


def log_uniform(ends, random):
    return math.exp(random.uniform(*np.log(ends)))


def calibrate_random_conveyor(seed):
    """Whether each interval contains the true value, by the parameter, for a conveyor whose model is not rejected."""
    random = np.random.default_rng([48, seed])
    config = si_config()
    settings = settings_of(config, "calibration/parameters") | {"measurements": "mine.csv"}
    model = {name: value for name, value in settings["model"].items() if name != "static_friction"}
    ratio = 1.0 / model["frequency"]
    model["frequency"], model["angle"] = log_uniform(FREQUENCY, random), random.uniform(*ANGLE)
    ratio *= model["frequency"]
    true = {"friction": random.uniform(*FRICTION)}
    model["mass"] = log_uniform(MASS, random)
    group, loss = log_uniform(GROUP, random), log_uniform(LOSS, random)
    contact = contact_of_groups(group, loss, grid.row_of(model))
    true |= {name: float(value) for name, value in zip(("stiffness", "damping"), contact, strict=True)}
    # Initial conditions in the same multiples of g/ω² and g/ω as on the paper's conveyor.
    box = {
        "height": [end / ratio**2 for end in settings["height"]],
        "vz0": [end / ratio for end in settings["vz0"]],
        "psi0": settings["psi0"],
    }
    low, high = (end * model["gravity"] / math.sin(model["angle"]) for end in THROW_NUMBER)
    amplitudes = np.repeat(np.linspace(low, high, AMPLITUDES), PARTS)
    rows = measure(model | true, amplitudes, box, NOISE, random, duration=DURATION)
    text = csv_text(rows, "synthetic", duration=DURATION, before=DURATION)
    tables = make(text, settings | box | {"model": model}, threads=2)
    assert all(tables["fit"]["explained"])
    found = tables["parameters"]
    intervals = zip(*(found[key] for key in ("parameter", "low", "high")), strict=True)
    return {name: least <= true[name] <= most for name, least, most in intervals}


@pytest.mark.long
def test_the_intervals_contain_the_true_values():
    """More than two of nine 95 % intervals miss the true value in less than one of a hundred cases."""
    contained = [inside for seed in range(3) for inside in calibrate_random_conveyor(seed).values()]
    assert len(contained) == 9
    assert sum(contained) >= 7
