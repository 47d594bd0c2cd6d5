"""Findings that need no trajectory: misfits, accepted frictions, and the numbers that contradict each other."""

import numpy as np
import pandas as pd

UP_ALONE, DOWN_ALONE = "C01.critical_amplitude", "C02.upper_end"
VELOCITIES = {
    "first_low": "C05.velocity_at_lower_end",
    "first_high": "C05.velocity_at_upper_end",
    "fall": "C06.fall",
}
ENOUGH = 0.6  # effort from which there are enough contacts for conclusions about the parameters


def misfit(values: np.ndarray, number: dict) -> np.ndarray:
    """Distance from the middle of the accepted interval over half its width; accepted values are within ±1.

    A mean squared error has an upper bound only; its misfit is the root of its ratio to that bound.
    """
    low, high = number["low"], number["high"]
    if low is None:
        return np.sqrt(np.maximum(values, 0.0) / high)
    return (values - 0.5 * (low + high)) / (0.5 * (high - low))


def accepted_frictions(frictions: pd.DataFrame, numbers: dict[str, dict]) -> dict[str, tuple[float, float] | None]:
    """The range of friction in which each velocity, and `all` of them, lie in their accepted intervals.

    The other parameters are as printed. All three velocities rise with friction. If one does not reach its interval,
    both ends are the same end of the frictions. `all` is None if no friction gives all three.
    """
    ranges = {
        column: tuple(np.interp([numbers[name]["low"], numbers[name]["high"]], frictions[column], frictions.friction))
        for column, name in VELOCITIES.items()
    }
    low, high = max(low for low, _ in ranges.values()), min(high for _, high in ranges.values())
    return ranges | {"all": (low, high) if low <= high else None}


def contradiction(numbers: dict[str, dict]) -> float:
    """The factor by which the intervals of C01 and of the upper end of C02 must be widened until they overlap.

    In the model, both are one quantity: the amplitude up to which the initial height z0 = 0 leads to the first state.
    """
    one, other = numbers[UP_ALONE], numbers[DOWN_ALONE]
    between = abs(one["low"] + one["high"] - other["low"] - other["high"])
    return between / (one["high"] - one["low"] + other["high"] - other["low"])
