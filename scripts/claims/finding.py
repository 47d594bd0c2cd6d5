"""What a finding is, and how tables are searched for onsets."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

NONE = float("nan")
METHODS = ("euler", "converged")


class Finding(NamedTuple):
    """The quantities of one statement by both methods, by their names, and what stands behind them.

    The note is the reason if the numbers are not the paper's. A method that has no say in it has no quantities.
    """

    euler: dict[str, float]
    converged: dict[str, float]
    note: str = ""


def by_method(value: Callable[[pd.DataFrame], Any], euler: pd.DataFrame, converged: pd.DataFrame) -> dict[str, Any]:
    """A function of both methods' tables, by the names of the methods."""
    return {"euler": value(euler), "converged": value(converged)}


def by_both(name: str, value: Callable[[pd.DataFrame], float], euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """The Finding with one quantity, a function of a method's table."""
    return Finding({name: float(value(euler))}, {name: float(value(converged))})


def lowest(values: pd.Series | pd.Index) -> float:
    return float(values.min()) if len(values) else NONE


def highest(values: pd.Series) -> float:
    return float(values.max()) if len(values) else NONE


def onset(x: np.ndarray, holds: np.ndarray) -> float:
    """The x that separates best: few hold below it, few do not from it on; NaN if "never" separates as well.

    Parameters
    ----------
    x : ascending, shape (n,)
    holds : bool, shape (n,)
    """
    x, holds = np.asarray(x, dtype=float), np.asarray(holds, dtype=bool)
    wrong = np.append(np.cumsum(holds) - holds + np.cumsum(~holds[::-1])[::-1], holds.sum())
    best = wrong.min()
    return NONE if wrong[-1] == best else float(x[np.argmin(wrong)])


def format_value(value: float, unit: str = "m/s²") -> str:
    """An amplitude in words: "nowhere" for NaN."""
    return "nowhere" if np.isnan(value) else f"{value:g} {unit}"
