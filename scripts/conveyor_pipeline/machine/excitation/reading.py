"""Recordings of an accelerometer: from the table in a file to the plate's acceleration over time.

The config check reads the file before any job starts, so this module imports nothing slower than NumPy.
"""

import itertools
import math
import re
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from conveyor_pipeline.common.csv_table import DELETE, MOST_FAULTS, remedy_of_order

STANDARD_GRAVITY = 9.80665  # m/s², the unit g
UNITS = {"m/s²": 1.0, "g": STANDARD_GRAVITY, "mm/s²": 1e-3, "mg": 1e-3 * STANDARD_GRAVITY}
TIME_UNITS = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}
# How the header of a file may write a unit.
SPELLINGS = {
    **dict.fromkeys(("m/s^2", "m/s2", "m/s/s", "m/sec^2", "m/s**2", "ms^-2", "ms-2", "m s^-2", "m·s⁻²"), "m/s²"),
    **dict.fromkeys(("mm/s^2", "mm/s2", "mm/s/s"), "mm/s²"),
    **{"G": "g", "gee": "g", "g0": "g", "mG": "mg", "milli-g": "mg", "sec": "s", "seconds": "s", "second": "s"},
    **{"msec": "ms", "milliseconds": "ms", "us": "µs", "usec": "µs", "μs": "µs", "microseconds": "µs"},
    **{"nanoseconds": "ns", "hh:mm:ss": "s"},
}
LONG_UNITS = ("min", "minutes", "h", "hours", "d", "days")  # of times, which nobody writes with enough digits
HEADER_UNITS = (*UNITS, *TIME_UNITS, *SPELLINGS, *LONG_UNITS)
# The axes of the plate, which are columns of a file, in words.
DIRECTIONS = {"along": "along the track", "normal": "normal to the track"}
AXES, SENSOR = tuple(DIRECTIONS), ("x", "z")  # the two pairs of columns
MOST_SAMPLES = 2_000_000  # 80 s at 25 kHz; the fit of more takes minutes and gigabytes, and gains nothing
MOST_BYTES = 50 * MOST_SAMPLES
LEAST_SAMPLES = 64  # eight cycles of eight samples
ANOTHER_RATE = 1.001  # largest ratio of a stated rate to that of the times; the frequency has the same error
EXAMPLE = 'time,along,normal, or excitation.columns names them by number, such as {time: "1", x: "2", z: "3"}'
# Names of columns that need no `columns` in the config: phyphox writes `Acceleration x (m/s^2)`, others accel_x or ax.
KNOWN = {"time": re.compile(r"(time|timestamp|t|(time|timestamp|t)[ _](s|ms|us|µs|ns))", re.IGNORECASE)}
KNOWN |= {name: re.compile(name, re.IGNORECASE) for name in AXES}
KNOWN |= {name: re.compile(rf"((linear )?acc(el|eleration)?[ _.]?|a)?{name}", re.IGNORECASE) for name in SENSOR}

# The three axes of a sensor; the size of a mean over gravity that no offset has; and the share of the vibration along
# the track in the axis that is not used, from which the sensor may be turned: the amplitude would be 4 % too small.
OF_SENSOR = re.compile(r"((linear )?acc(el|eleration)?[ _.]?|a)?[xyz]", re.IGNORECASE)
GRAVITY, TURNED = (0.5, 1.5), 0.3


