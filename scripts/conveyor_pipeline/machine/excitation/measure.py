"""What an accelerometer file says about the drive: parameters, harmonics, and how clean and steady the drive is."""

import math

import numpy as np
from scipy.ndimage import median_filter

from conveyor_pipeline.common import csv_table, fields
from conveyor_pipeline.machine.excitation.estimates import NORMAL, PARAMETERS, harmonics, noise_of, parameters
from conveyor_pipeline.machine.excitation.faults import later_faults
from conveyor_pipeline.machine.excitation.gravity import gravity_of
from conveyor_pipeline.machine.excitation.harmonics import (
    Fit,
    drift_between_axes,
    duration_of,
    first_fit,
    fit,
    orders_of,
    sampling_rate,
    spectrum,
    steadiness,
)
from conveyor_pipeline.machine.excitation.modulation import errors_of, jump_of, losses_of, modulation_of
from conveyor_pipeline.machine.excitation.reading import (
    AXES,
    DIRECTIONS,
    EXAMPLE,
    HEADER_UNITS,
    Recording,
    parse,
    wanted,
)
from conveyor_pipeline.machine.excitation.sample_times import CHECKED, resolve

DIGITS = 10  # of all numbers; further digits depend on the processor, and no sensor has them
SAMPLES, POINTS, BINS = 2000, 257, 2000  # of the figure
UNSURE = 0.05  # chance that noise alone looks like a jump of the phase, below which one counts as possible


def by_axis(name: str, unit: str, description: str) -> tuple:
    """The columns of both axes."""
    return tuple(
        fields.number(f"{axis}{name}", unit, f"{description} {direction}") for axis, direction in DIRECTIONS.items()
    )


def share_fields(axis: str) -> tuple:
    """The columns of the harmonics of one axis."""
    name = f"harmonic {DIRECTIONS[axis]}"
    return (
        fields.number(axis, "1", f"amplitude of the {name}, over the fundamental of this axis"),
        fields.number(f"{axis}_stderr", "1", "its standard error"),
        fields.number(f"{axis}_phase", "rad", f"phase of the {name}; the fundamental normal to the track has phase 0"),
        fields.number(f"{axis}_phase_stderr", "rad", "its standard error; 1.6 for any phase"),
        fields.flag(f"{axis}_above_noise", f"whether the {name} is above the noise"),
    )


TABLES = {
    "parameters": (
        fields.text("parameter", ", ".join(PARAMETERS)),
        fields.number("value", "as stated in `unit`", "measured value"),
        fields.number("stderr", "as stated in `unit`", "its standard error"),
        fields.text("unit", "unit of the value"),
    ),
    "harmonics": (
        fields.count("order", "frequency in units of the fundamental's"),
        *share_fields("along"),
        *share_fields("normal"),
        fields.flag("above_noise", "whether the harmonic is above the noise in at least one direction"),
    ),
    "quality": (
        fields.count("samples", "samples of the recording"),
        fields.count("repeated", "lines left out because they repeat the readings of the line before"),
        fields.text("sampling", "times: stamped (as in the file), rate (as stated), rounded or even (evenly spaced)"),
        fields.flag("other_times", "whether other times of the samples fit about as well; they are part of the errors"),
        fields.number(
            "rate_error", "1", "relative standard error of the sampling rate from the resolution of the times"
        ),
        fields.number("sampling_rate", "Hz", "mean number of samples per second, outside gaps"),
        fields.number("cycles", "1", "excitation cycles of the recording"),
        *by_axis("_offset", "m/s²", "gravity and offset of the sensor"),
        fields.flag("gravity_found", "whether the means are gravity; a sensor may remove it"),
        fields.number("gravity", "1", "size of the means of both axes, over the standard gravity"),
        fields.number("lean", "rad", "direction of the means, forwards from where mount and inclination put gravity"),
        fields.number("across", "1", "vibration in the sensor's third axis, over that along the track; 0 if not known"),
        *by_axis("_noise", "m/s²", "root mean square of what no harmonic explains,"),
        *by_axis("_distortion", "1", "root sum of squares of the shares above the noise,"),
        fields.number(
            "other_frequency", "Hz", "strongest line that is no multiple of the frequency; null if none counts"
        ),
        fields.number("other_amplitude", "m/s²", "its amplitude"),
        fields.count("pieces", "pieces of the recording, each with its own amplitude"),
        fields.number("deviation", "1", "relative standard deviation of the amplitude over the pieces"),
        fields.number("wander", "rad", "standard deviation of the phase over the pieces, against a constant frequency"),
        fields.number("deviation_of_noise", "1", "this deviation if only the noise caused it"),
        fields.number("between_axes", "rad", "change of the phase between both axes from begin to end; 0 if noise"),
        fields.number("drift", "1", "relative change of the amplitude from begin to end, by a straight line"),
    ),
    "samples": (
        fields.number("cycle", "1", "phase of a sample in cycles, from 0 to 1"),
        *by_axis("", "m/s²", "acceleration without offset"),
    ),
    "waveform": (
        fields.number("cycle", "1", "phase in cycles, from 0 to 1"),
        *by_axis("", "m/s²", "fitted acceleration with the harmonics above the noise,"),
        *by_axis("_fundamental", "m/s²", "fitted acceleration without harmonics,"),
        *by_axis("_displacement", "m", "displacement with these harmonics,"),
        *by_axis("_displacement_fundamental", "m", "displacement without harmonics,"),
    ),
    "spectrum": (
        fields.number("frequency", "Hz", "frequency"),
        *by_axis("", "m/s²", "amplitude"),
        *by_axis("_floor", "m/s²", "median amplitude of the noise nearby,"),
    ),
}


