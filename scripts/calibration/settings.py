"""Settings of the stage calibration: parameters from measured velocities, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..conveyor import DESCRIPTIONS
from ..pipeline.settings import MODEL_TYPES, Line, Seed, interval, many, mapping, number, word
from ..pipeline.table_settings import model_of
from .measurements import CALIBRATED

POSITIVE_GROUPS = ("friction", "damping", "stiffness", "exponent")
RANGES_OF_CALIBRATION = {
    name: interval(
        number(name, "1", gt=0) if name in POSITIVE_GROUPS else MODEL_TYPES[name],
        f"searched range of {DESCRIPTIONS[name]}",
    )
    for name in CALIBRATED
}


class Calibration(TypedDict):
    measurements: NotRequired[
        Annotated[Line, Field(description="CSV file of measured velocities, relative to this overlay")]
    ]
    parameters: many(word("parameter that is searched", *CALIBRATED), "parameters that are searched")
    alternatives: mapping(
        "largest difference from the stated value that is searched in addition",
        {
            "inclination": number(DESCRIPTIONS["inclination"], "rad", gt=0, le=0.5),
            "phase_shift": number(DESCRIPTIONS["phase_shift"], "rad", gt=0, le=3.15),
        },
    )
    ranges: mapping("range of each parameter, in dimensionless groups", RANGES_OF_CALIBRATION)
    noise: number("relative standard deviation of a velocity without its own", ge=0, lt=1)
    effort: number("factor of all numbers of samples; below 1: a quick trial", ge=0.05, le=100)
    seed: Seed


SECTIONS = {
    "calibration": Annotated[Calibration, Field(description="parameters from measured velocities")],
}


def calibration_settings(config: dict) -> dict:
    """The search leaves the values of the searched parameters in the model open. The static friction stays as stated
    and limits the friction; 0 stands for none. A config to which calibrated parameters are added has the same settings.
    """
    own, model = config["calibration"], model_of(config)
    static_friction = model.get("static_friction", 0.0)
    ranges = {name: own["ranges"][name] for name in own["parameters"]}
    if static_friction and "friction" in ranges:
        ranges["friction"] = [ranges["friction"][0], min(ranges["friction"][1], static_friction)]
    stated = ("psi0", "z0", "vz0", "static_friction", *own["parameters"])
    return {
        **{name: config["operating"][name] for name in ("height", "vz0", "psi0")},
        **own,
        "ranges": ranges,
        "static_friction": static_friction,
        "model": {name: value for name, value in model.items() if name not in stated},
    }


def calibration_study_settings(config: dict) -> dict:
    """The study calibrates with the settings of the config, without its conveyor and its measurements."""
    own = {name: value for name, value in calibration_settings(config).items() if name not in ("measurements", "model")}
    own["ranges"] = {name: config["calibration"]["ranges"][name] for name in ("friction", "damping", "stiffness")}
    own["parameters"] = list(own["ranges"])
    box = {name: config["operating"][name] for name in ("height", "vz0", "psi0")}
    model = {
        name: value for name, value in model_of(config).items() if name not in ("z0", "static_friction", "psi0", "vz0")
    }
    return {**box, "calibration": own, "model": model}


# The tables that are not entries, and the function that returns the settings of each.
CALIBRATION_TABLES = ("parameters", "samples", "fit", "alternatives", "prediction", "next")
TABLE_SETTINGS = {
    **dict.fromkeys((f"calibration/{name}" for name in CALIBRATION_TABLES), calibration_settings),
    "results/calibration_study": calibration_study_settings,
}
# Tables that only an explicit target makes.
ON_REQUEST = (*TABLE_SETTINGS,)
