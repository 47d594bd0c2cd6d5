"""Settings of the stage operating: where to run a conveyor, with units and ranges."""

from collections.abc import Iterable
from functools import partial
from typing import Any, NotRequired

from typing_extensions import TypedDict

from conveyor import UNITS
from conveyor.parameters import DESCRIPTIONS, INITIAL_CONDITION
from conveyor_pipeline.common.settings import (
    MODEL_TYPES,
    THROW,
    Acceleration,
    Effort,
    Seed,
    Tolerance,
    Velocity,
    axis,
    described,
    dimensionless,
    interval,
    list_of,
    mapping,
    number,
    span,
    whole,
    word,
)
from conveyor_pipeline.common.table_settings import model_of
from conveyor_pipeline.machine.operating.supply import FORCES, amplitude_range

# Largest changes that an advice may examine.
CHANGES = {"angle": 0.5, "frequency": 1e4, "friction": 1.0, "inclination": 0.5, "phase_shift": 3.15}


def change(name: str) -> Any:
    """The type of a change of a parameter."""
    return number(f"change of {name}", UNITS[name], gt=0, le=CHANGES[name])


DEVIATION = number("relative standard deviation", "of the value in the model", ge=0, le=1)


# An overlay may give some keys of {start, stop, num} in SI units.
AMPLITUDES = NotRequired[axis(Acceleration, DESCRIPTIONS["acceleration"], partial=True)]
THROWS = axis(THROW, "throw numbers")


class Operating(TypedDict):
    dimensionless: dimensionless(
        acceleration=THROWS,
        height=interval(number("height above the plate", ge=0, le=1e6), "initial heights", point=True),
        vz0=interval(number("initial velocity", ge=-1e6, le=1e6), "initial velocities", point=True),
    )
    acceleration: AMPLITUDES
    resolution: number("width to which a bracket is halved, over the amplitude", gt=0, lt=1)
    height: NotRequired[interval(number("height above the plate", "m", ge=0, le=10), "initial heights", point=True)]
    vz0: NotRequired[interval(Velocity, "initial velocities", point=True)]
    psi0: interval(MODEL_TYPES["psi0"], "phases of the excitation", point=True)
    starts: whole("random initial conditions per amplitude", 16, 10**6)
    seed: Seed
    tolerance: Tolerance


class Parts(TypedDict):
    friction: DEVIATION
    damping: DEVIATION
    stiffness: DEVIATION
    mass: DEVIATION
    acceleration: DEVIATION
    calibrated: NotRequired[
        described(bool, "draw friction, damping and stiffness from the samples of the calibration, too")
    ]
    seed: Seed


class Transit(TypedDict):
    acceleration: AMPLITUDES
    length: number("length of the track", "m", ge=1e-3, le=1e4)
    longest: number("time after which a part is late", "s", gt=0, le=1e5)
    parts: whole("parts with random initial conditions per amplitude", 8, 10**6)


class Body(TypedDict):
    length: number("length of the part along the track", "m", ge=1e-6, le=10)
    height: number("height of the part", "m", ge=1e-6, le=10)
    tilt: number("largest size of the initial angle, which is drawn uniformly", "rad", ge=0, le=1.5)


class Advice(TypedDict):
    margin: number("relative error of the amplitude within which the advice must hold", "of the amplitude", gt=0, lt=1)
    changes: mapping(
        "changes of single parameters, up and down",
        {"dimensionless": dimensionless(frequency=number("change of the frequency, over the model's", gt=0, lt=1))}
        | {name: NotRequired[change(name)] for name in ("angle", "frequency")}
        | {name: change(name) for name in ("friction", "inclination", "phase_shift")},
    )
    part_length: NotRequired[number("length of a part in the feeding direction", "m", gt=0, le=10)]


class Supply(TypedDict):
    voltage: number("relative deviation of the voltage, up and down", "of the voltage", ge=0, lt=1)
    frequency: number("deviation of the excitation frequency, up and down", "Hz", ge=0, le=1e5)
    resonance: NotRequired[number("resonance of the drive; without it, advice.margin counts", "Hz", ge=1e-2, le=1e5)]
    damping_ratio: number("damping ratio of the drive", gt=0, lt=1)
    force: word("what the force of the drive grows with", *FORCES)


class Switching(TypedDict):
    rise: number("time in which the drive reaches its amplitude, and in which it stops", "s", gt=0, le=100)
    push: list_of(number("speed of a push away from the plate", "m/s", gt=0, le=100), "pushes of a part on the plate")


