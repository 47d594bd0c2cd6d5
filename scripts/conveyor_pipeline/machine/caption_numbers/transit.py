"""Numbers of the caption of the figure transit."""

import pandas as pd

from conveyor_pipeline.common.templates import format_number
from conveyor_pipeline.machine.operating.populations import ENDS, differences
from conveyor_pipeline.machine.operating.random_walk import NO_FLUCTUATIONS
from conveyor_pipeline.machine.operating.regimes import CHAOS, SEVERAL


def numbers(*, transit: pd.DataFrame, lengths: pd.DataFrame, drift: pd.DataFrame) -> dict:
    amplitudes = {
        regime: list(map(format_number, rows.acceleration.unique())) for regime, rows in lengths.groupby("regime")
    }
    return {
        "search": transit.attrs,
        "backwards": transit.sort_values("back", na_position="first", kind="stable").iloc[-1].to_dict(),
        **differences(transit.attrs),
        "coexisting": amplitudes.get(SEVERAL, []),
        "chaotic": amplitudes.get(CHAOS, []),
        "uncertain": int((~drift.status.isin(("ok", NO_FLUCTUATIONS))).sum()),
        "spreads": bool((lengths.spread > 0.0).any()),
        "ends": ENDS,
        "middle": ENDS[1] - ENDS[0],
    }