class Recording(NamedTuple):
    """Acceleration of the plate over time, with gravity and offsets of the sensor."""

    time: np.ndarray  # s, ascending, shape (n,)
    acceleration: np.ndarray  # m/s², along and normal to the track, shape (2, n)
    columns: tuple[str, str]  # of the readings
    readings: np.ndarray  # m/s², as the sensor has measured them, shape (2, n)
    quanta: np.ndarray  # m/s², smallest difference between two readings of each column, shape (2,)
    lines: np.ndarray  # of the file, shape (n,)
    names: dict[str, str]  # of the columns in the file, by `time`, `x`, …, with a minus for a reversed axis
    unit: str  # of the readings in the file, one of UNITS
    time_unit: str  # of the times in the file, one of TIME_UNITS
    sampling: str = "stamped"  # how the times follow from the file; see sample_times.py
    repeated: int = 0  # lines that repeat the readings of the line before, and that are left out
    rate_error: float = 0.0  # relative standard error of the sampling rate
    across: float = 0.0  # vibration in the unused axis over that along the track; a turned sensor causes it
    resolution: float = 0.0  # s, to which uneven times are rounded
    others: tuple["Recording", ...] = ()  # the same with other times that its signal fits about as well


def is_known(header: str) -> bool:
    """Whether the header of a column says what it is, without `columns` in the config."""
    name = re.sub(r"\s*[(\[<{/].*", "", header.lstrip("# ")).strip()
    return any(pattern.fullmatch(name) for pattern in KNOWN.values())


def wanted(settings: Mapping[str, Any]) -> Callable[[str], bool]:
    """A function that says whether the header of a column is one that the settings or KNOWN name."""
    named = {name.lstrip("-").strip().lower() for name in settings.get("columns", {}).values()}
    named |= {name.strip().lower() for name in settings.get("columns", {}).values()}
    return lambda header: is_known(header) or bool(named & spellings_of(header))


def unit_behind(name: str, units: str) -> str:
    """The unit at the end of a name, such as time_ms or accel_x_g, of a list with bars between them; empty for none."""
    written = re.search(rf"[ _]({units})$", name, re.IGNORECASE)
    return written[1].lower() if written else ""


def spellings_of(header: str) -> set[str]:
    """The names under which the config may state a column: with and without its unit and a leading #."""
    whole = header.strip().lower()
    bare = whole.lstrip("# ")
    return {whole, bare, re.sub(r"\s*[(\[][^()\[\]]*[)\]]$", "", bare), re.sub(r"\s*/[^/]*$", "", bare)}


def quote(name: str) -> str:
    """A name as YAML."""
    return name if re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) else f'"{name}"'


def columns_entry(names: Mapping[str, str]) -> str:
    """The entry `excitation.columns` of the config."""
    return "excitation.columns: {" + ", ".join(f"{key}: {quote(name)}" for key, name in names.items()) + "}"


def find_columns(table: Any, settings: Mapping[str, Any]) -> tuple[dict[str, str], dict[str, int], list[str]]:
    """Names of the columns with their signs, their places in the table, and faults."""
    stated, names = settings.get("columns", {}), table.names
    lower, listed = [name.lower() for name in names], ", ".join(quote(column) for column in names)
    chosen, places, faults = {}, {}, []
    for key, name in stated.items():
        sign, bare = ("-", name[1:]) if name.startswith("-") and name.lower() not in lower else ("", name)
        matches = [place for place, lowered in enumerate(lower) if lowered in spellings_of(bare)]
        if len(matches) == 1:
            chosen[key], places[key] = sign + names[matches[0]], matches[0]
        elif matches:
            faults.append(f"has the column {bare!r} twice, so excitation.columns.{key} names two; rename one")
        else:
            faults.append(f"has no column {bare!r}, which excitation.columns.{key} names; there are {listed}")
    for key, other_key in itertools.combinations(places, 2):
        if places[key] == places[other_key]:
            faults.append(f"has one column {names[places[key]]!r} for both {key} and {other_key} in excitation.columns")
    pairs = [pair for pair in (AXES, SENSOR) if {*pair} & {*stated}]
    if len(pairs) == 2:
        faults.append("has x, z and along, normal in excitation.columns; name one pair")
    exact = [pair for pair in (AXES, SENSOR) if set(pair) <= set(lower)]
    if not pairs and len(exact) == 2:
        faults.append("has both along, normal and x, z; name one pair in excitation.columns")
    if faults:
        return chosen, places, faults
    partial = [pair for pair in (AXES, SENSOR) if any(KNOWN[key].fullmatch(name) for key in pair for name in names)]
    pair = (pairs or exact or partial or [AXES])[0]
    missing = []
    for key in (*(() if "rate" in settings else ("time",)), *pair):
        if key in chosen:
            continue
        free = [(place, name) for place, name in enumerate(names) if place not in places.values()]
        matches = [place for place, name in free if KNOWN[key].fullmatch(name)]
        if len(matches) == 1:
            chosen[key], places[key] = names[matches[0]], matches[0]
        elif len({lower[place] for place in matches}) == 1:
            faults.append(f"has the column {lower[matches[0]]} twice; keep one, or rename one")
        elif matches:
            shown = " and ".join(quote(names[place]) for place in matches)
            faults.append(f"has the columns {shown}; say which one is {key} in excitation.columns")
        else:
            missing.append(key)
    if missing and not faults:
        guess = {key: chosen.get(key) or guess_column(key, names, chosen) for key in ("time", *pair)}
        if "rate" in settings:
            del guess["time"]
        or_rate = ", or state excitation.rate (Hz) in place of a time" if "time" in missing else ""
        faults.append(
            f"has no column {' and no column '.join(missing)}; there are {listed}. Say which is which by "
            f"{columns_entry(guess)} (or x and z){or_rate}"
        )
    return chosen, places, faults


