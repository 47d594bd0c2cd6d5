"""Numbers of the caption of the figure track."""

import numpy as np
import pandas as pd

from conveyor_pipeline.machine.operating.regimes import NOT_ALL_SETTLED, SLIDES_AWAY


def numbers(*, track: pd.DataFrame) -> dict:
    steepest = track[(track.mean_velocity > 0.0) & (track.inclination > 0.0)].groupby("state").inclination.max()
    is_open = track.status == NOT_ALL_SETTLED
    known = track[~is_open & (track.status != SLIDES_AWAY)]
    is_reached = (known.status == "ok").groupby(known.state)
    return {
        "steepest": np.degrees(steepest).to_dict(),
        "steep": (track.status == SLIDES_AWAY).any(),
        "missing": [state for state, all_reach in is_reached.all().items() if not all_reach],
        "absent": [state for state, any_reach in is_reached.any().items() if not any_reach],
        "unsettled": track[is_open].inclination.nunique() / track.inclination.nunique(),
        "empty": track.mean_velocity.isna().all(),
    }
