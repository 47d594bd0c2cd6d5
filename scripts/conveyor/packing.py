"""The parameters of many parts in one table: a NumPy array with a named field for each of `parameters.PARAMETERS`.

Functions that follow many trajectories take such a table. Their results have its shape. Compiled functions receive the
same numbers as rows of float64, in an order that nothing else needs to know.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from . import arguments
from .columns import Columns
from .elementary import cos, sin
from .parameters import HARMONIC, PARAMETERS, RANGES, TENSION_MODES, UNITS
from .solver import model, plate
from .solver.model import Conveyor, Start, check_static_friction, pack, unpack

AT_REST = Start()
# The ends of the intervals of a row's numbers, and of the numbers of a harmonic (see solver.plate).
_, _, (SMALLEST_ORDER, LARGEST_ORDER) = HARMONIC["order"]
LARGEST_SHARE = HARMONIC["normal"][2][1]
ENDS = (
    (arguments.LOW, [SMALLEST_ORDER, *[-LARGEST_SHARE] * (len(HARMONIC) - 1)]),
    (arguments.HIGH, [LARGEST_ORDER, *[LARGEST_SHARE] * (len(HARMONIC) - 1)]),
)


def parameter_table(conveyor: Conveyor, start: Start = AT_REST, **values: ArrayLike) -> np.ndarray:
    """The parameters of a conveyor and an initial condition, with some of them replaced by arrays.

    Parameters
    ----------
    conveyor, start : the parameters that are not among the `values`
    values : numbers or arrays by the names of `PARAMETERS`, except tension, in their `UNITS`; arrays broadcast against
        each other. A new friction is the static friction, too, unless the conveyor or a value gives one

    Returns
    -------
    structured array with a float64 field for each name of `PARAMETERS`, in the shape of the `values`; tension is a
    position in `TENSION_MODES`, and z0 is NaN for a part that starts on the plate. A plate with harmonics has one more
    field for them

    Examples
    --------
    >>> parameters = parameter_table(Conveyor(), acceleration=np.array([20.0, 40.0])[:, None], z0=[0.0, 3e-4])
    >>> parameters.shape
    (2, 2)
    >>> parameters["acceleration"][:, 0].tolist(), parameters["frequency"][1, 1].item()  # m/s², Hz
    ([20.0, 40.0], 50.0)
    """
    arguments.check_type("conveyor", conveyor, Conveyor)
    arguments.check_type("start", start, Start)
    arrays = {}
    for name, value in values.items():
        if name not in RANGES:
            raise TypeError(f"{name} is not one of {', '.join(RANGES)}")
        arrays[name] = arguments.check_array(name, value, *RANGES[name], UNITS[name])
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ValueError(f"the shapes of the arrays do not broadcast: {shapes}") from None
    if np.prod(shape, dtype=np.float64) > arguments.MOST_VALUES:
        raise ValueError(f"{', '.join(values)} have the shape {shape}: more than {arguments.MOST_VALUES:g} points")
    table = np.full(shape, as_table(pack(conveyor, start)))
    if conveyor.static_friction is not None:
        arrays = {"static_friction": conveyor.static_friction} | arrays
    return replace_parameters(table, **arrays)


def replace_parameters(parameters: Conveyor | np.ndarray, **values: ArrayLike) -> np.ndarray:
    """A copy of a table, a row, or a Conveyor as a row, with new `values` of some parameters.

    tension is a word or an array of words. A new friction without a new static_friction is the static friction, too.
    ValueError for a value out of range, or a static_friction below friction.

    Examples
    --------
    >>> table = replace_parameters(parameter_table(Conveyor(), z0=[0.0, 1e-4]), friction=0.2, tension="clip")
    >>> table["static_friction"].tolist()
    [0.2, 0.2]
    """
    table = copy_table(parameters)
    for name, column in values.items():
        if name == "tension":
            code = np.vectorize(
                lambda word: TENSION_MODES.index(arguments.check_choice("tension", word, TENSION_MODES)), [np.float64]
            )
            column = code(column)
        elif name not in RANGES:
            raise TypeError(f"{name} is not one of {', '.join(PARAMETERS)}")
        options = {"may_be_nan": name in arguments.STATES, "unit": UNITS[name]}
        table[name] = check_column(name, column, table.shape, *arguments.PACKED[name], **options)
    if "friction" in values and "static_friction" not in values:
        table["static_friction"] = table["friction"]
    for row in table[table["static_friction"] < table["friction"]].flat[:1]:
        check_static_friction(row["friction"].item(), row["static_friction"].item())
    return table


def conveyor_and_start(parameters: Conveyor | np.ndarray) -> tuple[Conveyor, Start]:
    """The conveyor and the initial condition of one row of a table, with a number for static_friction in every case.

    Examples
    --------
    >>> conveyor, start = conveyor_and_start(parameter_table(Conveyor(), acceleration=[20.0, 40.0], z0=1e-4)[1])
    >>> conveyor.acceleration, start.z
    (40.0, 0.0001)
    """
    return unpack(check_row("parameters", parameters))


def copy_table(parameters: object) -> np.ndarray:
    """A copy of a table or a row, or the row of a Conveyor; TypeError for anything else, ValueError as `check_rows`."""
    if isinstance(parameters, Conveyor):
        return as_table(pack(parameters, AT_REST))
    if (getattr(getattr(parameters, "dtype", None), "names", None) or ())[: len(PARAMETERS)] != PARAMETERS:
        raise TypeError(f"parameters must be a table from parameter_table or a Conveyor, got {parameters!r}")
    rows, shape = check_rows(parameters)
    # A row of a table keeps the memory of the table, even in np.array(row).
    return as_table(rows.copy()).reshape(shape)


def check_column(
    name: str,
    values: object,
    shape: tuple[int, ...],
    low: float,
    high: float,
    *,
    may_be_nan: bool = False,
    unit: str = "",
) -> np.ndarray:
    """`values` in the shape of a table; ValueError for another shape, or a number outside [low, high]."""
    column = arguments.check_array(name, values, low, high, unit, least=0, may_be_nan=may_be_nan)
    try:
        return np.broadcast_to(column, shape)
    except ValueError:
        raise ValueError(f"{name} has the shape {column.shape}, but parameters have the shape {shape}") from None


def as_rows(parameters: np.ndarray) -> np.ndarray:
    """The numbers of a table of the shape s, float64, shape (*s, 16 + 5 h), for h harmonics, without a copy.

    The first ones are in the order of PARAMETERS. Rows of float64 are returned as they are.
    """
    names = getattr(getattr(parameters, "dtype", None), "names", None)
    if names is None or names[: len(PARAMETERS)] != PARAMETERS:
        return parameters
    parameters = np.asarray(parameters)
    numbers = parameters.dtype.itemsize // np.dtype(np.float64).itemsize
    return np.ascontiguousarray(parameters).view(np.float64).reshape(*parameters.shape, numbers)


def as_table(rows: np.ndarray) -> np.ndarray:
    """Rows of float64, shape (*s, 16 + 5 h), as a table of the shape s, without a copy."""
    rows = np.ascontiguousarray(rows, dtype=np.float64)
    names = [(name, np.float64) for name in PARAMETERS]
    if rows.shape[-1] > len(PARAMETERS):
        names.append(("harmonics", np.float64, (rows.shape[-1] - len(PARAMETERS),)))
    return rows.view(np.dtype(names))[..., 0]


def check_rows(parameters: object) -> tuple[np.ndarray, tuple[int, ...]]:
    """The numbers of a table, or of a Conveyor, float64, shape (n, 16 + 5 h), and its shape.

    z0 may be NaN, for a part that starts on the plate; z0 and vz0 may be NaN for a run that continues a failed one.

    ValueError for anything but a table, and for a number out of range, with its row and its column.
    """
    if isinstance(parameters, Conveyor):
        parameters = pack(parameters, AT_REST)
    rows = arguments.check_numbers("parameters", as_rows(parameters))
    waves = rows.shape[-1] - len(PARAMETERS) if rows.ndim > 0 else -1
    if waves < 0 or waves % len(HARMONIC) != 0:
        raise ValueError(f"parameters must be a table from parameter_table, got the shape {rows.shape}")
    shape = rows.shape[:-1]
    # Numba would compile the solver once more for an array that is read-only or has another layout.
    rows = np.require(rows, np.float64, ["C", "W"]).reshape(-1, rows.shape[-1])
    low, high = (np.append(ends, np.tile(of_wave, waves // len(HARMONIC))) for ends, of_wave in ENDS)
    outside = ~((rows >= low) & (rows <= high))
    outside[:, : len(PARAMETERS)] &= ~(arguments.MAY_BE_NAN & np.isnan(rows[:, : len(PARAMETERS)]))
    for row, column in np.argwhere(outside)[:1]:
        name = PARAMETERS[column] if column < len(PARAMETERS) else "harmonics"
        interval = f"[{low[column]:g}, {high[column]:g}] {UNITS.get(name, '')}".rstrip()
        raise ValueError(f"{place_of(row, shape)}: {name} = {rows[row, column]!s} is outside {interval}")
    tension, friction, static_friction = rows[:, [model.TENSION, model.FRICTION, model.STATIC_FRICTION]].T
    for row in np.flatnonzero(tension % 1.0)[:1]:
        positions = ", ".join(f"{position} ({mode})" for position, mode in enumerate(TENSION_MODES))
        fault = f"tension = {tension[row]!s} must be a position in TENSION_MODES: {positions}"
        raise ValueError(f"{place_of(row, shape)}: {fault}")
    for row in np.flatnonzero(static_friction < friction)[:1]:
        coefficients = f"static_friction = {static_friction[row]!s} is below friction = {friction[row]!s}"
        raise ValueError(f"{place_of(row, shape)}: {coefficients}")
    return rows, shape


def check_row(name: str, conveyor: object, start: Start = AT_REST) -> np.ndarray:
    """The numbers of a Conveyor with a start, or of a row of a table, float64, shape (16 + 5 h,).

    A row has an initial condition of its own, which a start other than AT_REST replaces. The error for anything else
    has the `name` of the argument.
    """
    arguments.check_type("start", start, Start)
    if isinstance(conveyor, Conveyor):
        return pack(conveyor, start)
    if not isinstance(conveyor, (np.ndarray, np.void)):
        raise TypeError(f"{name} must be a Conveyor or a row of a table, got {conveyor!r}")
    try:
        rows, shape = check_rows(conveyor)
    except ValueError as error:
        raise ValueError(f"{name}: {error}" if name != "parameters" else error) from None
    if shape not in ((), (1,)):
        raise ValueError(f"{name} must be one row of a table, got the shape {shape}")
    row = np.array(rows[0])
    if start != AT_REST:
        row[[model.Z0, model.VZ0]] = pack(Conveyor(), start)[[model.Z0, model.VZ0]]
    return row


def conveyor_of(conveyor: object, start: Start) -> tuple[Conveyor, Start]:
    """A Conveyor and its start, or those of a row of a table, see `check_row`."""
    if not isinstance(conveyor, Conveyor):
        return unpack(check_row("conveyor", conveyor, start))
    arguments.check_type("start", start, Start)
    return conveyor, start


def one_row(conveyor: object) -> np.ndarray:
    """The numbers of a Conveyor, or of a row of a table; the ranges of packed numbers are not checked again."""
    if isinstance(conveyor, np.ndarray) and conveyor.dtype == np.float64 and conveyor.ndim == 1:
        numbers, positive = conveyor[: model.TENSION], [model.FREQUENCY, model.MASS, model.GRAVITY]
        if len(numbers) == model.TENSION and np.isfinite(numbers).all() and (numbers[positive] > 0.0).all():
            return conveyor
    return check_row("conveyor", conveyor)


def place_of(row: int, shape: tuple[int, ...]) -> str:
    """A row of a table of some shape, in words."""
    index = ", ".join(str(place) for place in np.unravel_index(row, shape))
    return f"parameters[{index}]" if index else "parameters"


def plate_peaks(parameters: np.ndarray) -> Columns:
    """The largest sizes of the plate's motion over a cycle, with its harmonics, for a table of the shape (n,).

    Returns
    -------
    columns of the shape (n,): vx (m/s), the speed along the track; acceleration (m/s²) and displacement (m), the root
    of the sum of squares of the largest ones along the track and normal to it, â and â/ω² for a plate without harmonics

    Examples
    --------
    >>> double = {"order": 2, "along": 0.5, "normal": 0.5}
    >>> peaks = plate_peaks(parameter_table(Conveyor(acceleration=40.0, harmonics=[double]), psi0=[0.0]))
    >>> peaks.acceleration.round(6).tolist(), (1e3 * peaks.displacement).round(3).tolist()  # m/s², mm
    ([60.0], [0.456])
    """
    rows = as_rows(parameters)
    plates, plate_of = np.unique(
        rows[:, [model.PHASE_SHIFT, *range(len(PARAMETERS), rows.shape[1])]], axis=0, return_inverse=True
    )
    shares = np.array([plate.peaks(one[1:], one[0]) for one in plates]).reshape(-1, len(plate.Peaks._fields))
    shares = plate.Peaks(*shares[plate_of].T)
    acceleration, angle, frequency = rows[:, [model.ACCELERATION, model.ANGLE, model.FREQUENCY]].T
    omega = 2.0 * math.pi * frequency
    along, normal = cos(angle) ** 2, sin(angle) ** 2

    def combine(share_along: np.ndarray, share_normal: np.ndarray) -> np.ndarray:
        # Exactly 1 without harmonics.
        return np.sqrt(1.0 + along * (share_along**2 - 1.0) + normal * (share_normal**2 - 1.0))

    return Columns(
        {
            "vx": acceleration * cos(angle) / omega * shares.vx,
            "acceleration": acceleration * combine(shares.ax, shares.az),
            "displacement": acceleration / omega**2 * combine(shares.x, shares.z),
        }
    )


def refuse_harmonics(parameters: np.ndarray, what: str) -> None:
    """ValueError if a table or a row of it has harmonics of the plate, which `what` does not take."""
    if as_rows(parameters).shape[-1] > len(PARAMETERS):
        raise ValueError(f"{what} takes no harmonics of the plate; leave harmonics out of the model")
