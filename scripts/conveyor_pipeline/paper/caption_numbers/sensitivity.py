"""Numbers of the caption of the figure sensitivity."""

import numpy as np
import pandas as pd

from conveyor_pipeline.common.templates import format_number
from conveyor_pipeline.paper.sensitivity.limits import LONGEST_PERIOD, MOST, UNEVEN


def numbers(
    *, changes: pd.DataFrame, continued: pd.DataFrame, meetings: pd.DataFrame, bifurcations: pd.DataFrame
) -> dict:
    right = changes[changes.status == "ok"]
    conveyor = continued[continued.parameter == "angle"]
    first = continued[continued.kind == "fold"].begin.min()
    cusps = meetings[(meetings.begin == first) & (meetings.meeting == "cusp") & (meetings.parameter == "damping")]
    short = bifurcations[bifurcations.period <= LONGEST_PERIOD]
    return {
        "most": MOST,
        "many": (short.kind.value_counts() > MOST).any(),
        "heights": list(map(format_number, right[right.kind == "critical_height"].acceleration.unique())),
        "tried": (changes.kind == "critical_height").any(),
        "right": len(right) > 0,
        "points": (changes.kind != "critical_amplitude").any(),
        "has_fold": not np.isnan(first),
        "uneven": (changes.status == UNEVEN).sum(),
        "missing": (~changes.status.isin(["ok", UNEVEN])).sum(),
        "own": conveyor.iloc[0].to_dict() if len(conveyor) else {},
        "cusps": list(cusps[cusps.status == "ok"].damping_group.sort_values()),
    }
