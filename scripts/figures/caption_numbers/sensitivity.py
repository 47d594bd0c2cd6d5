"""Numbers of the caption of the figure sensitivity."""

import numpy as np
import pandas as pd

from pipeline.templates import format_number
from sensitivity.selection import LONGEST_PERIOD, MOST

SMALL_ELASTICITY = 1e-3  # below it, a relative error means nothing


def numbers(
    *, derivatives: pd.DataFrame, continued: pd.DataFrame, meetings: pd.DataFrame, bifurcations: pd.DataFrame
) -> dict:
    right = derivatives[derivatives.status == "ok"]
    error = ((right.derivative - right.difference) / right.derivative).abs()[right.elasticity.abs() > SMALL_ELASTICITY]
    own = continued[continued.parameter == "angle"]
    first = continued[continued.kind == "fold"].begin.min()
    cusps = meetings[(meetings.begin == first) & (meetings.meeting == "cusp") & (meetings.parameter == "damping")]
    short = bifurcations[bifurcations.period <= LONGEST_PERIOD]
    return {
        "most": MOST,
        "many": (short.kind.value_counts() > MOST).any(),
        "heights": list(map(format_number, right[right.kind == "critical_height"].acceleration.unique())),
        "tried": (derivatives.kind == "critical_height").any(),
        "right": np.isfinite(error.max()),
        "points": (derivatives.kind != "critical_amplitude").any(),
        "has_fold": not np.isnan(first),
        "error": error.max(),
        "failed": (derivatives.derivative.notna() & (derivatives.status != "ok")).sum(),
        "missing": derivatives.derivative.isna().sum(),
        "own": own.iloc[0].to_dict() if len(own) else {},
        "cusps": list(cusps[cusps.status == "ok"].damping_group.sort_values()),
    }
