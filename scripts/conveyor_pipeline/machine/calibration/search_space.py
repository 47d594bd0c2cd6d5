"""The searched parameters and their ranges: logarithms of dimensionless groups, so that the ranges fit any conveyor.

The damping is searched as the loss group L and the stiffness as the group K, see `groups_of_contact`. The
other parameters are searched as they are.

All functions take `settings` with the `ranges` of the searched parameters, in the order of the coordinates, and the
`model` with the values of the other parameters.
"""

import numpy as np

from conveyor import replace_parameters
from conveyor.analysis.dimensionless_groups import contact_of_groups, groups_of_contact
from conveyor.elementary import exp, log
from conveyor_pipeline.common import grid

LOGARITHMIC = ("friction", "damping", "stiffness", "exponent")


def bounds_of(settings: dict) -> np.ndarray:
    """Lower and upper bounds of the searched coordinates, shape (2, d)."""
    return np.array([log(ends) if name in LOGARITHMIC else ends for name, ends in settings["ranges"].items()]).T


def values_at(coordinates: np.ndarray, settings: dict) -> dict[str, np.ndarray]:
    """Values of the searched parameters of the model, each of shape (n,), at coordinates, shape (n, d)."""
    values = {
        name: exp(column) if name in LOGARITHMIC else column
        for name, column in zip(settings["ranges"], coordinates.T, strict=True)
    }
    rows = np.full(len(coordinates), grid.row_of(settings["model"]))
    rows = replace_parameters(rows, **{name: values[name] for name in ("exponent", "inclination") if name in values})
    group, loss = groups_of_contact(rows["stiffness"], rows["damping"], rows)
    contact = contact_of_groups(values.get("stiffness", group), values.get("damping", loss), rows)
    return values | {
        name: value for name, value in zip(("stiffness", "damping"), contact, strict=True) if name in values
    }
