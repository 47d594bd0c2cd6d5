"""Contradictions in the sections of the floor machine, as in config/checks.py."""

from collections.abc import Iterator

from conveyor_pipeline.common import csv_table
from conveyor_pipeline.common.axes import count_values, ends
from conveyor_pipeline.common.settings import check_span
from conveyor_pipeline.config.checks import LARGEST_TABLE
from conveyor_pipeline.config.derived import is_given, origins_of
from conveyor_pipeline.machine.calibration import measurements
from conveyor_pipeline.machine.excitation.limits import STATEMENT
from conveyor_pipeline.machine.operating.settings import transit_axis
from conveyor_pipeline.machine.operating.supply import FARTHEST

NO_MOTION = 1e-9  # m/s; with an angle of throw of 90°, rounding alone moves the plate along the track
AMPLITUDE_ERROR = 2.0  # no part has a drive whose amplitude is so many times the set one


def operating(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    section = config["operating"]
    yield from faults_of_runs("operating.starts", section["acceleration"], section["starts"])


def transit(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Faults of an axis that takes some of its keys from operating.acceleration, and of the parts and the track."""
    axis = transit_axis(config)
    if isinstance(axis, dict):
        if missing := [key for key in ("start", "stop", "num") if key not in axis]:
            remedy = "give start, stop and num, or remove transit.acceleration, so that operating.acceleration counts"
            yield f"transit.acceleration lacks {', '.join(missing)}, and operating.acceleration is a list; {remedy}"
            return
        try:
            check_span(axis)
        except ValueError as error:
            yield f"transit.acceleration, with what operating.acceleration adds, {error}"
            return
    yield from faults_of_runs("transit.parts", axis, config["transit"]["parts"])
    yield from faults_of_track(config, defaults, stated, largest=max(ends(axis)))


def faults_of_runs(key: str, axis: dict | list, number: int) -> Iterator[str]:
    runs = count_values(axis) * number
    if runs > LARGEST_TABLE:
        yield f"{key} makes {runs:,} points; at most {LARGEST_TABLE:,} are computed: give fewer"


def faults_of_track(config: dict, defaults: dict, stated: dict, largest: float) -> Iterator[str]:
    """A track that is shorter than a part, or that no part can pass in time at the `largest` amplitude."""
    length, longest = config["transit"]["length"], config["transit"]["longest"]
    for key in ("body.length", "advice.part_length"):
        section, _, name = key.partition(".")
        if (part := config.get(section, {}).get(name, 0.0)) > length:
            remedy = millimetres(stated, key, part) or "give a longer transit.length"
            yield f"{key} = {part!r} m is longer than the track, transit.length = {length!r} m; {remedy}"
    # On a fast drive, no part may pass the default track.
    if length == defaults["transit"]["length"]:
        return
    speed = measurements.plate_velocity(largest, config["model"])
    if length <= AMPLITUDE_ERROR * speed * longest:
        return
    from conveyor_pipeline.common.steepness import is_steep  # NumPy, see excitation

    # Parts may slide down a steep track faster than the plate ever moves.
    if not (config["model"]["inclination"] < 0.0 and is_steep(config["model"])):
        reason = f"because the plate moves at most at {speed:.3g} m/s"
        remedy = f"{millimetres(stated, 'transit.length', length) or 'give a shorter track'}, or give more time"
        if speed < NO_MOTION:
            reason, remedy = "because the plate does not move along the track", "give a smaller model.angle"
        yield f"transit.length = {length!r} m is too long for transit.longest = {longest!r} s, {reason}; {remedy}"


def millimetres(stated: dict, key: str, value: float) -> str:
    """The remedy for a length that is a number without a unit; empty for one with a unit."""
    section, _, name = key.partition(".")
    return "" if isinstance(stated.get(section, {}).get(name), str) else f"write {value:g} mm"


def durations(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    cycle = 1.0 / min(config["model"]["frequency"], config["drive"]["bounds"]["frequency"][0])
    for key, longest in (
        ("transit.longest", config["transit"]["longest"]),
        ("drive.search.longest", config["drive"]["search"]["longest"]),
    ):
        if longest < cycle:
            reason = f"is shorter than the longest excitation cycle of model and drive.bounds ({cycle:.3g} s)"
            yield f"{key} = {longest!r} s {reason}; give more"


def supply(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    section, frequency = config["supply"], config["model"]["frequency"]
    if "resonance" not in section:
        if section != defaults["supply"] or stated.get("supply", section) != section:
            remedy = "give the resonance (Hz) of the drive with its load, or remove the section supply"
            yield f"supply.resonance is missing; {remedy}"
        return
    resonance = f"supply.resonance = {section['resonance']!r} Hz"
    remedy = "give the resonance in which the drive with its load moves along the direction of vibration"
    if section["resonance"] > FARTHEST * frequency:
        limit = f"at most {FARTHEST * frequency:g} Hz, or check model.frequency"
        yield f"{resonance} is more than {FARTHEST:g} times model.frequency = {frequency!r} Hz; {remedy}, {limit}"
    # Unbalanced masses and voice coils may run far above the resonance of soft springs, an electromagnet cannot.
    if section["force"] == "voltage²" and FARTHEST * section["resonance"] < frequency:
        yield f"{resonance} is less than 1/{FARTHEST:g} of model.frequency = {frequency!r} Hz; {remedy}"
    if section["frequency"] >= frequency:
        key = f"supply.frequency = {section['frequency']!r} Hz"
        yield f"{key} is not below model.frequency = {frequency!r} Hz; give less"


def calibration(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Settings that contradict each other, and faults in the file of measurements."""
    section = config["calibration"]
    if config["parts"].get("calibrated") and "measurements" not in section:
        yield "parts.calibrated needs measurements; name the config with calibration.measurements as well"
    if (path := section.get("measurements")) is None:
        return
    origins = origins_of(config)
    for name in section["parameters"]:
        if name in origins:
            yield (
                f"calibration.parameters has {name}, which the section {origins[name]} gives; take it out of the "
                f"parameters, or give model.{name} in place of the section"
            )
    static = config["model"].get("static_friction")
    lowest = section["ranges"]["friction"][0]
    if "friction" in section["parameters"] and static is not None and static <= lowest:
        yield (
            f"model.static_friction = {static!r} leaves no friction to search, because calibration.ranges.friction "
            f"begins at {lowest!r}; begin lower, or take friction out of calibration.parameters"
        )
    try:
        text = csv_table.read_text(path, "calibration.measurements", measurements.MOST_BYTES)
        table = csv_table.parse(text, path, measurements.wanted, measurements.HEADER_UNITS, measurements.EXAMPLE)
        measurements.parse(table, {**section, "model": config["model"]})
    except csv_table.TableError as error:
        yield from error.faults


def excitation(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Faults in the file of an accelerometer and in its signal."""
    section, clean = config["excitation"], config["clean_drive"]
    if (share := STATEMENT["share"]) not in clean["shares"]:
        yield f"clean_drive.shares = {clean['shares']!r} lacks {share!r}, the share of the statement on chaos; add it"
    if (path := section.get("measured")) is None:
        return
    # Only configs with such a file need NumPy, SciPy and pandas.
    from conveyor_pipeline.machine.excitation import faults, reading

    if "rate" in section and "time" in section.get("columns", {}):
        yield "excitation has both rate and columns.time; state one of them"
        return
    model = config["model"]
    given = {name: model[name] for name in faults.DRIVE if is_given(name, config, defaults, stated)}
    settings = {**section, "inclination": model["inclination"], **given}
    try:
        text = csv_table.read_text(path, "excitation.measured", reading.MOST_BYTES)
        table = csv_table.parse(text, path, reading.wanted(section), reading.HEADER_UNITS, reading.EXAMPLE)
        faults.checked(table, settings)
    except csv_table.TableError as error:
        yield from error.faults


def bodies(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    body, length = config.get("body"), config["advice"].get("part_length")
    if body and length is not None and length != body["length"]:
        yield (
            f"advice.part_length = {length!r} m contradicts body.length = {body['length']!r} m; "
            "leave advice.part_length out, because parts per minute follow from body.length"
        )


def drive(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """A velocity that no design of the search can reach."""
    section, bounds = config["drive"], config["drive"]["bounds"]
    slowest = {**config["model"], "frequency": bounds["frequency"][0], "angle": bounds["angle"][0]}
    speed = measurements.plate_velocity(bounds["acceleration"][1], slowest)
    # On a track that descends, gravity may add to the velocity.
    descends = config["model"]["inclination"] < 0.0
    if section["velocity"] != defaults["drive"]["velocity"] and section["velocity"] > speed and not descends:
        yield (
            f"drive.velocity = {section['velocity']!r} m/s cannot be reached, because the plate moves at most at "
            f"{speed:.3g} m/s within drive.bounds; give less, or wider bounds"
        )


CHECKS = (operating, transit, durations, supply, calibration, excitation, bodies, drive)
