"""Numbers of the caption of the figure harmonics."""

import numpy as np
import pandas as pd

from excitation import clean_drive
from operating.transit import ENDS


def numbers(*, drives: pd.DataFrame) -> dict:
    limits = drives.attrs["statement"]
    harmless = clean_drive.harmless_shares(drives, drives.attrs["matters"])
    return {
        "statement": clean_drive.statement_of(drives),
        "limits": limits,
        "ends": ENDS,
        "harmless": harmless.replace({np.nan: None}).to_dict("records"),
    }
