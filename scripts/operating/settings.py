"""Settings of the stage operating: where to run a conveyor, with units and ranges."""

from functools import partial
from operator import itemgetter
from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..conveyor import DESCRIPTIONS, UNITS
from ..pipeline.settings import (
    MODEL_TYPES,
    Acceleration,
    Accelerations,
    Effort,
    Seed,
    Tolerance,
    Velocity,
    interval,
    mapping,
    number,
    span,
    whole,
)
from ..pipeline.table_settings import model_of

Resolution = number("width to which a bracket is halved", "m/s²", gt=0, le=1e4)


class Operating(TypedDict):
    acceleration: Accelerations
    resolution: Resolution
    height: interval(number("height above the plate", "m", ge=0, le=10), "initial heights", point=True)
    vz0: interval(Velocity, "initial velocities", point=True)
    psi0: interval(MODEL_TYPES["psi0"], "phases of the excitation", point=True)
    starts: whole("random initial conditions per amplitude", 16, 10**6)
    seed: Seed
    tolerance: Tolerance


DEVIATION = number("relative standard deviation", "of the value in the model", ge=0, le=1)


class Parts(TypedDict):
    friction: DEVIATION
    damping: DEVIATION
    stiffness: DEVIATION
    mass: DEVIATION
    acceleration: DEVIATION
    calibrated: NotRequired[
        Annotated[
            bool, Field(description="draw friction, damping and stiffness from the samples of the calibration, too")
        ]
    ]
    seed: Seed


class Transit(TypedDict):
    acceleration: Accelerations
    length: number("length of the track", "m", scaled=False, ge=1e-3, le=1e4)
    longest: number("time after which a part is late", "s", scaled=False, gt=0, le=1e5)
    parts: whole("parts with random initial conditions per amplitude", 8, 10**6)


class Advice(TypedDict):
    margin: number("relative error of the amplitude within which the advice must hold", gt=0, lt=1)
    changes: mapping(
        "changes of single parameters, up and down",
        {
            name: number(f"change of {name}", UNITS[name], gt=0)
            for name in ("angle", "frequency", "friction", "inclination", "phase_shift")
        },
    )
    part_length: NotRequired[number("length of a part in the feeding direction", "m", scaled=False, gt=0, le=10)]


class Throws(TypedDict):
    throw_number: span(number("throw number a_z/(g cos α)", gt=0, le=100), "throw numbers")
    starts: whole("random initial conditions per throw number", 16, 10**6)


class Track(TypedDict):
    acceleration: Acceleration
    inclination: span(MODEL_TYPES["inclination"], "inclinations of the track")
    phase_shift: span(MODEL_TYPES["phase_shift"], "phase shifts of the drive")
    starts: whole("random initial conditions per inclination", 2, 10**6)


class DriveSearch(TypedDict):
    parts: whole("parts per design", 8, 10**6)
    longest: number("time for which a part is followed", "s", gt=0, le=1e5)


class DriveBounds(TypedDict):
    acceleration: interval(MODEL_TYPES["acceleration"], DESCRIPTIONS["acceleration"])
    frequency: interval(MODEL_TYPES["frequency"], DESCRIPTIONS["frequency"])
    angle: interval(MODEL_TYPES["angle"], DESCRIPTIONS["angle"])
    phase_shift: interval(MODEL_TYPES["phase_shift"], DESCRIPTIONS["phase_shift"])
    harmonic_share: NotRequired[
        interval(number("share of a second harmonic", ge=0, le=2), "share of a second harmonic, with harmonic_phase")
    ]
    harmonic_phase: NotRequired[
        interval(number("phase of the second harmonic", "rad", ge=-6.2832, le=6.2832), "phase, with harmonic_share")
    ]


class Drive(TypedDict):
    bounds: Annotated[DriveBounds, Field(description="search interval of each parameter")]
    displacement: number("largest amplitude of the drive's displacement, â/ω²", "m", gt=0, le=1)
    velocity: number("least useful velocity of the slowest 5 % of the parts", "m/s", gt=0, le=100)
    impact_speed: number("largest impact speed that a design may have", "m/s", gt=0, le=100)
    back: number("largest share of the parts that may move back", ge=0, lt=1)
    search: Annotated[DriveSearch, Field(description="parts of each design of the search")]
    population: whole("population of NSGA-II", 4, 10**4)
    generations: whole("generations of NSGA-II", 4, 10**5)


SECTIONS = {
    "operating": Annotated[Operating, Field(description="shares of the attractors over the amplitude")],
    "parts": Annotated[Parts, Field(description="how parts differ")],
    "transit": Annotated[Transit, Field(description="velocities of parts along a track over the amplitude")],
    "drift": mapping("drift and diffusion in chaos, and the spread over the track's length", {"effort": Effort}),
    "advice": Annotated[Advice, Field(description="advice on where to run the conveyor")],
    "track": Annotated[Track, Field(description="velocity over inclination and phase shift")],
    "throws": Annotated[Throws, Field(description="comparison with the textbook theory of throw conveyors")],
    "drive": Annotated[Drive, Field(description="search for the settings of the drive")],
}


def box_settings(section: str, config: dict) -> dict:
    """A section whose initial conditions are drawn from the box of the section `operating`."""
    box = {key: value for key, value in config["operating"].items() if key not in ("acceleration", "resolution")}
    limits = {key: config["solver"][key] for key in ("settling", "mean_settling")}
    own = {**box, **config[section], **limits}
    stated = ("psi0", "z0", "vz0", *config[section], *own.get("bounds", ()))
    return {**own, "model": {name: value for name, value in model_of(config).items() if name not in stated}}


def transit_settings(config: dict) -> dict:
    """The box of `operating`, the section `transit`, and how its parts differ."""
    box = {name: config["operating"][name] for name in ("height", "vz0", "psi0", "seed", "tolerance")}
    transit = {name: value for name, value in config["transit"].items() if name != "parts"}
    model = {name: value for name, value in model_of(config).items() if name not in ("psi0", "z0", "vz0")}
    return {**box, **transit, "starts": config["transit"]["parts"], "spread": config["parts"], "model": model}


def drift_settings(config: dict) -> dict:
    """The parts of the transit table without their differences."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "spread"}
    return {**transit, **config["drift"]}


def drive_settings(config: dict) -> dict:
    """The search follows the parts of the transit table, within the error of the amplitude that the advice states."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "acceleration"}
    drive = config["drive"]
    model = {name: value for name, value in transit["model"].items() if name not in drive["bounds"]}
    return {**transit, **drive, "margin": config["advice"]["margin"], "model": model}


# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {
    **dict.fromkeys(("operating/shares", "operating/regimes"), partial(box_settings, "operating")),
    "operating/transit": transit_settings,
    **dict.fromkeys(("operating/drift", "operating/track_lengths"), drift_settings),
    **dict.fromkeys(("operating/advice", "operating/changes"), itemgetter("advice")),
    "operating/throws": partial(box_settings, "throws"),
    "operating/track": partial(box_settings, "track"),
    **dict.fromkeys(
        ("operating/drive_front", "operating/drive_generations", "operating/second_harmonic"), drive_settings
    ),
}
