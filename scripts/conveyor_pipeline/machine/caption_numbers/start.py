"""Numbers of the caption of the figure start."""

import pandas as pd

from conveyor_pipeline.machine.operating.populations import FAST
from conveyor_pipeline.machine.operating.ramps import CYCLES, STEP


def numbers(*, motions: pd.DataFrame) -> dict:
    fast = motions.acceleration[motions.aim == FAST]
    return {"step": STEP, "cycles": CYCLES, "fast": float(fast.iloc[0]) if len(fast) else None}
