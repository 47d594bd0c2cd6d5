"""Settings of the stage motion: the motion of single parts, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..pipeline.settings import (
    Axes,
    Duration,
    Followed,
    HeightNumber,
    Model,
    Name,
    axis,
    check_ascending,
    number,
    span,
)


class Critical(Followed):
    duration: NotRequired[Duration]
    scan: axis(HeightNumber, "initial heights that are scanned for changes", least=2, check=check_ascending)


class Signal(Followed):
    duration: NotRequired[Duration]
    times: span(number("time", "s", ge=0, le=1e6), "times of the samples")


class Spectrum(Followed):
    duration: NotRequired[Duration]


class Impacts(TypedDict):
    axes: Axes
    model: NotRequired[Model]


SECTIONS = {
    "critical": Annotated[
        dict[Name, Critical], Field(description="initial heights at which the state of motion changes")
    ],
    "signals": Annotated[dict[Name, Signal], Field(description="motion of part and plate at given times")],
    "spectra": Annotated[dict[Name, Spectrum], Field(description="amplitude spectra of the velocities")],
    "impacts": Annotated[dict[Name, Impacts], Field(description="first impacts of parts that start in the air")],
}
