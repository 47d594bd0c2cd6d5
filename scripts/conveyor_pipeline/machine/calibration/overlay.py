"""An overlay with the calibrated parameters, for further analyses of the conveyor."""

import pandas as pd

from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.machine.calibration.inference import NOT_CONVERGED, NOT_DETERMINED

DIGITS = 6


def make(parameters: pd.DataFrame, fit: pd.DataFrame) -> str:
    """The overlay as text; JobError says why there is none."""
    settings = parameters.attrs
    page = "the page calibration.md says what to do"
    if (parameters.status == NOT_CONVERGED).any():
        raise JobError("The search has not converged, so there is no overlay")
    if not fit.explained.all():
        raise JobError(f"The model does not explain the measurements, so there is no overlay; {page}")
    if (parameters.status == NOT_DETERMINED).all():
        raise JobError(f"The measurements determine no parameter, so there is no overlay; {page}")
    lines = [
        f"  {row.parameter}: {row.best:.{DIGITS - 1}e}   # {row.unit}, {row.status}: {row.low:.3g} to {row.high:.3g}"
        for row in parameters.itertuples()
    ]
    # Measured velocities replace what materials and a drop say.
    sources = {"stiffness": ("part", "lining", "radius"), "damping": ("restitution",)}
    replaced = [f"{key}: null" for name in parameters.parameter for key in sources.get(name, ())]
    contact = [f"contact: {{{', '.join(replaced)}}}"] if replaced else []
    head = (
        f"# Calibrated from {settings['measurements']}. Name this file behind the overlay that names the measurements."
    )
    if settings["effort"] < 1.0:
        head += f"\n# A trial with calibration.effort = {settings['effort']:g}: do not use these values."
    parts = (
        "parts: {calibrated: true}   # the transit of parts draws these parameters from the samples of the calibration"
    )
    return "\n".join([head, "model:", *lines, *contact, parts, ""])