def guess_column(key: str, names: list[str], chosen: Mapping[str, str]) -> str:
    """The column that is most like a key, for messages."""
    import difflib

    free = [name for name in names if name not in chosen.values()]
    close = difflib.get_close_matches(key, [name.lower() for name in free], n=1, cutoff=0.5)
    return next((name for name in free if close and name.lower() == close[0]), "…")


def plain(unit: str) -> str:
    """A unit as UNITS and TIME_UNITS spell it, whatever its capitals, or as it is if it is not known."""
    known = {name: name for name in (*UNITS, *TIME_UNITS)} | SPELLINGS
    return known.get(unit) or known.get(unit.lower(), unit)


def unit_of(stated: str | None, headers: list[str], units: Mapping[str, float], key: str) -> tuple[str, list[str]]:
    """The unit of columns, from the config, the header, or else the first of `units`, and faults."""
    header_units = {plain(header) for header in headers if header}
    shown = " and ".join(sorted(header_units))
    choice = f"state excitation.{key} ({', '.join(units)})"
    if stated:
        fault = f"states the unit {shown}, but excitation.{key} is {stated}; leave {key} out, or correct the header"
        return stated, [fault] if header_units & set(units) - {stated} else []
    if len(header_units) > 1:
        return shown, [f"states the units {shown}; {choice}"]
    named = next(iter(header_units), next(iter(units)))
    measured_quantity = "a time" if key == "time_unit" else "an acceleration"
    otherwise = f"; if that is not the unit of {measured_quantity}, name other columns in excitation.columns"
    return named, [] if named in units else [f"states the unit {shown!r}; {choice}{otherwise}"]


def rate_fault(table: Any, rate: float) -> str | None:
    """The contradiction between a stated rate (Hz) and the times of a file, whose unit may not be known."""
    place = next((place for place, name in enumerate(table.names) if KNOWN["time"].fullmatch(name)), None)
    if place is None or len(table.lines) < 2:
        return None
    unit = plain(table.units[place])
    if unit and unit not in (*TIME_UNITS, *LONG_UNITS):  # a temperature T
        return None
    seconds, wrong = table.seconds(place, 1.0)
    name = quote(table.names[place])
    remedy = remedy_of_order(seconds) if np.isfinite(seconds).all() else ""
    if remedy and (line := line_of_restart(table, seconds)):
        fault = f"has times that go back in line {line}, which excitation.rate would ignore"
        return f"{fault}; {remedy}, or delete the column {name} if it holds no times"
    if wrong or seconds[-1] <= seconds[0]:
        return None
    stated = TIME_UNITS.get(unit)
    raw_rate = (len(seconds) - 1) / (seconds[-1] - seconds[0])
    rates = [raw_rate / unit for unit in ([stated] if stated else TIME_UNITS.values())]
    nearest = min(rates, key=lambda candidate: abs(math.log(candidate / rate)))
    steps = np.diff(seconds)
    coarse = steps.max() / (seconds[-1] - seconds[0])  # relative error of the duration by rounding
    if (1.0 - coarse) / ANOTHER_RATE < nearest / rate < ANOTHER_RATE * (1.0 + coarse):
        return None
    return (
        f"has the column {name} with {nearest:.6g} samples per second, but excitation.rate is {rate:g}; correct the "
        f"rate, or leave it out, or delete the column {name} if its times are wrong"
    )


