"""Gravity in a recording: whether its size and direction fit the stated unit, mount and inclination.

At rest, a sensor on the plate reads the reaction to gravity, upwards: g sin(inclination) along the track and
g cos(inclination) normal to it. The mean of a recording is this reading, apart from an offset of the sensor.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from conveyor_pipeline.machine.excitation.harmonics import Fit
from conveyor_pipeline.machine.excitation.reading import (
    AXES,
    STANDARD_GRAVITY,
    UNITS,
    Recording,
    columns_entry,
    rename,
    turn,
)

ABSENT = 0.06  # of gravity: a mean below this is an offset of a sensor that removes gravity
SIZE = 0.1  # relative deviation within which the mean counts as gravity; sensors have errors of some percent
NEAR = 0.05  # relative deviation within which another unit explains the mean
MOST_LEAN = 0.04  # rad, within which the direction of gravity fits; an offset of 0.04 g turns it by this much
LEAST_DEGREES = 0.5  # a smaller number is no mount in degrees, because nobody sees such a small angle
MOST_RATIO = 10.0  # of the amplitude to gravity on a conveyor; offsets of a sensor that removes gravity are smaller
SURE = 3.0  # standard errors that the noise may add to a deviation
# What else the unit of a file may be, in m/s².
OTHER_UNITS = {
    "cm/s²": 1e-2,
    "ft/s²": 0.3048,
    **{name: UNITS[name] for name in UNITS},
    **{f"counts, {count} for each g": STANDARD_GRAVITY / count for count in (2**power for power in range(6, 17))},
}


class Gravity(NamedTuple):
    """The mean of a recording compared with gravity."""

    present: bool
    size: float  # over the standard gravity
    lean: float  # rad, from the normal of the track in the feeding direction, minus the inclination
    noise: float  # standard error of both

    @property
    def if_present(self) -> "Gravity":
        """The same with no deviation and no noise if there is no gravity to compare with."""
        return self if self.present else NO_GRAVITY


NO_GRAVITY = Gravity(False, 1.0, 0.0, 0.0)


def wrap(angle: Any) -> Any:
    """Angles in (-π, π]."""
    return math.pi - (math.pi - angle) % (2.0 * math.pi)


def gravity_of(fitted: Fit, inclination: float) -> Gravity:
    """Gravity in the offsets of a fit, for a track that rises by `inclination` (rad)."""
    size = math.hypot(*fitted.offsets) / STANDARD_GRAVITY
    lean = wrap(math.atan2(*fitted.offsets) - inclination)
    noise = math.sqrt((fitted.residual**2).mean() / fitted.residual.shape[1]) / STANDARD_GRAVITY
    return Gravity(size >= ABSENT, size, lean, noise)


def size_fault(gravity: Gravity, acceleration: float, unit: str) -> str | None:
    """What is wrong with the unit if the mean is not gravity.

    acceleration : amplitude of the vibration, m/s²
    """
    if abs(gravity.size - 1.0) < SIZE + SURE * gravity.noise:
        return None
    mean = gravity.size * STANDARD_GRAVITY / UNITS[unit]
    deviations = {name: abs(mean * scale / STANDARD_GRAVITY - 1.0) for name, scale in OTHER_UNITS.items()}
    nearest = min(deviations, key=lambda name: deviations[name])
    # A small mean is an offset, unless its direction is that of gravity, and so is its size: in a unit that makes it
    # larger, or compared with the vibration, as in a voltage.
    is_scaled = (nearest in UNITS and deviations[nearest] < NEAR) or acceleration < MOST_RATIO * mean * UNITS[unit]
    if not gravity.present and not (is_scaled and abs(gravity.lean) < MOST_LEAN):
        return None
    shown = f"has a mean of {mean:.4g} {unit}, {gravity.size:.3g} times gravity"
    factor = f"one g is {mean:.4g} in the file, so values times {STANDARD_GRAVITY / mean:.4g} would be m/s²"
    if deviations[nearest] < NEAR and nearest in UNITS:
        return f"{shown}; its values are in {nearest}: set excitation.unit: {nearest} ({factor})"
    if deviations[nearest] < NEAR:
        return f"{shown}; its values seem to be {nearest}: {factor}; export them in one of {', '.join(UNITS)}"
    remedy = f"export the values in one of {', '.join(UNITS)}, and state it as excitation.unit"
    return f"{shown}, which no unit explains; {factor}; {remedy}, or check whether the sensor is tilted sideways"


def fitting_columns(recording: Recording, means: np.ndarray, mount: float, inclination: float) -> list[str]:
    """The entries `excitation.columns` with which gravity would have its direction: mirrored or exchanged axes."""
    keys = recording.columns
    entries = []
    for swapped in (False, True):
        for signs in ((1, -1), (-1, 1), (-1, -1)) if not swapped else ((1, 1), (1, -1), (-1, 1), (-1, -1)):
            order = (1, 0) if swapped else (0, 1)
            turned = turn(np.array([signs[0] * means[order[0]], signs[1] * means[order[1]]]), mount)
            if abs(wrap(math.atan2(*turned) - inclination)) > MOST_LEAN:
                continue
            names = {key: recording.names[keys[place]] for key, place in zip(keys, order, strict=True)}
            for key, sign in zip(keys, signs, strict=True):
                name = names[key]
                names[key] = name if sign > 0 else name[1:] if name.startswith("-") else f"-{name}"
            entries.append(columns_entry({**recording.names, **names}))
    return entries


def format_angle(angle: float) -> str:
    """An angle (rad), rounded to four decimals; no mount is set more precisely."""
    return f"{round(angle, 4) + 0.0:.4g}"


def direction_fault(recording: Recording, gravity: Gravity, settings: Mapping[str, Any]) -> str | None:
    """What is wrong with mount, inclination or signs of axes if gravity has another direction."""
    if not gravity.present or abs(gravity.lean) < MOST_LEAN + SURE * gravity.noise:
        return None
    mount, inclination = settings["mount"], settings.get("inclination", 0.0)
    means = recording.readings.mean(axis=1)
    fits = wrap(mount + gravity.lean)
    shown = (
        f"shows gravity {math.degrees(gravity.lean):.3g}° from where excitation.mount = {mount:g} and "
        f"model.inclination = {inclination:g} (rad) put it"
    )
    if abs(wrap(math.radians(mount) - fits)) < MOST_LEAN and abs(mount) >= LEAST_DEGREES:
        return f"{shown}; the mount looks like degrees: set excitation.mount: {math.radians(mount):.4g}"
    entries = fitting_columns(recording, means, mount, inclination)
    if entries and abs(gravity.lean) > 0.5 * math.pi + MOST_LEAN:
        if len(entries) > 1:
            underside, negated = entries[0], entries[1]
            return (
                f"{shown}: it points down. If the sensor sits on the underside of the plate, with "
                f"{recording.columns[0]} still in the feeding direction, set {underside}; if all axes have the other "
                f"sign, set {negated}"
            )
        return f"{shown}: an axis points the other way; set {entries[0]}"
    if recording.columns == AXES:
        names = columns_entry(rename(recording.names))
        remedy = f"name the columns by {names} with excitation.mount: {format_angle(fits)}"
    else:
        remedy = f"set excitation.mount: {format_angle(fits)}"
    if abs(inclination + gravity.lean) < 0.5:
        track = format_angle(inclination + gravity.lean)
        remedy += f" if the sensor stands so, or model.inclination: {track} if the track does"
    mirrored = f"; or, if an axis has the other sign or the other name, {' or '.join(entries)}" if entries else ""
    return f"{shown}; {remedy}{mirrored}"
