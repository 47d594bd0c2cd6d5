"""The parameters that are searched, and the conveyors that they are.

The search goes over logarithms of friction, loss (see edges.impact_loss), stiffness and angle. Damping follows from
loss and stiffness: along the valley of equally good contacts it would have to rise with the stiffness.
"""

import numpy as np

from conveyor.solver.model import TENSION, TENSION_MODES, UNITS, set_columns
from identification.edges import duration_over_mass
from pipeline import grid

# What is told, with units; and what is searched, in its order.
PARAMETERS = {name: UNITS[name] for name in ("friction", "damping", "stiffness", "angle")}
SEARCHED = ("friction", "loss", "stiffness", "angle")
LOSS, STIFFNESS = SEARCHED.index("loss"), SEARCHED.index("stiffness")


def bounds_of(settings: dict) -> np.ndarray:
    """Logarithms of the least and the largest value of each searched parameter, shape (2, 4)."""
    return np.log(np.array([settings["bounds"][name] for name in SEARCHED]).T)


def values_of(x: np.ndarray, model: dict) -> np.ndarray:
    """Friction, damping, stiffness and angle, shape (n, 4), of logarithms of what is searched, shape (n, 4)."""
    values = np.exp(x)
    values[:, LOSS] /= duration_over_mass(values[:, STIFFNESS], model)
    return values


def searched(values: np.ndarray, model: dict) -> np.ndarray:
    """The inverse of `values_of`."""
    x = np.log(values)
    x[:, LOSS] += np.log(duration_over_mass(values[:, STIFFNESS], model))
    return x


def packed(values: np.ndarray, reading: str, model: dict) -> np.ndarray:
    """Parameter vectors, shape (n, 16), of a model with other values, shape (n, 4), and another reading of tension."""
    rows = np.tile(grid.packed(model | {"z0": 0.0}), (len(values), 1))
    columns = dict(zip(PARAMETERS, values.T, strict=True))
    if "static_friction" in model:
        columns["static_friction"] = np.maximum(model["static_friction"], columns["friction"])
    set_columns(rows, columns)
    rows[:, TENSION] = TENSION_MODES.index(reading)
    return rows