def line_of_restart(table: Any, seconds: np.ndarray) -> int | None:
    """The line of the first step back of times (s) in reverse order, or of a second run, which begins as the first one.

    None for other times: a clock that overflows begins elsewhere.
    """
    steps = np.diff(seconds)
    back = np.flatnonzero(steps < 0.0) + 1
    is_reversed = len(back) > 0 and (steps <= 0.0).all()
    begins_again = len(back) == 1 and abs(seconds[back[0]] - seconds[0]) <= 2.0 * np.median(np.abs(steps))
    return int(table.lines[back[0]]) if is_reversed or begins_again else None


def quantum(readings: np.ndarray) -> float:
    """Smallest difference between two distinct readings; 0 if all are equal."""
    steps = np.diff(np.unique(readings))
    steps = steps[steps > 1e-9 * np.ptp(readings)]  # not the rounding of numbers in another unit
    return float(steps.min()) if len(steps) else 0.0


def turn(readings: np.ndarray, mount: float) -> np.ndarray:
    """Readings of a sensor whose x axis points by `mount` (rad) above the track, along and normal to the track."""
    cosine, sine = math.cos(mount), math.sin(mount)
    return np.array([readings[0] * cosine - readings[1] * sine, readings[0] * sine + readings[1] * cosine])


def parse(table: Any, settings: Mapping[str, Any]) -> Recording:
    """The recording in a table of common.csv_table; its error names every fault with file and line.

    settings : `mount` (rad), the angle of the sensor, and optionally `unit`, `columns`, `time_unit` and `rate` (Hz)
    """
    names, places, faults = find_columns(table, settings)
    if faults:
        raise table.error((table.header, fault) for fault in faults)
    pair = AXES if AXES[0] in names else SENSOR
    units = [table.units[places[key]] or unit_behind(names[key], "g|mg") for key in pair]
    unit, faults = unit_of(settings.get("unit"), units, UNITS, "unit")
    mount = settings["mount"]
    rate = settings.get("rate")
    if pair == AXES and mount != 0.0:
        remedy = f"name the columns by {columns_entry(rename(names))}, or leave mount out"
        faults.append(f"has columns along and normal, but excitation.mount = {mount} turns x and z only; {remedy}")
    time_unit = "s"
    if rate is None:
        header = table.units[places["time"]] or unit_behind(names["time"], "s|sec|ms|us|µs|ns|min|h")
        time_unit, time_faults = unit_of(settings.get("time_unit"), [header], TIME_UNITS, "time_unit")
        if header in LONG_UNITS:
            time_faults = [
                f"states times in {header}; export them in one of {', '.join(TIME_UNITS)}, or state excitation.rate"
            ]
        faults += time_faults
    elif fault := rate_fault(table, rate):
        faults.append(fault)
    if faults:
        raise table.error((table.header, fault) for fault in faults)
    readings = []
    lines = table.lines
    for key in pair:
        values, wrong = table.numbers(places[key], key, remedy_of_line(rate is not None))
        readings.append(-values if names[key].startswith("-") and names[key] not in table.names else values)
        faults += wrong
    across = 0.0
    if not faults and pair == SENSOR:
        is_stated = bool({*SENSOR} & {*settings.get("columns", {})})
        across, wrong = third_axis(table, names, places, turn(np.array(readings), mount)[0], unit, is_stated)
        faults += wrong
    if rate is None:
        time, wrong = table.seconds(places["time"], TIME_UNITS[time_unit])
        faults += wrong
    else:
        time = np.arange(len(lines)) / rate
    if len(lines) < LEAST_SAMPLES:
        remedy = "record at least eight cycles with eight samples each"
        faults.append((int(lines[-1]) if len(lines) else table.header, f"ends after {len(lines)} samples; {remedy}"))
    if len(lines) > MOST_SAMPLES:
        remedy = "keep a piece of the file; a few hundred cycles are enough"
        faults.append((None, f"has {len(lines):,} samples, more than {MOST_SAMPLES:,}; {remedy}"))
    if faults:
        raise table.error(shorten(faults))
    accelerations = UNITS[unit] * np.array(readings)
    quanta = np.array([quantum(signal) for signal in accelerations])
    return Recording(
        *(time, turn(accelerations, mount), pair, accelerations, quanta, lines, names, unit, time_unit),
        sampling="stamped" if rate is None else "rate",
        across=across,
    )


