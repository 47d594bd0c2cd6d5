"""Signals that cannot be used: too few cycles, aliasing, clipping, a second frequency, an impossible unit.

The config check calls `faults` before any job starts.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .harmonics import (
    PADDING,
    Fit,
    duration_of,
    fit,
    gaps_of,
    orders_of,
    sampling_rate,
    spectrum,
    steadiness,
    strongest,
)
from .reading import DIRECTIONS, STANDARD_GRAVITY, UNITS, Recording, RecordingError, line_of_sample, parse, read_text

__all__ = ["RecordingError", "checked", "first_fit", "read_text"]

LEAST_CYCLES = 8
LEAST_PER_CYCLE = 8  # samples; with fewer, harmonics of low orders are aliased
CHECKED = 2**15  # samples that are searched for lines: more cost seconds at every start
CHECKED_ORDERS = 8
# Amplitudes (m/s²) of which one unit or the other is wrong: no plate has less to convey with, or survives more.
LEAST_ACCELERATION, MOST_ACCELERATION = 0.05, 1500.0
MOST_DISPLACEMENT = 0.1  # m
MOST_FREQUENCY = 1000.0  # Hz; with the largest acceleration, a plate would move by 0.04 mm
# Amplitude up to which a file may be in g. Beside a larger one, 1 m/s² is an offset of the sensor, not gravity in g.
MOST_IN_G = 15.0
GRAVITY = 0.03  # relative deviation within which an offset counts as gravity
MOST_TILT = 0.2  # share of gravity normal to the track, below which the sensor cannot stand as stated
MOST_SHARE = 10.0  # of a harmonic, in model.harmonics
MOST_GAPS = 0.75  # share of the recording without samples, beyond which cycles cannot be counted across gaps
OUTLIER = 20.0  # times the 95 % quantile of a column, from which a sample is no vibration
UNSTEADY = 0.15  # relative standard deviation of the amplitude, above which its mean is no parameter of the drive
# A further line counts from this share of the fundamental of its axis, if its power is this multiple of the noise's
# median power nearby, and if it is this far from all multiples of the fundamental; the last two in units of 1/T.
SHARE, OUT_OF_NOISE, NEARBY, FOOT = 0.05, 40.0, 20, 2.0
MOST_SUBHARMONIC = 4  # the fundamental may be weaker than its harmonics up to this order
NO_FUNDAMENTAL = 0.005  # share of the whole amplitude below which an axis does not vibrate
# A clipped signal stays at its extreme value far longer than near it.
NEAR, SPIKE, PLATEAU, FLAT, LEAST_FLAT = 0.002, 4.0, 3.0, 0.01, 20


def first_clipped(values: np.ndarray, quantum: float) -> int | None:
    """The first sample at the largest value if the values are cut off there, else None."""
    extreme, width = values.max(), max(1.5 * quantum, NEAR * np.ptp(values))
    at = values >= extreme - 1e-9 * np.ptp(values)
    near = np.count_nonzero((values >= extreme - width) & ~at)
    count, plateaus = np.count_nonzero(at), np.count_nonzero(np.diff(at.astype(np.int8), prepend=0) == 1)
    # Samples of every cycle at the same phases repeat an extreme value, too, but then all values repeat.
    is_varied = len(np.unique(values[~at])) > 0.5 * len(values)
    is_flat = count >= PLATEAU * plateaus or (is_varied and count >= max(LEAST_FLAT, FLAT * len(values)))
    return int(np.argmax(at)) if plateaus > 1 and is_flat and count > SPIKE * near else None


def clipped(readings: np.ndarray, quantum: float) -> int | None:
    """The first sample at which readings are cut off, above or below; None if they are not."""
    samples = [first_clipped(values, quantum) for values in (readings, -readings)]
    return min((sample for sample in samples if sample is not None), default=None)


def further_line(time: np.ndarray, fitted: Fit) -> tuple[float, float] | None:
    """Frequency (Hz) and amplitude (m/s²) of the strongest line that is no multiple of the fundamental, or None."""
    from scipy.ndimage import median_filter

    frequencies, amplitudes = spectrum(time, fitted.residual)
    resolution = 1.0 / duration_of(time)
    multiple = np.round(frequencies / fitted.frequency)
    # Where an amplitude drifts, its line has a foot.
    own = (np.abs(frequencies - multiple * fitted.frequency) < FOOT * resolution) & (multiple > 0.0)
    searched = ~own & (frequencies > max(fitted.frequency / (MOST_SUBHARMONIC + 0.5), 3.0 * resolution))
    if not searched.any():
        return None
    # Coloured noise is strong only near some frequencies, so its median nearby counts.
    noise = median_filter(amplitudes, (1, NEARBY * PADDING), mode="nearest")
    shares = amplitudes / np.abs(fitted.amplitudes[:, :1])
    counts = searched & (amplitudes**2 > OUT_OF_NOISE * noise**2) & (shares > SHARE)
    axis, place = np.unravel_index(np.argmax(np.where(counts, shares, 0.0)), shares.shape)
    return (float(frequencies[place]), float(amplitudes[axis, place])) if counts[axis, place] else None


def first_fit(time: np.ndarray, signals: np.ndarray, orders: int = CHECKED_ORDERS) -> tuple[Fit, tuple | None]:
    """The harmonics, and a line that is no multiple of their frequency, or None."""
    rate = sampling_rate(time)

    def fitted(guess: float) -> Fit:
        return fit(time, signals, guess, min(orders, orders_of(rate, guess)))

    model = fitted(strongest(time, signals)[0])
    other = further_line(time, model)
    # The strongest line may be a harmonic of a weaker fundamental.
    for order in range(2, MOST_SUBHARMONIC + 1) if other else ():
        if abs(order * other[0] - model.frequency) < 1.0 / duration_of(time):
            model = fitted(model.frequency / order)
            return model, further_line(time, model)
    return model, other


def unit_faults(acceleration: float, frequency: float, offsets: np.ndarray, unit: str) -> Iterator[str]:
    """Amplitude (m/s²), frequency (Hz) and offsets (m/s²) that no plate has."""
    given = acceleration / UNITS[unit]
    shown = f"vibrates with {given:.4g} {unit}" + (f", which is {acceleration:.4g} m/s²" if unit == "g" else "")
    other = next(name for name in UNITS if name != unit)
    gravity = math.hypot(*offsets)
    if acceleration > MOST_ACCELERATION:
        if unit == "g" and given < MOST_ACCELERATION:
            yield f"{shown}; no conveyor does: leave excitation.unit out if the file is in m/s²"
        else:
            yield f"{shown}; no conveyor does: divide values in mm/s² or in thousandths of g by 1000"
    elif acceleration < LEAST_ACCELERATION:
        remedy = "set excitation.unit: g if the file is in g" if unit == "m/s²" else "give g or m/s², not a voltage"
        yield f"{shown}; that moves no part: {remedy}, and record while the drive is on"
    elif (displacement := acceleration / (2.0 * math.pi * frequency) ** 2) > MOST_DISPLACEMENT:
        yield (
            f"{shown}, at {frequency:.3g} Hz; the plate would move by {displacement:.3g} m: write the time in s "
            "(divide milliseconds by 1000), or sample faster if the drive is faster (aliasing)"
        )
    elif frequency > MOST_FREQUENCY:
        yield f"{shown}, at {frequency:.5g} Hz; no conveyor does: write the time in s (multiply minutes by 60)"
    elif (unit == "g" or given < MOST_IN_G) and abs(
        gravity / UNITS[unit] * UNITS[other] / STANDARD_GRAVITY - 1.0
    ) < GRAVITY:
        remedy = "set excitation.unit: g" if other == "g" else "leave excitation.unit out"
        yield f"shows gravity as {gravity / UNITS[unit]:.3g}, so its values are in {other}; {remedy}"
    elif abs(gravity / STANDARD_GRAVITY - 1.0) < GRAVITY and abs(offsets[1]) < MOST_TILT * gravity:
        yield (f"shows gravity, {gravity:.3g} m/s², along the track; check which column is which, and excitation.mount")


def signal_faults(recording: Recording, unit: str, stated: float | None) -> Iterator[tuple[int | None, str]]:
    """Sample (None for the whole file) and description of each fault; `stated` is the frequency of the config (Hz)."""
    time, signals = recording.time[:CHECKED], recording.acceleration[:, :CHECKED]
    intervals, is_gap = gaps_of(recording.time)
    if (missing := intervals[is_gap].sum()) > MOST_GAPS * intervals.sum():
        yield (
            int(np.argmax(is_gap)) + 1,
            f"follows a gap, and gaps are {100.0 * missing / intervals.sum():.2g} % of the recording; keep a piece "
            "between gaps",
        )
        return
    for name, readings in zip(recording.columns, recording.readings, strict=True):
        if np.ptp(readings) == 0.0:
            yield None, f"has the same value in every line of the column {name}; check the sensor and its channel"
            return
        sizes = np.abs(readings - np.median(readings))
        if sizes.max() > OUTLIER * np.quantile(sizes, 0.95) > 0.0:
            sample = int(np.argmax(sizes))
            yield (
                sample,
                f"{name} = {readings[sample] / UNITS[unit]:.4g} stands out of all other values; delete the line, and "
                "check the cable",
            )
            return
        if (sample := clipped(readings, recording.quanta.max())) is not None:
            yield (
                sample,
                f"{name} = {readings[sample] / UNITS[unit]:.4g} is cut off there and in other cycles; record again "
                "with a larger range of the sensor",
            )
    fitted, other = first_fit(time, signals)
    rate, frequency = sampling_rate(recording.time), fitted.frequency
    cycles, per_cycle = duration_of(recording.time) * frequency, rate / frequency
    if cycles < LEAST_CYCLES - 0.1:
        yield None, f"holds {cycles:.2g} cycles of {frequency:.3g} Hz; record at least {LEAST_CYCLES}"
        return
    if per_cycle < LEAST_PER_CYCLE - 0.1:
        yield (
            None,
            f"has {per_cycle:.2g} samples in a cycle of {frequency:.4g} Hz, or the drive is faster and aliased; sample "
            f"at least {LEAST_PER_CYCLE} times in a cycle, with the sensor's anti-aliasing filter",
        )
        return
    if stated and stated > 0.5 * rate and abs(abs(stated - round(stated / rate) * rate) - frequency) < 0.02 * frequency:
        yield (
            None,
            f"is sampled at {rate:.4g} Hz, at which a drive of {stated:g} Hz (model.frequency) looks like one of "
            f"{frequency:.3g} Hz (aliasing); sample at {LEAST_PER_CYCLE * stated:g} Hz or more",
        )
        return
    steady = steadiness(time, fitted)
    if (deviation := steady["deviation"]) > max(UNSTEADY, 3.0 * steady["deviation_of_noise"]):
        yield (
            None,
            f"is not steady: its amplitude at {frequency:.4g} Hz varies by {100.0 * deviation:.2g} % (standard "
            "deviation); keep a piece in which the drive runs steadily, and record one drive alone",
        )
        return
    if other:
        yield (
            None,
            f"vibrates at {frequency:.4g} Hz and, with {other[1]:.2g} m/s², at {other[0]:.4g} Hz, no multiple of it; "
            "record one drive alone, and use the sensor's anti-aliasing filter, because a harmonic above half the "
            "sampling rate looks like such a line",
        )
        return
    sizes = np.abs(fitted.amplitudes[:, 0])
    yield from ((None, fault) for fault in unit_faults(float(np.hypot(*sizes)), frequency, fitted.offsets, unit))
    noise = np.sqrt(4.0 * (fitted.residual**2).mean(axis=1) / len(time))
    directions = list(DIRECTIONS.values())
    for axis, direction in enumerate(directions):
        if sizes[axis] < max(NO_FUNDAMENTAL * np.hypot(*sizes), 4.0 * noise[axis]):
            yield (
                None,
                f"shows no vibration {direction} at {frequency:.4g} Hz ({sizes[axis]:.2g} m/s²), to which shares of "
                "harmonics and phases refer; check the columns, and excitation.mount",
            )
            return
    shares = np.abs(fitted.amplitudes) / sizes[:, None]
    if shares.max() > MOST_SHARE:
        axis, place = np.unravel_index(np.argmax(shares), shares.shape)
        yield (
            None,
            f"vibrates {directions[axis]} {shares[axis, place]:.3g} times as much at {(place + 1) * frequency:.4g} "
            f"Hz as at {frequency:.4g} Hz, to which shares of harmonics refer; model.harmonics take shares up to "
            f"{MOST_SHARE:g}: check the columns and excitation.mount, and record one drive alone",
        )


def checked(text: str, path: str | Path, settings: dict, stated: float | None = None) -> Recording:
    """The recording in a text; RecordingError names all faults of the text or of the signal, with file and line.

    settings : as in `parse`
    stated : frequency of the config, Hz
    """
    recording = parse(text, path, settings)
    faults = [
        f"{path}{'' if sample is None else f':{line_of_sample(text, sample)}'}: {fault}"
        for sample, fault in signal_faults(recording, settings["unit"], stated)
    ]
    if faults:
        raise RecordingError(faults)
    return recording
