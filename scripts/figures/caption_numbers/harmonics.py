"""Numbers of the caption of the figure harmonics."""

import numpy as np
import pandas as pd

from excitation import clean_drive
from excitation.limits import MATTERS, STATEMENT
from operating.transit import ENDS


def numbers(*, drives: pd.DataFrame) -> dict:
    harmless = clean_drive.harmless_shares(drives)
    return {
        "statement": clean_drive.statement_of(drives),
        "limits": STATEMENT,
        "matters": MATTERS,
        "ends": ENDS,
        "harmless": harmless.replace({np.nan: None}).to_dict("records"),
    }
