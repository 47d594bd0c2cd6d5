"""Settings of the stage sensitivity: changes and curves of bifurcations, with units and ranges."""

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import Effort, Name, described, mapping, number
from conveyor_pipeline.common.table_settings import model_of

Factor = number("factor by which a parameter is increased and decreased", gt=1, le=1e3)


class Sensitivity(TypedDict):
    critical: described(Name, "entry of `critical` over the amplitude alone")
    effort: Effort
    factors: mapping(
        "range of each parameter in bifurcation curves",
        dict.fromkeys(("damping", "stiffness", "frequency", "angle"), Factor),
    )


SECTIONS = {"sensitivity": described(Sensitivity, "how bifurcations and critical heights change with each parameter")}


def changes_settings(config: dict) -> dict:
    settings = {key: config["sensitivity"][key] for key in ("critical", "effort")}
    return {**settings, "model": model_of(config, "orbits")}


def curves_settings(config: dict) -> dict:
    settings = {key: config["sensitivity"][key] for key in ("effort", "factors")}
    return {**settings, "model": model_of(config, "orbits", normal=True)}


TABLE_SETTINGS = {
    "sensitivity/changes": changes_settings,
    **dict.fromkeys(("sensitivity/continued", "sensitivity/meetings"), curves_settings),
}
