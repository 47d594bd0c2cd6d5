"""Numbers of the caption of the figure transit."""

import pandas as pd

from conveyor_pipeline.common.templates import format_number
from conveyor_pipeline.machine.claims.about_transit import exponents
from conveyor_pipeline.machine.operating.populations import ENDS, differences
from conveyor_pipeline.machine.operating.random_walk import NO_FLUCTUATIONS
from conveyor_pipeline.machine.operating.regimes import CHAOS, SEVERAL

KEPT = -0.1  # exponent of the spread over the length of the track from which on a longer track hardly helps


def numbers(*, transit: pd.DataFrame, lengths: pd.DataFrame, drift: pd.DataFrame) -> dict:
    amplitudes = {
        regime: list(map(format_number, rows.acceleration.unique())) for regime, rows in lengths.groupby("regime")
    }
    powers = exponents(lengths, SEVERAL)
    return {
        "search": transit.attrs,
        "backwards": transit.sort_values("back", na_position="first", kind="stable").iloc[-1].to_dict(),
        **differences(transit.attrs),
        "coexisting": amplitudes.get(SEVERAL, []),
        "shrinking": [format_number(amplitude) for amplitude, power in powers.items() if power < KEPT],
        "chaotic": amplitudes.get(CHAOS, []),
        "uncertain": int((~drift.status.isin(("ok", NO_FLUCTUATIONS))).sum()),
        "spreads": bool((lengths.spread > 0.0).any()),
        "ends": ENDS,
        "middle": ENDS[1] - ENDS[0],
    }
