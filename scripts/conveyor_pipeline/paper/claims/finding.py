"""Findings, the onset of a property over the amplitude, and numbers in words."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

NONE = float("nan")
# The methods of a Finding, and their names in sentences.
METHODS = {"euler": "paper's method", "converged": "converged solution"}


class Finding(NamedTuple):
    """The quantities of one statement by both methods, by name, with an explanation.

    The note becomes the reason of the verdict if the numbers are not the paper's. If a statement does not concern a
    method, that method has no quantities.
    """

    euler: dict[str, float]
    converged: dict[str, float]
    note: str = ""


def by_method(measure: Callable[[pd.DataFrame], Any], euler: pd.DataFrame, converged: pd.DataFrame) -> dict[str, Any]:
    """What `measure` returns for the table of each method, by method."""
    return {"euler": measure(euler), "converged": measure(converged)}


def single_quantity(
    name: str, measure: Callable[[pd.DataFrame], float], euler: pd.DataFrame, converged: pd.DataFrame
) -> Finding:
    """The Finding with one quantity, which `measure` returns for the table of each method."""
    return Finding({name: float(measure(euler))}, {name: float(measure(converged))})


def onset(x: ArrayLike, holds: ArrayLike) -> float:
    """The x from which a property holds: the threshold with the fewest exceptions on both sides.

    NaN if assuming that the property never holds has no more exceptions.

    x : ascending, shape (n,)
    holds : bool, shape (n,)
    """
    x, holds = np.asarray(x, dtype=float), np.asarray(holds, dtype=bool)
    exceptions = np.append(np.cumsum(holds) - holds + np.cumsum(~holds[::-1])[::-1], holds.sum())
    fewest = exceptions.min()
    return NONE if exceptions[-1] == fewest else float(x[np.argmin(exceptions)])


def format_amplitude(value: float) -> str:
    """An amplitude (m/s²) in words, "nowhere" for NaN."""
    return "nowhere" if np.isnan(value) else f"{value:g} m/s²"


def format_interval(low: float | None, high: float | None) -> str:
    """An accepted interval with all digits that the config gives; None or NaN is no bound."""
    below = "-∞" if low is None or np.isnan(low) else f"{low:.8g}"
    above = "∞" if high is None or np.isnan(high) else f"{high:.8g}"
    return f"[{below}, {above}]"
