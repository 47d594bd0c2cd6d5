"""The motions of several conveyors over the throw number, to compare them with the textbook theory.

The conveyors come from the config and from the examples. Initial heights fill the same box in units of g cos α/ω²
(initial velocities: g cos α/ω).
"""

import numpy as np
import pandas as pd

from conveyor import throw_number, throw_velocity
from conveyor.parameters import normal_gravity
from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.operating import shares

FOLLOWED = 4  # initial conditions per attractor from which its mean velocity is computed
TABLES = {
    "throws": (
        fields.text("conveyor", "paper, or the name of the example"),
        *shares.TABLES["shares"],
        fields.number("textbook", "m/s", "velocity by the textbook theory; null beyond its range"),
    )
}


def settings_of_conveyor(settings: dict, model: dict) -> dict:
    """The settings of `shares` for a conveyor with the parameters `model`; the config has the others."""
    base = settings["model"]
    conveyor_model = base | model
    gravity = normal_gravity(conveyor_model) / normal_gravity(base)
    period = base["frequency"] / conveyor_model["frequency"]
    speed = gravity * period
    box = {
        "height": [speed * period * end for end in settings["height"]],
        "vz0": [speed * end for end in settings["vz0"]],
    }
    return {**settings, **box, "model": conveyor_model}


def make(models: dict[str, dict], settings: dict, *, threads: int = 1, progress: str | None = None) -> pd.DataFrame:
    """The shares at each throw number, for the conveyors of the config and of the examples (`models`, by name)."""
    conveyors = {"paper": {}} | models
    throws = np.linspace(**settings["throw_number"])
    tables = []
    for name, model in conveyors.items():
        conveyor_settings = settings_of_conveyor(settings, model)
        amplitudes = throws / throw_number(1.0, **conveyor_settings["model"])
        label = progress and f"{progress}: {name}"
        table = shares.shares_at(amplitudes, conveyor_settings, followed=FOLLOWED, threads=threads, progress=label)
        textbook = throw_velocity(table.acceleration, **conveyor_settings["model"])
        tables.append(table.assign(conveyor=name, textbook=textbook))
    return pd.concat(tables, ignore_index=True)
