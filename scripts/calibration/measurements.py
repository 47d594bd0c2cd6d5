"""Measured velocities in a CSV file, and everything that can be wrong with such a file.

The Snakefile imports this module to check the file before any job starts, so it imports nothing slow.
"""

import csv
import difflib
import io
import itertools
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

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
# Initial conditions; a missing or empty value means that it was not known.
INITIAL = ("z0", "vz0", "psi0")
DEFAULTS = {"duration": 1.0, "before": 1.0}  # s
# Parameters that a calibration can search. A row cannot have its own value of a searched parameter.
CALIBRATED = ("friction", "damping", "stiffness", "angle", "inclination", "phase_shift", "exponent")
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
MOST_ROWS = 1000
MOST_BYTES = 1_000_000
# No friction drives a part faster than the plate. Noise may make it seem a little faster; other units, much faster.
TOO_FAST = 2.0


class MeasurementError(ValueError):
    """A file of measurements that cannot be used: one line for each fault, with file, line number and remedy."""

    def __init__(self, faults: list[str]):
        self.faults = faults
        super().__init__("\n".join(faults))


class Measurement(NamedTuple):
    """One measured velocity."""

    line: int  # of the file
    acceleration: float  # m/s²
    velocity: float  # m/s
    sd: float | None  # m/s
    duration: float  # s
    before: float  # s
    changed: dict[str, float]  # parameters of the model and initial conditions of this row


def read_text(path: str | Path) -> str:
    """The text of a CSV file; MeasurementError says why it cannot be read."""
    try:
        if Path(path).stat().st_size > MOST_BYTES:
            raise MeasurementError([f"{path}: is larger than {MOST_BYTES:,} bytes; give a CSV file of measurements"])
        return Path(path).read_bytes().decode("utf-8-sig")
    except OSError as error:
        remedy = "calibration.measurements names a CSV file, relative to its overlay, or else to the working directory"
        raise MeasurementError([f"{path}: {error.strerror}; {remedy}"]) from error
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise MeasurementError([f"{path}:{line}: is not UTF-8 text; export the table as CSV with UTF-8"]) from error


def first_comments(text: str) -> list[str]:
    """The comments before the header of a file of measurements."""
    lines = [stripped for line in text.splitlines() if (stripped := line.strip())]
    before = itertools.takewhile(lambda line: line.startswith("#"), lines)
    return [comment for line in before if (comment := line.strip("# "))]


def known_columns(parameters: Sequence[str], ranges: Mapping) -> dict[str, tuple[float, float]]:
    """The admissible interval of each column; a row cannot have its own value of a searched parameter."""
    others = {name: interval for name, interval in ranges.items() if name not in (*parameters, "static_friction")}
    return {**others, **{name: (low, high) for name, (_, low, high) in COLUMNS.items()}}


def unknown_column(name: str, known: Mapping) -> str:
    """Fault and remedy of a column with an unknown name."""
    if not name:
        return "has a column without a name; name it, or delete it"
    if name in CALIBRATED:  # the others are known
        remedy = f"delete the column, or take {name} out of calibration.parameters"
        return f"has the column {name}, but the calibration searches one {name} for all lines; {remedy}"
    base = re.split(r"[\s(\[]", name.strip().lower())[0]
    guess = base if base in known else next(iter(difflib.get_close_matches(name.lower(), known, n=1)), None)
    remedy = f"did you mean {guess}?" if guess else f"there are {', '.join(known)}"
    return f"has the unknown column {name[:60]!r}; {remedy}"


def check_header(header: list[str], known: Mapping) -> list[str]:
    """The faults of the first line."""
    faults = []
    if header[0].lower().startswith("sep="):
        return [f"is the line {','.join(header)!r}, which only Excel reads; delete it"]
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        kind = "semicolons" if ";" in header[0] else "tabs"
        return [f"separates columns by {kind}; export the table with commas, and with points in numbers (0.05)"]
    for name in header:
        if name not in known:
            faults.append(unknown_column(name, known))
    faults += [f"has the column {name} twice; keep one" for name in sorted(set(header)) if header.count(name) > 1]
    missing = [name for name in REQUIRED if name not in header]
    if any(NUMBER.fullmatch(name) for name in header):
        return ["begins with numbers; the first line must name the columns, such as acceleration,velocity"]
    faults += [f"has no column {name} ({COLUMNS[name][0]}); add it" for name in missing]
    return faults


def check_value(name: str, text: str, interval: tuple[float, float]) -> tuple[float | None, str | None]:
    """The number in a field and its fault; one of both is None, both for an empty optional field."""
    shown = f"{name} = {text[:40]!r}"
    if not text:
        return None, f"has no {name}; fill it in, or delete the line" if name in REQUIRED else None
    if not NUMBER.fullmatch(text):
        if text.lstrip("+-").lower() in ("nan", "inf", "infinity"):
            return None, f"{shown} is not a measured number; delete the line"
        if re.fullmatch(r"[-+]?\d+,\d+", text):
            return None, f"{shown} has a decimal comma; write {text.replace(',', '.')}"
        return None, f"{shown} is text; write a number in SI units, without the unit"
    value, (low, high) = float(text), interval
    if name == "acceleration" and value < 0.0:
        return None, f"{shown} must not be negative; give the amplitude of the vibration"
    if not math.isfinite(value) or not low <= value <= high:
        return None, f"{shown} is outside [{low:g}, {high:g}]; give it in SI units (angles in rad)"
    if name in POSITIVE and value == 0.0:
        return None, f"{shown} must be more than 0; correct it" + (", or leave sd empty" if name == "sd" else "")
    return value, None


