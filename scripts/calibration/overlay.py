"""An overlay with the calibrated parameters, for further analyses of the conveyor."""

import pandas as pd

from calibration.inference import NOT_DETERMINED, RESOLVED, TOO_FEW
from pipeline.rule_log import JobError

DIGITS = 6


def make(parameters: pd.DataFrame, fit: pd.DataFrame) -> str:
    """The overlay as text; JobError says why there is none."""
    settings = parameters.attrs
    page = "the page calibration.md says what to do"
    if not fit.explained.all():
        raise JobError(f"The model does not explain the measurements, so there is no overlay; {page}")
    if (parameters.status == TOO_FEW).any():
        raise JobError(f"The search has found too few samples for an overlay; {page}")
    if (parameters.status == NOT_DETERMINED).all():
        raise JobError(f"The measurements determine no parameter, so there is no overlay; {page}")
    lines = [
        f"  {row.parameter}: {row.best:.{DIGITS - 1}e}   # {row.unit}, {row.status}: {row.low:.3g} to {row.high:.3g}"
        for row in parameters.itertuples()
    ]
    head = (
        f"# Calibrated from {settings['measurements']}. Name this file behind the overlay that names the measurements."
    )
    if parameters.effective.iloc[0] < RESOLVED:
        head += "\n# A quick trial with too few samples for intervals: do not use these values."
    parts = (
        "parts: {calibrated: true}   # the transit of parts draws these parameters from the samples of the calibration"
    )
    return "\n".join([head, "model:", *lines, parts, ""])
