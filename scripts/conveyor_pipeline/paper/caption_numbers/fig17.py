"""Numbers of the caption of the figure fig17."""

import pandas as pd

from conveyor_pipeline.figures.captions import name_state
from conveyor_pipeline.figures.style import STATE_COLOURS


def numbers(*, converged: pd.DataFrame) -> dict[str, list[str]]:
    return {"states": [name_state(state) for state in STATE_COLOURS if (converged.state == state).any()]}