def third_axis(
    table: Any, names: Mapping[str, str], places: Mapping[str, int], along: np.ndarray, unit: str, is_stated: bool
) -> tuple[float, list[tuple[int, str]]]:
    """The share of the vibration along the track that the unused third axis of a sensor has, and faults.

    Of a turned sensor, the share is the tangent of the angle; noise and a vibration out of phase have no part in it.

    is_stated : whether the config states x or z; then the plate may vibrate across the track, and the share is 0
    """
    free = [place for place, name in enumerate(table.names) if place not in places.values()]
    free = [place for place in free if OF_SENSOR.fullmatch(table.names[place])]
    if len(free) != 1:
        return 0.0, []
    values, wrong = table.numbers(free[0], table.names[free[0]])
    if wrong or not len(values):
        return 0.0, []
    name = table.names[free[0]]
    if GRAVITY[0] < abs(values.mean()) * UNITS[unit] / STANDARD_GRAVITY < GRAVITY[1]:
        shown = f"has gravity in the column {name}, which is not used"
        remedy = f"set {columns_entry({**names, 'z': name})}, and check x"
        return 0.0, [(table.header, f"{shown}: the axis normal to the track is {name}; {remedy}")]
    if is_stated:
        return 0.0, []
    share = float(abs(np.cov(along, values)[0, 1])) / max(float(np.var(along, ddof=1)), 1e-300)
    if share <= TURNED:
        return share, []
    proposed = {**names, "x": name} if share > 1.0 else names
    fault = (
        f"vibrates in the column {name}, which is not used, with {share:.2g} times the vibration in "
        f"{quote(names['x'])}: the sensor may be turned about its normal by {math.degrees(math.atan(share)):.0f}°, so "
        f"that the amplitude would be too small; turn it, or say which axis is along the track by "
        f"{columns_entry(proposed)}"
    )
    return share, [(table.header, fault)]


def remedy_of_line(is_counted: bool) -> str:
    """What to do with a line without a reading; where lines are counted, those behind it would get wrong times."""
    return (
        "keep a piece of the file without such lines, because excitation.rate counts all of them"
        if is_counted
        else DELETE
    )


def rename(names: Mapping[str, str]) -> dict[str, str]:
    """The columns along and normal as x and z of a sensor."""
    keys = dict(zip(AXES, SENSOR, strict=True))
    return {keys.get(key, key): name for key, name in names.items()}


def shorten(faults: list) -> list:
    """The first faults in the order of their lines, the remedy of equal ones once."""
    faults = sorted(faults, key=lambda fault: fault[0] or 0)
    if len(faults) <= MOST_FAULTS:
        return faults
    line, last = faults[MOST_FAULTS - 1]
    return [*faults[: MOST_FAULTS - 1], (line, f"{last} ({len(faults) - MOST_FAULTS:,} further lines have faults)")]
