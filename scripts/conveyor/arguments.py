"""Checks of arguments: each error names the argument and the admissible values."""

from collections.abc import Collection

import numpy as np

from .parameters import PARAMETERS, RANGES, TENSION_MODES, UNITS, check_number, format_interval

MOST_VALUES = 10**8  # values in one array, or in the product of several
MOST_THREADS = 1024
MOST_CYCLES = 10**6  # excitation cycles of one trajectory
MOST_BLOCKS = 10**4
LONGEST = 1e6  # s, of a run
LARGEST_COORDINATE = 1e100

# Intervals of packed parameters. A trajectory may leave the range of initial conditions, and a run that failed leaves
# no state (NaN) for the run that continues it.
STATES = ("z0", "vz0")
PACKED = RANGES | {"tension": (0.0, len(TENSION_MODES) - 1.0)} | dict.fromkeys(STATES, (-1e12, 1e12))
LOW, HIGH = np.array([PACKED[name] for name in PARAMETERS]).T
MAY_BE_NAN = np.isin(PARAMETERS, STATES)


def check_type(name: str, value: object, kind: type) -> None:
    """TypeError unless `value` is a `kind`."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be a {kind.__name__}, got {value!r}")


def check_choice(name: str, value: object, choices: Collection[str]) -> str:
    """`value`; ValueError unless it is one of the `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name} = {value!r} is not one of {', '.join(choices)}")
    return value


def check_flag(name: str, value: object) -> bool:
    """`value` as a bool; ValueError unless it is True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} = {value!r} is neither True nor False")
    return bool(value)


def check_count(name: str, value: object, low: int, high: int) -> int:
    """`value` as an int; ValueError unless it is a whole number from `low` to `high`."""
    # To NumPy, a time span is a whole number.
    is_whole = isinstance(value, (int, np.integer)) and not isinstance(value, (bool, np.timedelta64))
    if not is_whole or not low <= value <= high:
        raise ValueError(f"{name} = {value!r} must be a whole number from {low} to {high}")
    return int(value)


def check_numbers(name: str, values: object) -> np.ndarray:
    """`values` as an array; ValueError unless they are real numbers."""
    try:
        array = np.asarray(values)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} must be an array of numbers: {error}") from None
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked values; leave them out")
    if array.dtype.kind not in "iuf" and (array.size or array.dtype.names):
        raise ValueError(f"{name} must be an array of numbers, got the type {array.dtype}")
    return array


def check_array(
    name: str,
    values: object,
    low: float,
    high: float,
    unit: str = "",
    *,
    least: int = 1,
    may_be_nan: bool = False,
) -> np.ndarray:
    """`values` as a float64 array; ValueError unless it has at least `least` values, all of them in [low, high]."""
    array = check_numbers(name, values)
    if not least <= array.size <= MOST_VALUES:
        raise ValueError(f"{name} must have {least} to {MOST_VALUES:g} values, got the shape {array.shape}")
    with np.errstate(over="ignore"):
        # Numba would compile the solver once more for an array that is read-only, such as a pandas column.
        numbers = np.require(array, np.float64, ["C", "W"])
    # Compare in float64: in float32 a large bound becomes infinite.
    outside = ~((numbers >= low) & (numbers <= high))
    if may_be_nan:
        outside &= ~np.isnan(numbers)
    if outside.any():
        raise ValueError(f"{name} = {array[outside].flat[0]!s} is outside {format_interval(low, high, unit)}")
    return numbers


def check_states(name: str, states: object, shape: tuple[int, ...], *, may_be_nan: bool = False) -> np.ndarray:
    """`states`, δ (m) and v (m/s) along the last axis, as a new float64 array; ValueError for another shape."""
    limits = {"low": -LARGEST_COORDINATE, "high": LARGEST_COORDINATE, "least": 0, "may_be_nan": may_be_nan}
    array = check_array(name, states, **limits)
    if array.shape != shape:
        raise ValueError(f"{name} must have the shape {shape}, δ (m) and v (m/s), got {array.shape}")
    return array.copy()


def check_series(name: str, values: object, *, least: int = 0, may_be_nan: bool = False) -> np.ndarray:
    """`values` as a float64 array of the shape (n,); ValueError for another shape, or fewer than `least`."""
    array = check_array(name, values, -LARGEST_COORDINATE, LARGEST_COORDINATE, least=least, may_be_nan=may_be_nan)
    if array.ndim != 1:
        raise ValueError(f"{name} must have the shape (n,), got {array.shape}")
    return array


def check_parameter(name: str, value: object) -> float:
    """`value`, of a parameter, as a float; ValueError outside its range."""
    return check_number(name, value, *RANGES[name], UNITS[name])


def check_time(name: str, value: object) -> float:
    """`value`, a duration or a step (s), as a float; ValueError unless it is positive and at most LONGEST."""
    return check_number(name, value, 0.0, LONGEST, "s", above=True)


def check_tolerance(tolerance: object, name: str = "tolerance") -> float:
    """`tolerance`, a relative error per Taylor step, as a float; ValueError outside [1e-14, 1e-2]."""
    return check_number(name, tolerance, 1e-14, 1e-2)


def check_limits(limits: object, parameter: str, value: float) -> tuple[float, float]:
    """The lowest and highest value of a parameter, on either side of a `value`; ValueError names the wrong one."""
    if not isinstance(limits, (tuple, list, np.ndarray)) or not np.iterable(limits) or len(limits) != 2:
        raise ValueError(f"limits = {limits!r} must be the lowest and the highest {parameter}")
    (low, high), unit = RANGES[parameter], UNITS[parameter]
    return (
        check_number("limits[0]", limits[0], low, value, unit),
        check_number("limits[1]", limits[1], value, high, unit),
    )


def check_threads(threads: object) -> int:
    """`threads` as an int; ValueError unless it is a whole number from 1 to MOST_THREADS."""
    return check_count("threads", threads, 1, MOST_THREADS)
