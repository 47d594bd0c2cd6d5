"""Numbers of the caption of the figure stability."""

import pandas as pd

from accuracy.stability import PANELS, VELOCITY


def numbers(*, stability: pd.DataFrame) -> dict:
    own = stability[(stability.method == "event") & stability.panel.isin(PANELS)]
    return {"accuracy": VELOCITY, "own_right": own.outcome == "right"}
