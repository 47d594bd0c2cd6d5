"""Contradictions in the sections of the floor machine, as in config/checks.py."""

from collections.abc import Iterator

from conveyor import RANGES
from conveyor_pipeline.common import csv_table
from conveyor_pipeline.common.axes import count_values, ends
from conveyor_pipeline.common.settings import check_span
from conveyor_pipeline.config.checks import LARGEST_TABLE
from conveyor_pipeline.config.derived import origins_of
from conveyor_pipeline.machine.calibration import measurements
from conveyor_pipeline.machine.excitation.limits import STATEMENT
from conveyor_pipeline.machine.operating.settings import transit_axis
from conveyor_pipeline.machine.operating.supply import FARTHEST

NO_MOTION = 1e-9  # m/s; with an angle of throw of 90°, rounding alone moves the plate along the track
AMPLITUDE_ERROR = 2.0  # no part has a drive whose amplitude is so many times the set one


def transit_amplitudes(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Faults of an axis that takes some of its keys from operating.acceleration."""
    axis = transit_axis(config)
    if not isinstance(axis, dict):
        return
    if missing := [key for key in ("start", "stop", "num") if key not in axis]:
        remedy = "give start, stop and num, or remove transit.acceleration, so that operating.acceleration counts"
        yield f"transit.acceleration lacks {', '.join(missing)}, and operating.acceleration is a list; {remedy}"
        return
    try:
        check_span(axis)
    except ValueError as error:
        yield f"transit.acceleration, with what operating.acceleration adds, {error}"


def numbers_of_runs(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    axes = {"operating": config["operating"]["acceleration"], "transit": transit_axis(config)}
    for section, number in (("operating", "starts"), ("transit", "parts")):
        axis = axes[section]
        if isinstance(axis, dict) and "num" not in axis:  # see transit_amplitudes
            continue
        runs = count_values(axis) * config[section][number]
        if runs > LARGEST_TABLE:
            yield f"{section}.{number} makes {runs:,} points; at most {LARGEST_TABLE:,} are computed: give fewer"


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
    section = config["supply"]
    frequency = config["model"]["frequency"]
    is_given = section != defaults["supply"] or stated.get("supply", section) != section
    if "resonance" not in section and is_given:
        remedy = "give the resonance (Hz) of the drive with its load, or remove the section supply"
        yield f"supply.resonance is missing; {remedy}"
    if "resonance" not in section:
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
        yield (
            f"supply.frequency = {section['frequency']!r} Hz is not below model.frequency = {frequency!r} Hz; give less"
        )


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
        known = measurements.wanted(RANGES)
        table = csv_table.parse(text, path, known, measurements.HEADER_UNITS, measurements.EXAMPLE)
        measurements.parse(table, {**section, "model": config["model"]}, RANGES)
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
    model, stated_model = config["model"], stated.get("model") or {}
    # Also if it is the default.
    measured = {
        name: model[name] for name in faults.DRIVE if name in stated_model or model[name] != defaults["model"][name]
    }
    settings = {**section, "inclination": model["inclination"], **measured}
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


def millimetres(stated: dict, key: str, value: float) -> str:
    """The remedy for a length that is a number without a unit; empty for one with a unit."""
    section, _, name = key.partition(".")
    has_unit = isinstance((stated.get(section) or {}).get(name), str)
    return "" if has_unit else f"write {value:g} mm"


def drive(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """A velocity that no design of the search can reach."""
    section = config["drive"]
    bounds = config["drive"]["bounds"]
    slowest = {**config["model"], "frequency": bounds["frequency"][0], "angle": bounds["angle"][0]}
    speed = measurements.plate_velocity(bounds["acceleration"][1], slowest)
    # On a track that descends, gravity may add to the velocity.
    descends = config["model"]["inclination"] < 0.0
    if section["velocity"] != defaults["drive"]["velocity"] and section["velocity"] > speed and not descends:
        yield (
            f"drive.velocity = {section['velocity']!r} m/s cannot be reached, because the plate moves at most at "
            f"{speed:.3g} m/s within drive.bounds; give less, or wider bounds"
        )


def track(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """A track that is shorter than a part, or that no part can pass in time: lengths in millimetres."""
    length, longest, axis = config["transit"]["length"], config["transit"]["longest"], transit_axis(config)
    for key in ("body.length", "advice.part_length"):
        section, _, name = key.partition(".")
        if (part := config.get(section, {}).get(name, 0.0)) > length:
            remedy = millimetres(stated, key, part) or "give a longer transit.length"
            yield f"{key} = {part!r} m is longer than the track, transit.length = {length!r} m; {remedy}"
    has_gaps = isinstance(axis, dict) and not {"start", "stop"} <= axis.keys()  # see transit_amplitudes
    # On a fast drive, no part may pass the default track; a sweep has no track.
    if has_gaps or length == defaults["transit"]["length"]:
        return
    speed = measurements.plate_velocity(max(ends(axis)), config["model"])
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


CHECKS = (transit_amplitudes, numbers_of_runs, durations, supply, calibration, excitation, bodies, drive, track)
