"""Measured velocities in a CSV file, and everything that can be wrong with such a file.

The Snakefile imports this module to check the file before any job starts, so it imports nothing slow.
"""

import difflib
import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from statistics import median
from typing import Any, NamedTuple

from conveyor.parameters import RANGES, UNITS

# Columns beside the parameters of the model: unit, and the smallest and largest plausible value.
COLUMNS = {
    "acceleration": ("m/s²", 0.0, 1e4),
    "velocity": ("m/s", -100.0, 100.0),
    "sd": ("m/s", 0.0, 100.0),
    "duration": ("s", 0.0, 1e4),
    "before": ("s", 0.0, 1e4),
}
REQUIRED = ("acceleration", "velocity")
POSITIVE = ("acceleration", "sd", "duration")  # must be above zero
DEFAULTS = {"duration": 1.0, "before": 1.0}  # s
# Parameters that a calibration can search. A row cannot have its own value of a searched parameter.
CALIBRATED = ("friction", "damping", "stiffness", "angle", "inclination", "phase_shift", "exponent")
# Units that the header may state: the SI unit, and the factor to it.
HEADER_UNITS = {
    **dict.fromkeys(("m/s²", "m/s^2", "m/s2"), ("m/s²", 1.0)),
    **dict.fromkeys(("mm/s²", "mm/s^2", "mm/s2"), ("m/s²", 0.001)),
    "g": ("m/s²", 9.80665),
    **{"m/s": ("m/s", 1.0), "cm/s": ("m/s", 1e-2), "mm/s": ("m/s", 1e-3), "m/min": ("m/s", 1.0 / 60.0)},
    **{"s": ("s", 1.0), "ms": ("s", 1e-3), "Hz": ("Hz", 1.0), "kg": ("kg", 1.0), "m": ("m", 1.0), "mm": ("m", 1e-3)},
    **{"rad": ("rad", 1.0), "deg": ("rad", math.pi / 180.0), "°": ("rad", math.pi / 180.0)},
}
EXAMPLE = "acceleration,velocity"
MOST_ROWS = 1000
MOST_BYTES = 1_000_000  # of the file
# No friction drives a part faster than the plate. Noise may make it seem a little faster; other units, much faster.
TOO_FAST = 2.0


class Measurement(NamedTuple):
    """One measured velocity."""

    line: int  # of the file
    acceleration: float  # m/s²
    velocity: float  # m/s
    sd: float | None  # m/s
    duration: float  # s
    before: float  # s
    changed: dict[str, float]  # parameters of the model and initial conditions of this row; the others are not known


def first_comments(text: str) -> list[str]:
    """The comments before the header of a file of measurements."""
    lines = [stripped for line in text.splitlines() if (stripped := line.strip())]
    before = itertools.takewhile(lambda line: line.startswith("#"), lines)
    return [comment for line in before if (comment := line.strip("# "))]


def known_columns(parameters: Sequence[str]) -> dict[str, tuple[float, float]]:
    """The admissible interval of each column; a row cannot have its own value of a searched parameter."""
    model_ranges = {name: interval for name, interval in RANGES.items() if name not in (*parameters, "static_friction")}
    return {**model_ranges, **{name: (low, high) for name, (_, low, high) in COLUMNS.items()}}


def unknown_column(name: str, known: Mapping) -> str:
    """Fault and remedy of a column with an unknown name."""
    if not name:
        return "has a column without a name; name it, or delete it"
    if name == "static_friction":
        return "has the column static_friction, which is one for all lines; state it as model.static_friction"
    if name in CALIBRATED:  # the others are known
        remedy = f"delete the column, or take {name} out of calibration.parameters"
        return f"has the column {name}, but the calibration searches one {name} for all lines; {remedy}"
    guess = next(iter(difflib.get_close_matches(name, known, n=1)), None)
    remedy = f"did you mean {guess}?" if guess else f"there are {', '.join(known)}"
    return f"has the unknown column {name[:60]!r}; {remedy}"


