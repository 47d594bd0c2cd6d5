"""Settings of the stage dimensions: fractal dimensions, with units and ranges."""

from conveyor_pipeline.common.settings import Followed, entries, word

ESTIMATORS = ("paper", "box", "correlation")


class Dimension(Followed):
    estimator: word("paper: of the run from its beginning; box, correlation: of the settled motion", *ESTIMATORS)


SECTIONS = {"dimensions": entries(Dimension, "fractal dimensions of phase portraits")}
