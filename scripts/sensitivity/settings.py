"""Settings of the stage sensitivity: derivatives and curves of bifurcations, with units and ranges."""

from typing import Annotated

from pydantic import Field
from typing_extensions import TypedDict

from ..pipeline.settings import Name, mapping, number, whole
from ..pipeline.table_settings import model_of

Factor = number("factor by which a parameter is increased and decreased", gt=1, le=1e3)


class Curves(TypedDict):
    doublings: whole("doublings that are followed in two parameters", 0, 12)
    factors: mapping("range of each parameter", dict.fromkeys(("damping", "stiffness", "frequency", "angle"), Factor))
    points: whole("largest number of points on each side of a curve", 10, 10**5)


class Sensitivity(TypedDict):
    most: whole("number of bifurcations of each kind, those at the lowest amplitudes", 1, 10**4)
    doublings: whole("doublings whose derivatives are extrapolated", 1, 12)
    critical: Annotated[Name, Field(description="entry of `critical` over the amplitude alone")]
    heights: whole("number of amplitudes of this entry", 1, 1000)
    curves: Annotated[Curves, Field(description="bifurcation curves in two parameters")]


SECTIONS = {
    "sensitivity": Annotated[Sensitivity, Field(description="derivatives of bifurcations and critical heights")],
}


def derivatives_settings(config: dict) -> dict:
    own = {key: value for key, value in config["sensitivity"].items() if key != "curves"}
    return {**own, "model": model_of(config, "orbits")}


def curves_settings(config: dict) -> dict:
    own = {key: config["sensitivity"][key] for key in ("most", "curves")}
    return {**own, "model": model_of(config, "orbits", normal=True)}


# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {
    **dict.fromkeys(("sensitivity/derivatives", "sensitivity/groups"), derivatives_settings),
    **dict.fromkeys(("sensitivity/continued", "sensitivity/meetings"), curves_settings),
}
