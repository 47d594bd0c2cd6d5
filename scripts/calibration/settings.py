"""Settings of the stage calibration: parameters from measured velocities, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..conveyor import DESCRIPTIONS
from ..pipeline.settings import MODEL_TYPES, Line, Seed, interval, many, mapping, number, word
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