def header_faults(names: list[str], units: list[str], known: Mapping) -> Iterator[str]:
    """The faults of the header."""
    yield from (unknown_column(name, known) for name in names if name not in known)
    yield from (f"has the column {name} twice; keep one" for name in sorted(set(names)) if names.count(name) > 1)
    yield from (f"has no column {name} ({COLUMNS[name][0]}); add it" for name in REQUIRED if name not in names)
    for name, unit in zip(names, units, strict=True):
        expected = COLUMNS[name][0] if name in COLUMNS else UNITS.get(name)
        if unit and name in known and HEADER_UNITS.get(unit, ("", 0.0))[0] != expected:
            yield f"states {name} in {unit!r}; give it in {expected}, without the unit in the header"
    stated = dict(zip(names, units, strict=True))
    for name, other_name in (("velocity", "sd"), ("sd", "velocity")):
        if stated.get(name) not in (None, "", "m/s") and stated.get(other_name) == "":
            yield f"states {name} in {stated[name]}, and no unit of {other_name}; state the units of both"


def value_fault(name: str, value: float, interval: tuple[float, float]) -> str | None:
    """What is wrong with a number in SI units."""
    shown, (low, high) = f"{name} = {value:g}", interval
    if name == "acceleration" and value < 0.0:
        return f"{shown} must not be negative; give the amplitude of the vibration"
    if not low <= value <= high:
        return f"{shown} is outside [{low:g}, {high:g}]; give it in SI units (angles in rad)"
    if name in POSITIVE and value == 0.0:
        return f"{shown} must be more than 0; correct it" + (", or leave sd empty" if name == "sd" else "")
    return None


def plate_velocity(acceleration: float, model: Mapping[str, Any]) -> float:
    """Bound of the velocity of the plate along the track (m/s) at an amplitude (m/s²)."""
    shape = 1.0 + sum(harmonic["along"] / harmonic["order"] for harmonic in model.get("harmonics", ()))
    return acceleration * math.cos(model.get("angle", 0.0)) / (2.0 * math.pi * model["frequency"]) * shape


def largest_velocity(row: Measurement, model: Mapping[str, Any]) -> float:
    """Bound of the velocity of a part (m/s): the plate's, and what gravity adds on an inclined track."""
    row_model = {**model, **row.changed}
    fall = row_model["gravity"] * abs(math.sin(row_model.get("inclination", 0.0)))
    return plate_velocity(row.acceleration, row_model) + fall * (row.before + row.duration)


def unit_faults(rows: list[Measurement], model: Mapping[str, Any], stated: str) -> list[tuple[int, str]]:
    """Line and description of velocities that no part on this plate can have, and for their errors: other units.

    stated : unit of the velocities in the header, or ""
    """
    bounds = [largest_velocity(row, model) for row in rows]
    fast = [(row, bound) for row, bound in zip(rows, bounds, strict=True) if abs(row.velocity) > TOO_FAST * bound]
    if not fast:
        return [
            (
                row.line,
                f"sd = {row.sd:g} m/s is larger than the largest velocity of the plate ({bound:.3g} m/s); give it in "
                "m/s, or leave sd empty",
            )
            for row, bound in zip(rows, bounds, strict=True)
            if row.sd is not None and row.sd > bound
        ]
    # The factor by which most velocities exceed half of the plate's velocity, and the unit that explains it.
    factor = median(abs(row.velocity) / (0.5 * bound) for row, bound in fast)
    units = {100.0: "cm/s: divide by 100", 1000.0: "mm/s: divide by 1000", 60.0: "m/min: divide by 60"}
    nearest = min(units, key=lambda unit_factor: abs(math.log(factor / unit_factor)))
    row, bound = fast[0]
    unit = f"{stated}, as the header says, or {units[nearest]}" if stated else units[nearest]
    remedy = f"is the velocity in {unit}? Is the acceleration in g: multiply by 9.81?"
    extent = f" ({len(fast)} lines of {len(rows)} are like this)" if len(fast) > 1 else ""
    return [
        (
            row.line,
            f"velocity = {row.velocity:g} m/s is impossible, because the plate moves at most at {bound:.3g} m/s "
            f"with {row.changed.get('frequency', model['frequency']):g} Hz; {remedy}{extent}",
        )
    ]


