"""What a finding is, and how tables are searched for onsets."""

from typing import NamedTuple

import numpy as np
import pandas as pd

NONE = float("nan")


class Finding(NamedTuple):
    """The quantities of one statement by both methods, and what stands behind them: the reason if they are not the
    paper's, else a note.

    A method that has no say in a statement has no quantities.
    """

    euler: tuple[float, ...]
    converged: tuple[float, ...]
    reason: str = ""


def lowest(values: pd.Series | pd.Index) -> float:
    return float(values.min()) if len(values) else NONE


def highest(values: pd.Series) -> float:
    return float(values.max()) if len(values) else NONE


def onset(x: np.ndarray, holds: np.ndarray) -> float:
    """The x that separates best: few hold below it, few do not from it on; NaN if none holds.

    Parameters
    ----------
    x : ascending, shape (n,)
    holds : bool, shape (n,)
    """
    x, holds = np.asarray(x, dtype=float), np.asarray(holds, dtype=bool)
    if not holds.any():
        return NONE
    wrong = np.cumsum(holds) - holds + np.cumsum(~holds[::-1])[::-1]
    return float(x[np.argmin(wrong)])
