"""Numbers of the caption of the figure fig24."""

from dimensions.portraits import LARGEST_ERROR


def numbers() -> dict:
    return {"largest_error": LARGEST_ERROR}