class Throws(TypedDict):
    throw_number: span(number("throw number a_z/(g cos α)", gt=0, le=100), "throw numbers")
    starts: whole("random initial conditions per throw number", 16, 10**6)


class Track(TypedDict):
    dimensionless: dimensionless(acceleration=THROW)
    acceleration: NotRequired[Acceleration]
    inclination: span(MODEL_TYPES["inclination"], "inclinations of the track")
    phase_shift: span(MODEL_TYPES["phase_shift"], "phase shifts of the drive")
    starts: whole("random initial conditions per inclination", 2, 10**6)


class DriveSearch(TypedDict):
    parts: whole("parts per design", 8, 10**6)
    dimensionless: dimensionless(longest=number("time for which a part is followed", gt=0, le=1e9))
    longest: NotRequired[number("time for which a part is followed", "s", gt=0, le=1e5)]


class DriveBounds(TypedDict):
    dimensionless: dimensionless(
        acceleration=interval(THROW, "throw numbers, at the model's angle"),
        frequency=interval(number("frequency over the model's", gt=0, le=100), "frequencies"),
    )
    acceleration: NotRequired[interval(MODEL_TYPES["acceleration"], DESCRIPTIONS["acceleration"])]
    frequency: NotRequired[interval(MODEL_TYPES["frequency"], DESCRIPTIONS["frequency"])]
    angle: interval(MODEL_TYPES["angle"], DESCRIPTIONS["angle"])
    phase_shift: interval(MODEL_TYPES["phase_shift"], DESCRIPTIONS["phase_shift"])


class Drive(TypedDict):
    bounds: described(DriveBounds, "search interval of each parameter")
    displacement: number("largest displacement of the plate, â/ω² without harmonics", "m", gt=0, le=0.1)
    velocity: number("least useful velocity of the slowest 5 % of the parts", "m/s", gt=0, le=100)
    impact_speed: number("largest impact speed that a design may have", "m/s", gt=0, le=100)
    back: number("largest share of the parts that may move back", "of the parts", ge=0, lt=1)
    search: described(DriveSearch, "parts of each design of the search")
    population: whole("population of NSGA-II", 4, 10**4)
    generations: whole("generations of NSGA-II", 4, 10**5)


SECTIONS = {
    "operating": described(Operating, "shares of the attractors over the amplitude"),
    "parts": described(Parts, "how parts differ"),
    "transit": described(Transit, "velocities of parts along a track over the amplitude"),
    "body": NotRequired[described(Body, "the part as a planar rigid block; absent: a point mass")],
    "bodies": mapping("shapes of parts compared with the point mass", {"effort": Effort}),
    "drift": mapping("drift and diffusion in chaos, and the spread over the track's length", {"effort": Effort}),
    "advice": described(Advice, "advice on where to run the conveyor"),
    "supply": described(Supply, "range of the amplitude of a drive without a controller, in place of advice.margin"),
    "start": described(Switching, "switching the drive on and off"),
    "throws": described(Throws, "comparison with the textbook theory of throw conveyors"),
    "track": described(Track, "velocity over inclination and phase shift"),
    "drive": described(Drive, "search for the settings of the drive"),
}


def box_of(config: dict, *keys: str) -> dict:
    """The box from which initial conditions are drawn, and more keys of the section `operating`."""
    return {name: config["operating"][name] for name in ("height", "vz0", "psi0", *keys)}


def box_settings(section: str, config: dict) -> dict:
    """A section whose initial conditions are drawn from the box of the section `operating`."""
    limits = {"settling": config["solver"]["settling"]}
    settings = {**box_of(config, "starts", "seed", "tolerance"), **config[section], **limits}
    return {**settings, "model": model_of(config, without=(*INITIAL_CONDITION, *config[section]))}


def transit_axis(config: dict) -> dict | list:
    """The amplitudes of the transit table: those of the section `operating`, with what `transit.acceleration` gives."""
    shared, override = config["operating"]["acceleration"], config["transit"].get("acceleration", {})
    return {**shared, **override} if isinstance(override, dict) and isinstance(shared, dict) else override or shared


def remedies_for_amplitudes(config: dict, stated: dict) -> dict[str, str]:
    """How to examine other amplitudes: the `key` of the config, and what makes the range of the transit table begin
    lower (`start`) and end higher (`stop`).
    """
    section = "transit" if "acceleration" in config["transit"] else "operating"
    key = f"{section}.acceleration"
    if "acceleration" in stated.get(section, {}).get("dimensionless", {}):
        key = f"{section}.dimensionless.acceleration"
    if isinstance(transit_axis(config), list):
        return {"key": key, "start": f"add a smaller value to `{key}`", "stop": f"add a larger value to `{key}`"}
    return {"key": key, "start": f"lower `{key}.start`", "stop": f"raise `{key}.stop`"}


