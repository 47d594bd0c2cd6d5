"""Settings of the stage excitation: the measured drive, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..pipeline.settings import Line, number, word


class Excitation(TypedDict):
    measured: NotRequired[Annotated[Line, Field(description="CSV file of an accelerometer, relative to this overlay")]]
    unit: word("unit of the accelerations in the file", "m/s²", "g")
    mount: number("angle of the sensor's axis x above the track, for columns x and z", "rad", ge=-3.1416, le=3.1416)


SECTIONS = {
    "excitation": Annotated[Excitation, Field(description="the drive from an accelerometer file")],
}
