"""Settings of the stage calibration: parameters from measured velocities."""

from typing import NotRequired

from typing_extensions import TypedDict

from conveyor.parameters import DESCRIPTIONS, INITIAL_CONDITION
from conveyor_pipeline.common.settings import (
    MODEL_TYPES,
    Line,
    Seed,
    described,
    interval,
    list_of,
    mapping,
    number,
    word,
)
from conveyor_pipeline.common.table_settings import model_of
from conveyor_pipeline.machine.calibration.measurements import CALIBRATED
from conveyor_pipeline.machine.operating.settings import box_of

POSITIVE_GROUPS = ("friction", "damping", "stiffness", "exponent")
RANGES_OF_CALIBRATION = {
    name: interval(
        number(name, "1", gt=0) if name in POSITIVE_GROUPS else MODEL_TYPES[name],
        f"searched range of {DESCRIPTIONS[name]}",
    )
    for name in CALIBRATED
}


class Calibration(TypedDict):
    measurements: NotRequired[described(Line, "CSV file of measured velocities, relative to this overlay")]
    parameters: list_of(word("parameter that is searched", *CALIBRATED), "parameters that are searched")
    alternatives: mapping(
        "largest difference from the stated value that is searched in addition",
        {
            "inclination": number(DESCRIPTIONS["inclination"], "rad", gt=0, le=0.5),
            "phase_shift": number(DESCRIPTIONS["phase_shift"], "rad", gt=0, le=3.15),
        },
    )
    ranges: mapping("range of each parameter, in dimensionless groups", RANGES_OF_CALIBRATION)
    noise: number("relative standard deviation of a velocity without its own", "of the velocity", ge=0, lt=1)
    effort: number("factor of all numbers of samples; below 1: a trial", ge=0.05, le=100)
    seed: Seed


SECTIONS = {
    "calibration": described(Calibration, "parameters from measured velocities"),
}
CALIBRATION_TABLES = ("parameters", "samples", "fit", "alternatives", "prediction", "next")


def calibration_settings(config: dict) -> dict:
    """The search leaves the values of the searched parameters in the model open. The static friction stays as stated
    and limits the friction; 0 stands for none. A config to which calibrated parameters are added has the same settings.
    """
    section = config["calibration"]
    static_friction = config["model"].get("static_friction", 0.0)
    ranges = {name: section["ranges"][name] for name in section["parameters"]}
    if static_friction and "friction" in ranges:
        ranges["friction"] = [ranges["friction"][0], min(ranges["friction"][1], static_friction)]
    stated = (*INITIAL_CONDITION, "static_friction", *section["parameters"])
    model = model_of(config, without=stated)
    return {**box_of(config), **section, "ranges": ranges, "static_friction": static_friction, "model": model}


TABLE_SETTINGS = {
    **dict.fromkeys((f"calibration/{name}" for name in CALIBRATION_TABLES), calibration_settings),
}
MEASURED_FILES = {"calibration": "measurements"}
