"""Numbers of the caption of the figure fig24."""

from conveyor_pipeline.paper.dimensions.limits import LARGEST_ERROR


def numbers() -> dict:
    return {"largest_error": LARGEST_ERROR}
