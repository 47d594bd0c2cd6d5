"""Files of an accelerometer: read the samples, and name what is wrong with the text, by file and line.

The config check reads the file before any job starts, so this module imports nothing slower than NumPy.
"""

import csv
import difflib
import io
import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

STANDARD_GRAVITY = 9.80665  # m/s², the unit g
UNITS = {"m/s²": 1.0, "g": STANDARD_GRAVITY}
# The axes of the plate, which are columns of a file, in words.
DIRECTIONS = {"along": "along the track", "normal": "normal to the track"}
AXES, SENSOR = tuple(DIRECTIONS), ("x", "z")  # the two pairs of columns
NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eE][-+]?\d+)?")
MOST_SAMPLES = 2_000_000  # 80 s at 25 kHz; the fit of more takes minutes and gigabytes, and gains nothing
MOST_BYTES = 50 * MOST_SAMPLES
LEAST_SAMPLES = 64  # eight cycles of eight samples
MOST_FAULTS = 5
# Share of the lines that may repeat the time of the line before, as rounded times of random samples do. Where rounding
# makes more of them equal, it is coarse enough to blur the harmonics.
MOST_EQUAL = 0.05


class RecordingError(ValueError):
    """A file of an accelerometer that cannot be used: one line for each fault, with file, line number and remedy."""

    def __init__(self, faults: list[str]):
        self.faults = faults
        super().__init__("\n".join(faults))


class Recording(NamedTuple):
    """Acceleration of the plate over time, with gravity and offsets of the sensor."""

    time: np.ndarray  # s, ascending, shape (n,)
    acceleration: np.ndarray  # m/s², along and normal to the track, shape (2, n)
    columns: tuple[str, str]  # of the readings
    readings: np.ndarray  # m/s², as the sensor has measured them, shape (2, n)
    quanta: np.ndarray  # m/s², smallest difference between two readings of each column, shape (2,)


def read_text(path: str | Path) -> str:
    """The text of a CSV file; RecordingError says why it cannot be read."""
    try:
        if Path(path).stat().st_size > MOST_BYTES:
            remedy = f"keep a piece of at most {MOST_SAMPLES:,} samples; a few hundred cycles are enough"
            raise RecordingError([f"{path}: is larger than {MOST_BYTES:,} bytes; {remedy}"])
        return Path(path).read_bytes().decode("utf-8-sig")
    except OSError as error:
        remedy = "excitation.measured names a CSV file, relative to its overlay, or else to the working directory"
        raise RecordingError([f"{path}: {error.strerror}; {remedy}"]) from error
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise RecordingError([f"{path}:{line}: is not UTF-8 text; export the table as CSV with UTF-8"]) from error


def split(line: str, separator: str) -> list[str]:
    """The fields of a line."""
    return [field.strip() for field in next(csv.reader([line], delimiter=separator, skipinitialspace=True))]


def fields_of(text: str, first: int, separator: str) -> Iterator[tuple[int, list[str]]]:
    """Line number and fields of each line from line `first` on, without comments and empty lines."""
    for line, content in enumerate(text.splitlines(), 1):
        stripped = content.strip()
        if line >= first and stripped and stripped[0] != "#":
            yield line, split(stripped, separator)


def header_of(text: str) -> tuple[int, list[str], str]:
    """Line number of the header, the names of its columns, and what separates them."""
    for line, content in enumerate(text.splitlines(), 1):
        stripped = content.strip()
        # Excel's line that names the separator.
        if stripped and not stripped.startswith("#") and not re.fullmatch(r'"?sep=."?', stripped):
            separator = next((one for one in ";\t" if one in content), ",")
            return line, [name.lower() for name in split(stripped, separator)], separator
    return 1, [], ","


def header_faults(names: list[str]) -> list[str]:
    """The faults of the header."""
    if not names:
        return ["is empty; the first line names the columns, such as time,along,normal"]
    if any(NUMBER.fullmatch(name) for name in names):
        return ["begins with numbers; the first line must name the columns, such as time,along,normal"]
    known = ("time", *AXES, *SENSOR)
    if twice := sorted({name for name in names if name in known and names.count(name) > 1}):
        return [f"has the column {twice[0]} twice; keep one"]
    complete = [pair for pair in (AXES, SENSOR) if set(pair) <= set(names)]
    if len(complete) == 2:
        return ["has both along, normal and x, z; keep one pair"]
    if complete and "time" in names:
        return []
    missing = ("time", *(complete or [SENSOR if {*SENSOR} & {*names} else AXES])[0])
    faults = []
    for name in (name for name in missing if name not in names):
        like = [other for other in names if other not in known]
        base = [other for other in like if re.split(r"[\s(\[_]", other)[0] in (name, name[0])]
        guess = next(iter(base or difflib.get_close_matches(name, like, n=1)), None)
        remedy = f"rename {guess!r} to {name}, without a unit" if guess else "add it"
        faults.append(f"has no column {name}; {remedy} (columns: time in s, and along, normal or x, z)")
    return faults


