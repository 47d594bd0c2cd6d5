"""Settings of the stage dimensions: fractal dimensions, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field

from ..pipeline.settings import Followed, Name, number, whole, word


class Dimension(Followed):
    begin: number("time of the first sample", "s", ge=0, le=1e6)
    interval: number("time between samples", "excitation cycles", gt=0, le=1e3)
    samples: whole("number of samples", 8, 10**8)
    estimator: word("estimator of the dimension", "paper", "box", "correlation")
    octaves: NotRequired[whole("box sizes are 1/2 to 1/2^octaves of the extent", 3, 30)]
    theiler: NotRequired[whole("pairs of samples at most this far apart in time are left out", 0, 10**8, "samples")]
    largest_error: NotRequired[number("estimates with a larger error are left out", gt=0, le=2)]


SECTIONS = {
    "dimensions": Annotated[dict[Name, Dimension], Field(description="fractal dimensions of phase portraits")],
}
