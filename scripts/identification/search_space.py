"""The searched parameters, and their conversion to parameters of the model and parameter vectors.

The search goes over the logarithms of friction, loss (see edges.impact_loss), stiffness and angle. Damping follows from
loss and stiffness, because it rises with the stiffness along the valley of equally good contacts.
"""

import numpy as np

from conveyor.solver.model import TENSION, TENSION_MODES, UNITS, set_columns
from identification.edges import duration_over_mass
from pipeline import grid

# Parameters of the tables with their units, and searched parameters in order.
PARAMETERS = {name: UNITS[name] for name in ("friction", "damping", "stiffness", "angle")}
SEARCHED = ("friction", "loss", "stiffness", "angle")
LOSS, STIFFNESS = SEARCHED.index("loss"), SEARCHED.index("stiffness")


def bounds_of(settings: dict) -> np.ndarray:
    """Logarithms of the least and the largest value of each searched parameter, shape (2, 4)."""
    return np.log(np.array([settings["bounds"][name] for name in SEARCHED]).T)


def values_of(x: np.ndarray, model: dict) -> np.ndarray:
    """Friction, damping, stiffness and angle, shape (n, 4), from logarithms of searched parameters, shape (n, 4)."""
    values = np.exp(x)
    values[:, LOSS] /= duration_over_mass(values[:, STIFFNESS], model)
    return values


def searched(values: np.ndarray, model: dict) -> np.ndarray:
    """The inverse of `values_of`."""
    x = np.log(values)
    x[:, LOSS] += np.log(duration_over_mass(values[:, STIFFNESS], model))
    return x


def packed(values: np.ndarray, tension: str, model: dict) -> np.ndarray:
    """Parameter vectors, shape (n, 16), of a model with other `values`, shape (n, 4), and another tension mode."""
    rows = np.tile(grid.packed(model | {"z0": 0.0}), (len(values), 1))
    columns = dict(zip(PARAMETERS, values.T, strict=True))
    if "static_friction" in model:
        columns["static_friction"] = np.maximum(model["static_friction"], columns["friction"])
    set_columns(rows, columns)
    rows[:, TENSION] = TENSION_MODES.index(tension)
    return rows
