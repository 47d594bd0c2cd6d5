"""Settings of the stage calibration: parameters from measured velocities, or from the paper's numbers."""

from typing import NotRequired

from typing_extensions import TypedDict

from ..conveyor import DESCRIPTIONS
from ..operating.settings import box_of
from ..pipeline.settings import MODEL_TYPES, Line, Seed, described, interval, many, mapping, number, word
from ..pipeline.table_settings import INITIAL_CONDITION, model_of
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
    measurements: NotRequired[described(Line, "CSV file of measured velocities, relative to this overlay")]
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
    "calibration": described(Calibration, "parameters from measured velocities"),
    "identification": mapping(
        "parameters that the paper's numbers imply",
        {"effort": number("factor of the numbers of conveyors; below 1: coarse tables", ge=0.1, le=100)},
    ),
}
# Quantities of claims that scripts/calibration/paper_numbers.py computes for any conveyor, and that the search fits.
NUMBERS_OF_CLAIMS = (
    "C01.critical_amplitude",
    "C02.lower_end",
    "C02.upper_end",
    "C04.largest_height",
    "C05.velocity_at_lower_end",
    "C05.velocity_at_upper_end",
    "C06.fall",
    "C07.height",
    "C08.height",
    "C09.error",
    "C10.lower_end",
    "C10.upper_end",
)
# In which the parameters that the paper's numbers imply are searched: dimensionless, as the ranges of the calibration.
IDENTIFIED = {
    "friction": [0.08, 0.4],  # μ: from polished steel to rubber; the paper's value, 0.15, is low
    # L, about the share of the speed that damping takes in an impact; 0.25 as printed. Below this range parts jump at
    # all amplitudes of the paper, above it at none.
    "damping": [0.17, 0.38],
    # K; 72 as printed: from a tenth of it to two and a half times it. At larger values, tongues of other motions cut
    # into the edge for the lowest initial heights.
    "stiffness": [7.2, 180.0],
    "angle": [0.1396, 0.2793],  # rad: 8° to 16°, the printed 12° ± one third
}
CALIBRATION_TABLES = ("parameters", "samples", "fit", "alternatives", "prediction", "next")
POSTERIOR_TABLES = ("numbers", "fits", "intervals", "samples", "frictions")


def calibration_settings(config: dict) -> dict:
    """The search leaves the values of the searched parameters in the model open. The static friction stays as stated
    and limits the friction; 0 stands for none. A config to which calibrated parameters are added has the same settings.
    """
    own = config["calibration"]
    static_friction = config["model"].get("static_friction", 0.0)
    ranges = {name: own["ranges"][name] for name in own["parameters"]}
    if static_friction and "friction" in ranges:
        ranges["friction"] = [ranges["friction"][0], min(ranges["friction"][1], static_friction)]
    stated = (*INITIAL_CONDITION, "static_friction", *own["parameters"])
    model = model_of(config, without=stated)
    return {**box_of(config), **own, "ranges": ranges, "static_friction": static_friction, "model": model}


def study_table_settings(config: dict) -> dict:
    """The study calibrates with the settings of the config, without its conveyor and its measurements."""
    own = {name: value for name, value in calibration_settings(config).items() if name not in ("measurements", "model")}
    own["ranges"] = {name: config["calibration"]["ranges"][name] for name in ("friction", "damping", "stiffness")}
    own["parameters"] = list(own["ranges"])
    model = model_of(config, without=(*INITIAL_CONDITION, "static_friction"))
    return {**box_of(config), "calibration": own, "model": model}


def edges_settings(config: dict) -> dict:
    return {"ranges": IDENTIFIED, **config["identification"], "model": model_of(config, normal=True)}


def paper_posterior_settings(config: dict) -> dict:
    method = {name: config["solver"][name] for name in ("duration", "step", "settling", "mean_settling")}
    computed = {"numbers": paper_numbers(config), "measured": measured_quantities(config)}
    return {**edges_settings(config), "model": model_of(config), **computed, "euler": {**method, "method": "euler"}}


def paper_numbers(config: dict) -> dict[str, dict]:
    """The paper's numbers CLAIM.QUANTITY, each with the ends of its accepted interval."""
    numbers = {}
    for key in NUMBERS_OF_CLAIMS:
        claim, name = key.split(".")
        quantity = config["claims"][claim]["quantities"][name]
        low, high = quantity["accepted"]
        numbers[key] = {"is": quantity["is"], "paper": quantity["paper"], "low": low, "high": high}
    return numbers


def measured_quantities(config: dict) -> dict:
    """The axes and settings with which the claims measure these numbers."""

    def ends_and_count(axis: list | dict) -> list:
        if isinstance(axis, dict):
            return [axis["start"], axis["stop"], axis["num"]]
        return [axis[0], axis[-1], len(axis)]

    sweeps, fit = config["sweeps"], config["regressions"]["height"]
    return {
        "interval": fit["acceleration"],
        "starts": ends_and_count(sweeps["amplitudes"]["axes"]["z0"]),
        "moved_starts": ends_and_count(sweeps["interval"]["axes"]["z0"]),
        "critical": {name: config["claims"][name]["settings"]["acceleration"] for name in ("C07", "C08")},
        "triple": fit["paper"],
    }


# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {
    **dict.fromkeys((f"calibration/{name}" for name in CALIBRATION_TABLES), calibration_settings),
    "results/calibration_study": study_table_settings,
    "identification/edges": edges_settings,
    **dict.fromkeys((f"identification/{name}" for name in POSTERIOR_TABLES), paper_posterior_settings),
}
