"""Numbers of the caption of the figure harmonics."""

import numpy as np
import pandas as pd

from conveyor_pipeline.machine.excitation import effects
from conveyor_pipeline.machine.excitation.limits import MATTERS, STATEMENT
from conveyor_pipeline.machine.operating.populations import ENDS


def numbers(*, drives: pd.DataFrame) -> dict:
    harmless = effects.harmless_shares(drives)
    # Limits are rounded down, otherwise they would promise too much.
    harmless["percent"] = np.floor(1e3 * harmless.share) / 10.0
    return {
        "statement": effects.statement_of(drives),
        "limits": STATEMENT,
        "matters": MATTERS,
        "ends": ENDS,
        "harmless": harmless.replace({np.nan: None}).to_dict("records"),
    }