def loss_error(recording: Recording, fitted: Fit) -> float:
    """Relative error of the frequency from samples that may be lost at one place or at random, beside the noise."""
    jump = jump_of(recording.time, errors_of(recording.time, fitted).imag)
    time = recording.time[:CHECKED]
    part = fitted._replace(residual=fitted.residual[:, :CHECKED])
    most_losses = losses_of(time, part, modulation_of(time, part)).upper_limit
    shift = jump.shift / fitted.frequency if jump.is_found(UNSURE) else 0.0
    return math.hypot(shift, most_losses / NORMAL / len(time) if most_losses > 1.0 else 0.0)


def rounded(columns: dict) -> dict:
    """The columns with DIGITS significant digits."""

    def shorten(value: float) -> float:
        return float(f"{value:.{DIGITS - 1}e}")

    return {
        name: [shorten(value) if isinstance(value, float) else value for value in np.asarray(values).tolist()]
        for name, values in columns.items()
    }


def cycles_of(recording: Recording, fitted: Fit) -> np.ndarray:
    """Phase of every sample in cycles; the fundamental normal to the track has its maximum at whole numbers."""
    zero = np.angle(fitted.amplitudes[1, 0]) / (2.0 * math.pi)
    return (recording.time - fitted.middle) * fitted.frequency + zero


def waveform(fitted: Fit, above: np.ndarray) -> dict[str, np.ndarray]:
    """One cycle of the plate; `above` says which harmonics of orders 2, 3, … of each axis count, shape (2, K - 1)."""
    cycle = np.linspace(0.0, 1.0, POINTS)
    orders = np.arange(1, fitted.orders + 1)
    zero = np.angle(fitted.amplitudes[1, 0])
    waves = np.exp(1j * np.outer(orders, 2.0 * math.pi * cycle - zero))
    used = fitted.amplitudes * np.hstack([np.ones((2, 1)), above])
    squares = (2.0 * math.pi * fitted.frequency * orders) ** 2
    columns = {"cycle": cycle}
    for axis, name in enumerate(AXES):
        columns[name] = (used[axis] @ waves).real
        columns[f"{name}_fundamental"] = (used[axis, :1] @ waves[:1]).real
        columns[f"{name}_displacement"] = -(used[axis] / squares @ waves).real
        columns[f"{name}_displacement_fundamental"] = -(used[axis, :1] / squares[0] @ waves[:1]).real
    return columns


