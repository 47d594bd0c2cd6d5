"""Settings of the stage dimensions: fractal dimensions, with units and ranges."""

from typing import NotRequired

from conveyor_pipeline.common.settings import Duration, Followed, entries, whole, word

ESTIMATORS = ("paper", "box", "correlation")


class Dimension(Followed):
    estimator: word("paper: of the run from its beginning; box, correlation: of the settled motion", *ESTIMATORS)
    duration: NotRequired[Duration]
    samples: NotRequired[whole("number of samples of the settled motion", 100, 10**8)]


SECTIONS = {"dimensions": entries(Dimension, "fractal dimensions of phase portraits")}
