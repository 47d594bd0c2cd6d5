"""Numbers of the caption of the figure stability."""

import pandas as pd

from conveyor_pipeline.study.accuracy.limits import HEIGHT, PANELS, VELOCITY


def numbers(*, stability: pd.DataFrame) -> dict:
    solver_rows = stability[(stability.method == "event") & stability.panel.isin(PANELS)]
    return {"height": HEIGHT, "accuracy": VELOCITY, "own_right": solver_rows.outcome == "right"}