def transit_settings(config: dict, without: Iterable[str] = ()) -> dict:
    """The box of `operating`, the section `transit`, how its parts differ, and the model without some parameters."""
    transit = {name: config["transit"][name] for name in ("length", "longest")}
    transit |= {"acceleration": transit_axis(config), "starts": config["transit"]["parts"]}
    settings = {**box_of(config, "seed", "tolerance"), **transit}
    return {**settings, "spread": config["parts"], "model": model_of(config, without=(*INITIAL_CONDITION, *without))}


def blocks_settings(config: dict) -> dict:
    """The settings of the transit table: the parts may be blocks."""
    return {**transit_settings(config), **({"body": config["body"]} if "body" in config else {})}


def bodies_settings(config: dict) -> dict:
    """The box of `operating`, effort and the model without an amplitude."""
    settings = {**box_of(config, "seed"), **config["bodies"]}
    return {**settings, "model": model_of(config, without=INITIAL_CONDITION)}


def assumed_parts(config: dict, stated: dict) -> list[str]:
    """The differences of parts that the user does not state, so that the defaults are assumed."""
    return [name for name in config["parts"] if name not in (*stated.get("parts", {}), "seed")]


def assumed_model(stated: dict, derived: Iterable[str]) -> list[str]:
    """The parameters of drive, part and contact that are the paper's, because the user states another conveyor without
    them; `derived` are those that follow from other sections.
    """
    known = {*stated.get("model", {}), *derived}
    return [name for name in ("frequency", "angle", "mass", "friction", "stiffness", "damping") if name not in known]


# What the overlay of a measured drive states of the model.
MEASURED_DRIVE = {"acceleration", "frequency", "angle", "phase_shift", "harmonics"}


def uses_recording(config: dict, stated: dict) -> bool:
    """Whether the model has the drive of the recording that the config names, or the config names none."""
    return "measured" not in config["excitation"] or {*stated.get("model", {})} >= MEASURED_DRIVE


def parts_settings(config: dict, without: Iterable[str] = ()) -> dict:
    """The settings of the transit table without its amplitudes, for tables that follow the same parts at others."""
    return {name: value for name, value in transit_settings(config, without).items() if name != "acceleration"}


def start_settings(config: dict) -> dict:
    """The parts and the amplitudes of the transit table, and how the drive is switched."""
    transit = {name: value for name, value in transit_settings(config).items() if name not in ("length", "longest")}
    return {**transit, **config["start"]}


def drift_settings(config: dict) -> dict:
    """The parts of the transit table without their differences."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "spread"}
    return {**transit, **config["drift"]}


def advice_settings(config: dict) -> dict:
    """The section `advice`, the range of the amplitude within which it must hold, and the supply that makes this range.

    `range` has the lowest and the highest amplitude over the set one. `supply` is missing if the config states none.
    """
    section, supply, frequency = config["advice"], config["supply"], config["model"]["frequency"]
    if "resonance" not in supply:
        return {**section, "range": [1.0 - section["margin"], 1.0 + section["margin"]]}
    return {**section, "range": list(amplitude_range(supply, frequency)), "supply": supply}


def drive_settings(config: dict) -> dict:
    """The search follows the parts of the transit table, within the error of the amplitude that the advice states."""
    drive = config["drive"]
    return {**parts_settings(config, without=drive["bounds"]), **drive, "margin": config["advice"]["margin"]}


START_TABLES = ("start", "start_motions", "start_limits", "pushes")
TABLE_SETTINGS = {
    **dict.fromkeys(("operating/shares", "operating/regimes"), partial(box_settings, "operating")),
    "operating/transit": blocks_settings,
    **dict.fromkeys(("operating/bodies", "operating/body_shapes", "operating/landing"), bodies_settings),
    **dict.fromkeys(("operating/drift", "operating/track_lengths"), drift_settings),
    **dict.fromkeys(("operating/advice", "operating/changes"), advice_settings),
    **dict.fromkeys((f"operating/{name}" for name in START_TABLES), start_settings),
    "operating/throws": partial(box_settings, "throws"),
    "operating/track": partial(box_settings, "track"),
    **dict.fromkeys(("operating/drive_front", "operating/drive_generations"), drive_settings),
}
# Where the config may have a key `dimensionless`: keys below each section, or () for the section itself.
SCALED = {
    **dict.fromkeys(("operating", "track"), ((),)),
    "advice": (("changes",),),
    "drive": (("bounds",), ("search",)),
}