def plate_velocity(measured: Measurement, model: Mapping[str, Any]) -> float:
    """Bound of the velocity of the plate along the track (m/s)."""
    own = {**model, **measured.changed}
    shape = 1.0 + sum(harmonic["along"] / harmonic["order"] for harmonic in own.get("harmonics", ()))
    return measured.acceleration * math.cos(own.get("angle", 0.0)) / (2.0 * math.pi * own["frequency"]) * shape


def largest_velocity(measured: Measurement, model: Mapping[str, Any]) -> float:
    """Bound of the velocity of a part (m/s): the plate's, and what gravity adds on an inclined track."""
    own = {**model, **measured.changed}
    fall = own["gravity"] * abs(math.sin(own.get("inclination", 0.0)))
    return plate_velocity(measured, model) + fall * (measured.before + measured.duration)


def unit_faults(rows: list[Measurement], model: Mapping[str, Any]) -> list[str]:
    """ "LINE: fault" for velocities that no part on this plate can have, and for their errors: other units."""
    bounds = [largest_velocity(row, model) for row in rows]
    fast = [(row, bound) for row, bound in zip(rows, bounds, strict=True) if abs(row.velocity) > TOO_FAST * bound]
    if not fast:
        return [
            f"{row.line}: sd = {row.sd:g} m/s is larger than the largest velocity of the plate ({bound:.3g} m/s); give "
            "it in m/s, or leave sd empty"
            for row, bound in zip(rows, bounds, strict=True)
            if row.sd is not None and row.sd > bound
        ]
    # The factor by which most velocities exceed half of the plate's velocity, and the unit that explains it.
    factor = median(abs(row.velocity) / (0.5 * bound) for row, bound in fast)
    units = {100.0: "cm/s: divide by 100", 1000.0: "mm/s: divide by 1000", 1000.0 / 60.0: "m/min: divide by 60"}
    nearest = min(units, key=lambda one: abs(math.log(factor / one)))
    row, bound = fast[0]
    remedy = f"is the velocity in {units[nearest]}? Is the acceleration in g: multiply by 9.81?"
    more = f" ({len(fast)} lines of {len(rows)} are like this)" if len(fast) > 1 else ""
    return [
        f"{row.line}: velocity = {row.velocity:g} m/s is impossible, because the plate moves at most at {bound:.3g} "
        f"m/s; {remedy}{more}"
    ]


def parse(text: str, path: str | Path, settings: Mapping[str, Any], ranges: Mapping) -> list[Measurement]:
    """The measurements of a CSV text; MeasurementError names every fault with file and line.

    settings : `parameters`, which the measurements must determine, and the `model`, from which a row may differ
    ranges : admissible interval of each parameter of the model; other modules import this one without the library
    """
    known, parameters = known_columns(settings["parameters"], ranges), len(settings["parameters"])
    if "\x00" in text:
        raise MeasurementError([f"{path}:1: is not a CSV text; export the table as CSV"])
    # Quotes in a comment begin no field.
    lines = ("\n" if line.lstrip().startswith("#") else line for line in io.StringIO(text, newline=""))
    reader = csv.reader(lines, skipinitialspace=True, strict=True)
    faults, rows, header = [], [], None
    try:
        for fields in reader:
            line, fields = reader.line_num, [field.strip() for field in fields]
            if not any(fields) or fields[0].startswith("#"):
                continue
            if header is None:
                header = fields
                faults = [f"{path}:{line}: {fault}" for fault in check_header(header, known)]
                if faults:
                    break
                continue
            row, wrong = parse_row(fields, header, line, known)
            faults += [f"{path}:{line}: {fault}" for fault in wrong]
            rows.append(row)
            if len(rows) > MOST_ROWS:
                faults.append(f"{path}:{line}: has more than {MOST_ROWS} measurements; give fewer")
                break
    except csv.Error as error:
        faults.append(f"{path}:{reader.line_num}: is not CSV ({error}); export the table as CSV")
    if header is None and not faults:
        faults = [f"{path}:1: is empty; the first line names the columns, such as acceleration,velocity"]
    if not faults:
        faults = [f"{path}:{fault}" for fault in unit_faults(rows, settings["model"])]
    if not faults and len(rows) < parameters:
        remedy = "measure more, or calibrate fewer with calibration.parameters"
        given = f"{len(rows)} measurement{'s' if len(rows) != 1 else ''}"
        faults = [f"{path}:{reader.line_num}: {given} cannot determine {parameters} parameters; {remedy}"]
    if faults:
        raise MeasurementError(faults)
    return rows


def parse_row(
    fields: list[str], header: list[str], line: int, known: Mapping[str, tuple[float, float]]
) -> tuple[Measurement | None, list[str]]:
    """The measurement of a line, or its faults."""
    if any(";" in field for field in fields):
        return None, ["has semicolons; separate columns by commas, and write points in numbers (0.05)"]
    if len(fields) != len(header):
        remedy = "use points, not commas, in numbers, and leave no field out"
        return None, [f"has {len(fields)} values for {len(header)} columns; {remedy}"]
    values, faults = {}, []
    for name, text in zip(header, fields, strict=True):
        values[name], fault = check_value(name, text, known[name])
        faults += [fault] if fault else []
    if faults:
        return None, faults
    given = {name: value for name, value in values.items() if value is not None}
    own = {name: DEFAULTS.get(name) for name in COLUMNS} | {name: given.pop(name) for name in COLUMNS if name in given}
    return Measurement(line, **own, changed=given), []