def height_faults(rows: list[Measurement], model: Mapping[str, Any]) -> list[tuple[int, str]]:
    """Line and description of initial heights at which the part would be in the plate at any time."""
    faults = []
    for row in rows:
        row_model = {**model, **row.changed}
        shape = 1.0 + sum(harmonic["normal"] / harmonic["order"] ** 2 for harmonic in row_model.get("harmonics", ()))
        normal = row.acceleration * math.sin(row_model.get("angle", 0.5 * math.pi))
        stroke = shape * normal / (2.0 * math.pi * row_model["frequency"]) ** 2
        if row.changed.get("z0", 0.0) < -stroke:
            fault = f"z0 = {row.changed['z0']:g} m is in the plate, which moves by at most ±{stroke:.3g} m"
            faults.append((row.line, f"{fault}; give the height above its mean position"))
    return faults


def wanted(header: str) -> bool:
    """Whether the header of a column names a quantity of a measurement."""
    return re.split(r"[\s(\[]", header.strip().lower())[0] in (*COLUMNS, *RANGES)


def read_values(table: Any, known: Mapping) -> tuple[dict[str, Any], list[tuple[int, str]]]:
    """The numbers in each column, in SI units (NaN where a field is empty), and the faults of lines."""
    columns, faults = {}, []
    for place, (name, unit) in enumerate(zip(table.names, table.units, strict=True)):
        values, wrong = table.numbers(place, name)
        columns[name] = values * (HEADER_UNITS[unit][1] if unit else 1.0)
        empty = set(table.lines[(table.fields[place] == "").to_numpy()].tolist())
        faults += [(line, fault) for line, fault in wrong if name in REQUIRED or line not in empty]
        read = dict(zip(table.lines.tolist(), columns[name].tolist(), strict=True))
        for line, _ in wrong:
            del read[line]
        faults += [(line, fault) for line, value in read.items() if (fault := value_fault(name, value, known[name]))]
    return columns, sorted(faults, key=lambda pair: pair[0])


def parse(table: Any, settings: Mapping[str, Any]) -> list[Measurement]:
    """The measurements in a table of common.csv_table, whose error names every fault with file and line.

    settings : `parameters`, which the measurements must determine, and the `model`, from which a row may differ
    """
    known = known_columns(settings["parameters"])
    parameters = len(settings["parameters"])
    table = table._replace(names=[name.lower().strip() for name in table.names])
    if faults := list(header_faults(table.names, table.units, known)):
        raise table.error((table.header, fault) for fault in faults)
    if len(table.lines) > MOST_ROWS:
        raise table.error([(table.lines[MOST_ROWS], f"has more than {MOST_ROWS} measurements; give fewer")])
    columns, faults = read_values(table, known)
    if faults:
        raise table.error(faults)
    rows = [
        measurement_of(line, {name: float(values[row]) for name, values in columns.items()})
        for row, line in enumerate(table.lines.tolist())
    ]
    stated = dict(zip(table.names, table.units, strict=True))["velocity"]
    if faults := unit_faults(rows, settings["model"], stated) or height_faults(rows, settings["model"]):
        raise table.error(faults)
    if len(rows) < parameters:
        remedy = "measure more, or calibrate fewer with calibration.parameters"
        count = f"{len(rows)} measurement{'s' if len(rows) != 1 else ''}"
        last = rows[-1].line if rows else table.header
        raise table.error([(last, f"{count} cannot determine {parameters} parameters; {remedy}")])
    return rows


def measurement_of(line: int, values: Mapping[str, float]) -> Measurement:
    """The measurement of a line."""
    stated = {name: value for name, value in values.items() if not math.isnan(value)}
    columns = {name: DEFAULTS.get(name) for name in COLUMNS} | {
        name: stated.pop(name) for name in COLUMNS if name in stated
    }
    return Measurement(line, **columns, changed=stated)
