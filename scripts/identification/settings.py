"""Settings of the stage identification, with units and ranges, and what its tables need of other sections."""

from functools import partial
from typing import Annotated

from pydantic import Field
from typing_extensions import TypedDict

from ..conveyor import DESCRIPTIONS
from ..pipeline.settings import interval, number
from ..pipeline.table_settings import model_of


class Searched(TypedDict):
    friction: interval(number("friction", "1", gt=0, le=10), DESCRIPTIONS["friction"])
    loss: interval(number("loss", "1", gt=0, le=2), "group L of the contact: damping × contact time / mass")
    group: interval(number("group", "1", gt=0, le=1e12), "group K of the contact: dimensionless stiffness")
    angle: interval(number("angle", "rad", gt=0, le=1.5707), DESCRIPTIONS["angle"])


class Identification(TypedDict):
    bounds: Annotated[Searched, Field(description="search interval of each parameter")]
    effort: number("factor of the numbers of conveyors; below 1: coarse tables", ge=0.1, le=100)


SECTIONS = {
    "identification": Annotated[Identification, Field(description="parameters that the paper's numbers imply")],
}

# Quantities of claims that scripts/identification/numbers.py computes for any conveyor, and that the search fits.
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
POSTERIOR = ("numbers", "fits", "intervals", "samples", "frictions")


def identification_settings(config: dict, table: str, model: dict) -> dict:
    """The parts of a config that a table of the section `identification` needs, with the model."""
    own = config["identification"]
    if table == "edges":
        return {**own, "model": model}
    method = {name: config["solver"][name] for name in ("duration", "step", "settling", "mean_settling")}
    computed = {"numbers": paper_numbers(config), "measured": measured_quantities(config)}
    return {**own, **computed, "euler": {**method, "method": "euler"}, "model": model}


def paper_numbers(config: dict) -> dict[str, dict]:
    """The paper's numbers CLAIM.QUANTITY, each with the ends of its accepted interval."""
    found = {}
    for key in NUMBERS_OF_CLAIMS:
        claim, name = key.split(".")
        quantity = config["claims"][claim]["quantities"][name]
        low, high = quantity["accepted"]
        found[key] = {"is": quantity["is"], "paper": quantity["paper"], "low": low, "high": high}
    return found


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


def identification_table_settings(table: str, config: dict) -> dict:
    return identification_settings(config, table, model_of(config, normal=table == "edges"))


# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {
    f"identification/{name}": partial(identification_table_settings, name) for name in ("edges", *POSTERIOR)
}
