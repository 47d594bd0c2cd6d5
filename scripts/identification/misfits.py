"""Misfits: differences of measured numbers from the paper's, in units of the accepted intervals of the claims.

A number is an entry of `numbers` in the settings, with the ends `low` and `high` of its accepted interval.
"""

import numpy as np

# Groups of numbers, one for each objective of the search.
OBJECTIVES = ("places", "first_velocity", "second_velocity")


def misfit(values: np.ndarray, number: dict) -> np.ndarray:
    """Distance from the middle of the accepted interval over half its width; accepted values are within ±1.

    A mean squared error has an upper bound only; its misfit is the root of its ratio to that bound.
    """
    low, high = number["low"], number["high"]
    if low is None:
        return np.sqrt(np.maximum(values, 0.0) / high)
    return (values - 0.5 * (low + high)) / (0.5 * (high - low))


def misfits(found: dict[str, np.ndarray], numbers: dict[str, dict], shifts: dict[str, float]) -> np.ndarray:
    """Misfits of measured quantities, each of shape (n,): shape (n, m), in the order of the numbers.

    found, numbers, shifts : by CLAIM.QUANTITY; shifts are added to measured quantities before they are compared
    """
    each = [misfit(found[name] + shifts.get(name, 0.0), number) for name, number in numbers.items()]
    return np.stack(each, axis=-1)


def root_mean_square(values: np.ndarray) -> np.ndarray:
    """The root mean square over the last axis."""
    return np.sqrt(np.mean(values**2, axis=-1))
