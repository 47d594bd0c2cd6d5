"""Numbers of the caption of the figure fig17."""

import pandas as pd

from conveyor_pipeline.figures.style import STATE_COLOURS
from conveyor_pipeline.paper.caption_numbers.fig12 import name_state


def numbers(*, converged: pd.DataFrame) -> dict[str, list[str]]:
    return {"states": [name_state(state) for state in STATE_COLOURS if (converged.state == state).any()]}