def spectra(recording: Recording, fitted: Fit) -> dict[str, np.ndarray]:
    """Amplitude spectra up to a little beyond the highest order, as the maximum of groups of frequencies, and the floor
    of the noise."""
    frequencies, amplitudes = spectrum(recording.time, recording.acceleration - fitted.offsets[:, None])
    noise = spectrum(recording.time, fitted.residual)[1]
    count = np.searchsorted(frequencies, (fitted.orders + 0.5) * fitted.frequency)
    begins = np.unique(np.linspace(0, count, min(count, BINS), endpoint=False).astype(np.int64))
    width = max(3, round(len(begins) / (fitted.orders + 0.5)))  # one frequency of the drive
    columns = {"frequency": frequencies[begins]}
    for axis, name in enumerate(AXES):
        columns[name] = np.maximum.reduceat(amplitudes[axis, :count], begins)
        columns[f"{name}_floor"] = median_filter(noise[axis, :count], max(3, width * count // len(begins)))[begins]
    return columns


def make(measured: str, settings: dict) -> dict[str, dict]:
    """The tables from the text of the accelerometer file."""
    table = csv_table.parse(measured, settings["measured"], wanted(settings), HEADER_UNITS, EXAMPLE)
    recording = resolve(parse(table, settings))
    rate = sampling_rate(recording.time)
    first, extra_line = first_fit(recording.time, recording.acceleration)
    if faults := later_faults(recording, first, extra_line, settings):
        raise table.error(faults)
    orders = orders_of(rate, first.frequency)
    fitted, *other_fits = (
        fit(version.time, version.acceleration, first.frequency, orders) for version in (recording, *recording.others)
    )
    noise = noise_of(recording, fitted, tuple(other_fits))
    gravity = gravity_of(fitted, settings["inclination"])
    rate_error = math.hypot(recording.rate_error, loss_error(recording, fitted))
    shares = harmonics(fitted, noise, gravity)
    above = np.array([shares[f"{axis}_above_noise"] for axis in AXES])
    distortion = np.sqrt((np.array([shares[axis] for axis in AXES]) ** 2 * above).sum(axis=1))
    values, errors = zip(*parameters(recording, fitted, noise, gravity, rate_error).values(), strict=True)
    cycle = cycles_of(recording, fitted)
    chosen = np.unique(np.linspace(0, len(cycle) - 1, SAMPLES).round().astype(np.int64))
    quality = {
        "samples": len(recording.time),
        "repeated": recording.repeated,
        "sampling": recording.sampling,
        "other_times": bool(recording.others),
        "rate_error": recording.rate_error,
        "gravity_found": gravity.present,
        "gravity": gravity.size,
        "lean": gravity.lean,
        "across": recording.across,
        "sampling_rate": rate,
        "cycles": fitted.frequency * duration_of(recording.time),
        "other_frequency": extra_line[0] if extra_line else math.nan,
        "other_amplitude": extra_line[1] if extra_line else math.nan,
        **steadiness(recording.time, fitted),
        "between_axes": drift_between_axes(recording.time, fitted),
    }
    for axis, name in enumerate(AXES):
        quality[f"{name}_offset"] = fitted.offsets[axis]
        quality[f"{name}_noise"] = math.sqrt((fitted.residual[axis] ** 2).mean())
        quality[f"{name}_distortion"] = distortion[axis]
    samples = recording.acceleration[:, chosen] - fitted.offsets[:, None]
    tables = {
        "parameters": {
            "parameter": list(PARAMETERS),
            "value": values,
            "stderr": errors,
            "unit": list(PARAMETERS.values()),
        },
        "harmonics": shares,
        "quality": {name: [value] for name, value in quality.items()},
        "samples": {"cycle": np.mod(cycle[chosen], 1.0), **dict(zip(AXES, samples, strict=True))},
        "waveform": waveform(fitted, above),
        "spectrum": spectra(recording, fitted),
    }
    return {name: rounded(columns) for name, columns in tables.items()}