def value_of(name: str, text: str, separator: str) -> float:
    """The number in a field; ValueError states its fault."""
    shown = f"{name} = {text[:40]!r}"
    if not text:
        raise ValueError(f"has no {name}; delete the line")
    if text.lstrip("+-").lower() in ("nan", "inf", "infinity"):
        raise ValueError(f"{shown} is not a measured number; delete the line")
    if not NUMBER.fullmatch(text):
        raise ValueError(f"{shown} is text; write a number without its unit")
    if "," in text and separator == ",":
        raise ValueError(f"{shown} has a decimal comma; write {text.replace(',', '.')}")
    if not math.isfinite(value := float(text.replace(",", "."))):
        raise ValueError(f"{shown} is not a measured number; delete the line")
    return value


def read_slowly(
    text: str, path: str | Path, first: int, names: list[str], separator: str, used: tuple[str, ...]
) -> np.ndarray:
    """The columns `used`, shape (3, n), line by line; RecordingError names each line that has a fault."""
    rows, faults, equal, before = [], [], [], -math.inf
    places = [names.index(name) for name in used]
    for line, fields in fields_of(text, first + 1, separator):
        try:
            if len(fields) != len(names):
                if separator == "," and len(fields) >= 2 * len(names) - 1:
                    raise ValueError(
                        f"has {len(fields)} values for {len(names)} columns, perhaps because of decimal commas; "
                        "export with semicolons between columns, or with points in numbers"
                    )
                raise ValueError(f"has {len(fields)} values for {len(names)} columns; leave no field out")
            row = [value_of(name, fields[place], separator) for name, place in zip(used, places, strict=True)]
            if row[0] < before:
                raise ValueError(f"time = {fields[places[0]]} is earlier than the line before; sort the lines")
            if row[0] == before:
                equal.append(line)
            before = row[0]
            rows.append(row)
        except ValueError as error:
            faults.append(f"{path}:{line}: {error}")
            if len(faults) == MOST_FAULTS:
                break
    if not faults and len(equal) > MOST_EQUAL * len(rows):
        count = f"and {len(equal) - 1:,} further lines repeat" if len(equal) > 1 else "repeats"
        remedy = "export the time with more digits, or each line once"
        faults = [f"{path}:{equal[0]}: {count} the time of the line before; {remedy}"]
    if faults:
        raise RecordingError(faults)
    return np.array(rows, dtype=np.float64).reshape(-1, len(used)).T


def read_columns(
    text: str, path: str | Path, first: int, names: list[str], separator: str, used: tuple[str, ...]
) -> np.ndarray:
    """The columns `used`, shape (3, n), by NumPy's reader, which is fast but names no faults."""
    body = "\n".join(text.splitlines()[first:])
    if separator != ",":
        body = body.replace(",", ".")
    try:
        rows = np.loadtxt(io.StringIO(body), delimiter=separator, ndmin=2)
        columns = rows[:, [names.index(name) for name in used]].T
    except (ValueError, IndexError):
        return read_slowly(text, path, first, names, separator, used)
    steps = np.diff(columns[0])
    is_ascending = (steps >= 0.0).all() and np.count_nonzero(steps == 0.0) <= MOST_EQUAL * len(rows)
    is_right = rows.shape[1] == len(names) and np.isfinite(columns).all() and is_ascending
    return columns if is_right else read_slowly(text, path, first, names, separator, used)


def quantum(readings: np.ndarray) -> float:
    """Smallest difference between two distinct readings; 0 if all are equal."""
    steps = np.diff(np.unique(readings))
    steps = steps[steps > 1e-9 * np.ptp(readings)]  # not the rounding of numbers in another unit
    return float(steps.min()) if len(steps) else 0.0


def parse(text: str, path: str | Path, settings: Mapping[str, Any]) -> Recording:
    """The recording in a CSV text; RecordingError names every fault with file and line.

    settings : `unit`, one of UNITS, and `mount` (rad), the angle of the sensor
    """
    if "\x00" in text:
        raise RecordingError([f"{path}:1: is not a CSV text; export the table as CSV with UTF-8"])
    first, names, separator = header_of(text)
    if faults := header_faults(names):
        raise RecordingError([f"{path}:{first}: {fault}" for fault in faults])
    pair = AXES if set(AXES) <= set(names) else SENSOR
    mount = settings["mount"]
    if pair == AXES and mount != 0.0:
        remedy = "name the columns x and z, or leave mount out"
        raise RecordingError([f"{path}:{first}: excitation.mount = {mount} turns the columns x, z only; {remedy}"])
    time, *readings = read_columns(text, path, first, names, separator, ("time", *pair))
    if len(time) < LEAST_SAMPLES:
        last = len(text.splitlines())
        remedy = "record at least eight cycles with eight samples each"
        raise RecordingError([f"{path}:{last}: ends after {len(time)} samples; {remedy}"])
    if len(time) > MOST_SAMPLES:
        remedy = "keep a piece of the file; a few hundred cycles are enough"
        raise RecordingError([f"{path}: has {len(time):,} samples, more than {MOST_SAMPLES:,}; {remedy}"])
    measured = UNITS[settings["unit"]] * np.array(readings)
    cosine, sine = math.cos(mount), math.sin(mount)
    turned = np.array([measured[0] * cosine - measured[1] * sine, measured[0] * sine + measured[1] * cosine])
    return Recording(time, turned, pair, measured, np.array([quantum(one) for one in measured]))


def line_of_sample(text: str, sample: int) -> int:
    """The line of a file that holds a sample."""
    first, _, separator = header_of(text)
    return next(line for place, (line, _) in enumerate(fields_of(text, first + 1, separator)) if place == sample)
