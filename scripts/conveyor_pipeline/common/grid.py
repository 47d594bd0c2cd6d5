"""The points of a sweep: the product of axes, the first axis slowest, as a table of parameters."""

import math
from collections.abc import Mapping

import numpy as np

from conveyor import Conveyor, Start, parameter_table, replace_parameters
from conveyor_pipeline.common.axes import Axis


def axis_values(name: str, axis: Axis) -> np.ndarray:
    """Values of an axis in SI units, shape (n,), float64, or str for tension. NaN in z0 stands for `conveyor` (Eq. 15).

    Parameters
    ----------
    name : one of parameters.PARAMETERS
    axis : the values themselves, or start, stop (included) and num
    """
    if isinstance(axis, Mapping):
        return np.linspace(axis["start"], axis["stop"], int(axis["num"]))
    if name == "tension":
        return np.array(axis, dtype=np.str_)
    return np.array([math.nan if value == "conveyor" else value for value in axis], dtype=np.float64)


def conveyor_and_start(model: Mapping[str, float | str]) -> tuple[Conveyor, Start]:
    """A conveyor and an initial condition from values of parameters.PARAMETERS; missing ones have their defaults."""
    start = Start(model.get("z0", 0.0), model.get("vz0", 0.0))
    return Conveyor(**{name: value for name, value in model.items() if name not in ("z0", "vz0")}), start


def row_of(model: Mapping[str, float | str]) -> np.ndarray:
    """The parameters of one conveyor and initial condition, a table of shape (); `model` as in `conveyor_and_start`."""
    return parameter_table(*conveyor_and_start(model))


def product(
    axes: Mapping[str, Axis], model: Mapping[str, float | str], rows: tuple[int, int] | None = None
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The product of axes.

    Parameters
    ----------
    axes : the axes by name; the first one varies slowest
    model : values of the remaining parameters; missing ones have the paper's defaults
    rows : the first row and the row after the last one; None for all rows

    Returns
    -------
    columns : values of the axes, each of shape (n,)
    parameters : as from `parameter_table`, shape (n,)
    """
    axes_values = {name: axis_values(name, axis) for name, axis in axes.items()}
    shape = tuple(map(len, axes_values.values()))
    places = np.unravel_index(np.arange(*(rows or (0, math.prod(shape)))), shape)
    columns = {name: values[place] for (name, values), place in zip(axes_values.items(), places, strict=True)}
    # Static friction is set last: its lower limit depends on the friction coefficient, which may be an axis.
    alone = {name: value for name, value in model.items() if name != "static_friction"}
    parameters = np.full(len(next(iter(columns.values()))), row_of(alone))
    values = {name: model[name] for name in model if name not in alone} | columns
    return columns, replace_parameters(parameters, **values)
