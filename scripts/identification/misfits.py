"""Misfits: differences of measured numbers from the paper's, in units of the accepted intervals of the claims."""

from typing import NamedTuple

import numpy as np

# Groups of numbers, one for each objective of the search.
OBJECTIVES = ("places", "first_velocity", "second_velocity")


class Number(NamedTuple):
    """The accepted interval of a number of the paper; `low` is None for a mean squared error."""

    low: float | None
    high: float


def misfit(values: np.ndarray, number: Number) -> np.ndarray:
    """Distance from the middle of the accepted interval over half its width; accepted values are within ±1.

    A mean squared error has an upper bound only; its misfit is the root of its ratio to that bound.
    """
    if number.low is None:
        return np.sqrt(np.maximum(values, 0.0) / number.high)
    return (values - 0.5 * (number.low + number.high)) / (0.5 * (number.high - number.low))


def number(entry: dict) -> Number:
    """The Number of an entry of the settings."""
    return Number(entry["low"], entry["high"])


class Numbers(NamedTuple):
    """Numbers of the paper by CLAIM.QUANTITY, and the shifts that are added to measured numbers for comparison."""

    of_paper: dict[str, Number]
    shifts: dict[str, float]

    def misfits(self, found: dict[str, np.ndarray]) -> np.ndarray:
        """Misfits of measured quantities, each of shape (n,): shape (n, m), in the order of the numbers."""
        each = [misfit(found[name] + self.shifts.get(name, 0.0), number) for name, number in self.of_paper.items()]
        return np.stack(each, axis=-1)


def numbers_of(settings: dict, names: list[str], shifts: dict[str, float] | None = None) -> Numbers:
    """The Numbers of the settings with these names."""
    return Numbers({name: number(settings["numbers"][name]) for name in names}, shifts or {})


def root_mean_square(values: np.ndarray) -> np.ndarray:
    """The root mean square over the last axis."""
    return np.sqrt(np.mean(values**2, axis=-1))


def smallest_widening(one: Number, other: Number) -> float:
    """The factor by which two intervals must be widened about their middles until they touch."""
    return abs(one.low + one.high - other.low - other.high) / (one.high - one.low + other.high - other.low)
