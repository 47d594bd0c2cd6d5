"""Settings of the stage fit: fits of Eq. 13, with units and ranges."""

from typing import NotRequired

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import Acceleration, Name, described, entries, interval, mapping, number, span

FIT = {
    "A": number("parameter A of Eq. 13", "m²/s²", ge=-1e6, le=1e6),
    "B": number("parameter B of Eq. 13", "m/s²", ge=-1e6, le=1e6),
    "C": number("parameter C of Eq. 13", "m", ge=-1e6, le=1e6),
}


class Regression(TypedDict):
    critical: described(Name, "entry of `critical` that Eq. 13 is fitted to")
    acceleration: interval(Acceleration, "amplitudes of the fitted data")
    bounds: mapping("search intervals", {name: interval(item, f"bounds of {name}") for name, item in FIT.items()})
    valley: span(FIT["B"], "values of B along the valley")
    paper: NotRequired[mapping("the paper's parameters", FIT)]


SECTIONS = {"regressions": entries(Regression, "fits of Eq. 13 to critical heights")}
