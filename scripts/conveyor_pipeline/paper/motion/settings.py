"""Settings of the stage motion: the motion of single parts, with units and ranges."""

from typing import NotRequired

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import (
    Axes,
    Followed,
    HeightNumber,
    Model,
    axis,
    check_ascending,
    entries,
    number,
    span,
)


class Signal(Followed):
    times: span(number("time", "s", ge=0, le=1e6), "times of the samples")


class Impacts(TypedDict):
    axes: Axes
    model: NotRequired[Model]


class Critical(Followed):
    scan: axis(HeightNumber, "initial heights that are scanned for changes", min_length=2, check=check_ascending)


SECTIONS = {
    "signals": entries(Signal, "motion of part and plate at given times"),
    "spectra": entries(Followed, "amplitude spectra of the velocities"),
    "impacts": entries(Impacts, "first impacts of parts that start in the air"),
    "critical": entries(Critical, "initial heights at which the state of motion changes"),
}
