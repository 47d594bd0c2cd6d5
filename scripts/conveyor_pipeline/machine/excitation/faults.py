"""Recordings that cannot be used: too few cycles, aliasing, clipping, a second frequency, wrong times or units.

The config check calls `check` before any job starts. Each function below looks for one kind of fault.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from conveyor_pipeline.machine.excitation.gravity import SURE, direction_fault, gravity_of, size_fault, wrap
from conveyor_pipeline.machine.excitation.harmonics import (
    Fit,
    design_of,
    drift_between_axes,
    duration_of,
    first_fit,
    fit,
    gaps_of,
    orders_of,
    phases_of,
    sampling_rate,
    steadiness,
)
from conveyor_pipeline.machine.excitation.limits import OTHER_DIRECTION, OTHER_FREQUENCY
from conveyor_pipeline.machine.excitation.mixture import mixture_of
from conveyor_pipeline.machine.excitation.modulation import (
    Jump,
    Modulation,
    alternates,
    errors_of,
    is_sawtooth,
    jump_of,
    loss_in_step,
    losses_of,
    modulation_of,
    order_at_half,
    timing_line,
)
from conveyor_pipeline.machine.excitation.reading import (
    DIRECTIONS,
    STANDARD_GRAVITY,
    TIME_UNITS,
    UNITS,
    Recording,
    parse,
    remedy_of_line,
)
from conveyor_pipeline.machine.excitation.sample_times import CHECKED, MOST_EQUAL, MOST_GAPS, keep, repeats, resolve
from conveyor_pipeline.machine.excitation.saturation import has_flat_tops, is_cut_off

LEAST_CYCLES = 8
LEAST_PER_CYCLE = 8  # samples; with fewer, harmonics of low orders are aliased
# Amplitudes (m/s²) of which one unit or the other is wrong: no plate has less to convey with, or survives more.
LEAST_ACCELERATION, MOST_ACCELERATION = 0.05, 1500.0
MOST_DISPLACEMENT = 0.03  # m: slow shaking conveyors have up to 20 mm
LEAST_FREQUENCY = 3.0  # Hz; with half of gravity, a plate would move by 14 mm
MOST_FREQUENCY = 1000.0  # Hz; with the largest acceleration, a plate would move by 0.04 mm
LONG = {"days": 86400.0, "hours": 3600.0, "minutes": 60.0}  # s
DIFFERENT = 2.0  # difference of two frequencies in units of 1/T
LEAST_CHANGE = 0.01  # of gravity, where another sensor begins
LEAST_LOSS = 0.1  # samples; a smaller jump of the phase is part of the error of the frequency (estimates.loss_error)
CHANCE = 1e-4  # that noise alone looks like a jump of the phase or the amplitude
MOST_SHARE = 10.0  # of a harmonic, in model.harmonics
MOST_RATE_ERROR = 2e-3  # relative standard error of the sampling rate
MOST_SCATTER = 0.3  # rad, of the phase: times that the samples were not taken at
MOST_SPREAD = 0.03  # standard deviation of relative errors of the amplitude from line to line
NEIGHBOURS, REPEATED = 10, 10.0  # values on either side, and how many times more often one value may be read
OUTLIER = 20.0  # times the 95 % quantile of a column, from which a sample is no vibration
UNSTEADY = 0.15  # relative standard deviation of the amplitude, above which its mean is no parameter of the drive
NO_FUNDAMENTAL = 0.005  # share of the whole amplitude below which an axis does not vibrate
MOST_WANDER = 0.3  # rad; the amplitude would be wrong by 4 %
MOST_DRIFT = 0.15  # rad, of the phase between both axes; a smaller drift is part of its error
# A clipped signal stays at its extreme value far longer than near it.
NEAR, SPIKE, PLATEAU, FLAT, LEAST_FLAT = 0.002, 4.0, 3.0, 0.01, 20
CHANCE_OF_FLAT = 0.01  # that the flattest wave looks cut off
# Straight lines between samples: least share in each of several pieces, and ratio to those that nearly are on a line.
LINES, STRAIGHT, PIECES = 0.1, 3.0, 8
VARIED = 33  # different phases, of 64
COARSE = 20.0  # steps of the readings; with more noise, chance puts few samples on a line at any number of phases
# Fewest different values that show a wave; the noise, in steps of the converter, with which fewer values show it, too.
LEAST_VALUES, FINER = 6, 0.25
# Readings that a slower channel holds: least share in each piece, and its product with the median of the other changes
# in steps, which is about 0.3 for a wave and for noise, at any size of the steps.
HELD, MOVING = 0.1, 2.0
DRIVE = ("frequency", "angle", "phase_shift")  # parameters of the model that a recording measures
CYCLES = {2: "second", 3: "third", 4: "fourth"}
WEAK = 2.0  # times as strong as the fundamental: a harmonic that may be the drive itself
# Strips at the extreme, in halves of the span of the values; ratio of the first to the second; and how many times the
# largest gap between phases, and the largest step, the first must be.
HALVINGS, STEEP, GAPS = (5, 13), 8.0, 4.0
LEAST_FOR_TOPS = 10.0  # samples in a cycle, with which the tops of a wave with harmonics do not look flat by chance


def first_clipped(values: np.ndarray, quantum: float) -> int | None:
    """The first sample at the largest value if the values are cut off there, else None."""
    from scipy.special import bdtrc

    extreme = values.max()
    width = max(1.5 * quantum, NEAR * np.ptp(values))
    at_extreme = values >= extreme - 1e-9 * np.ptp(values)
    near = np.count_nonzero((values >= extreme - width) & ~at_extreme)
    count = np.count_nonzero(at_extreme)
    plateaus = np.count_nonzero(np.diff(at_extreme.astype(np.int8), prepend=0) == 1)
    # Samples of every cycle at the same phases repeat an extreme value, too, but then all values repeat.
    is_varied = len(np.unique(values[~at_extreme])) > 0.5 * len(values)
    # A wave whose extreme is flat to the third order has this share of the values of the strip within half a step.
    share = (0.5 * quantum / width) ** 0.25
    is_spike = is_varied and bdtrc(count - 1, count + near, share) < CHANCE_OF_FLAT
    is_flat = count >= PLATEAU * plateaus or (is_spike and count >= FLAT * len(values))
    return int(np.argmax(at_extreme)) if plateaus > 1 and is_flat and count > SPIKE * near else None


def clipped(readings: np.ndarray, quantum: float) -> int | None:
    """The first sample at which readings are cut off, above or below; None if they are not."""
    samples = [first_clipped(values, quantum) for values in (readings, -readings)]
    return min((sample for sample in samples if sample is not None), default=None)


def repeated_value(readings: np.ndarray) -> float | None:
    """A value between the extremes that is read far more often than those beside it, as where readings fail, or None.

    Where most values are different, noise hardly repeats one.
    """
    values, counts = np.unique(readings, return_counts=True)
    commonest = int(np.argmax(np.where((values > values[0]) & (values < values[-1]), counts, 0)))
    near = counts[max(commonest - NEIGHBOURS, 0) : commonest + NEIGHBOURS + 1]
    usual = (near.sum() - counts[commonest]) / (len(near) - 1)
    is_varied = len(values) > 0.5 * len(readings)
    return float(values[commonest]) if is_varied and counts[commonest] > max(LEAST_FLAT, REPEATED * usual) else None


def flattened(values: np.ndarray, quantum: float, gap: float) -> bool:
    """Whether values are cut off with some noise behind it, as by a sensor that saturates before its filter.

    Near the extreme of a smooth wave, as many values lie within a distance w as 0.41 (of a very flat wave: 0.19) times
    as many within the next w. Values that are cut off leave the second strip nearly empty. So do samples at few phases:
    the w of a cosine must last longer than the largest `gap` between phases (cycles). A step of the converter,
    `quantum`, must be smaller than w, too.
    """
    span = np.ptp(values)
    needed = max(LEAST_FLAT, FLAT * len(values))
    shares = 0.5 ** np.arange(*HALVINGS)
    for sizes in (values.max() - values, values - values.min()):
        for width in span * shares[(np.sqrt(shares) / math.pi > GAPS * gap) & (span * shares > GAPS * quantum)]:
            near, next_to = np.count_nonzero(sizes <= width), np.count_nonzero((sizes > width) & (sizes <= 2.0 * width))
            if near > max(needed, STEEP * next_to):
                return True
    return False


# What a check yields: the fault of a line, with its number, or of the whole file.
Fault = tuple[int, str] | str


class Signal(NamedTuple):
    """A recording and what was fitted to it."""

    recording: Recording
    fitted: Fit
    extra_line: tuple[float, float] | None  # frequency (Hz) and amplitude (m/s²) of a line that is no harmonic
    modulation: Modulation
    settings: Mapping[str, Any]  # of the section `excitation`, with `inclination`, and what the model states of DRIVE

    @property
    def time(self) -> np.ndarray:
        """Of the samples that were fitted, s."""
        return self.recording.time[: self.fitted.residual.shape[1]]

    @property
    def rate(self) -> float:
        return sampling_rate(self.recording.time)

    @property
    def is_as_stated(self) -> bool:
        """Whether model.frequency states the frequency of the drive."""
        stated = self.settings.get("frequency")
        return bool(stated) and abs(self.fitted.frequency / stated - 1.0) < OTHER_FREQUENCY

    def jump(self, part: str) -> Jump | None:
        """The jump of the phase (`imag`) or of the amplitude (`real`), if there is one alone."""
        jump = jump_of(self.time, getattr(errors_of(self.time, self.fitted), part))
        return jump if jump.is_alone and jump.is_found(CHANCE) else None

    @property
    def sizes(self) -> np.ndarray:
        """Amplitudes of the fundamentals, m/s²."""
        return np.abs(self.fitted.amplitudes[:, 0])


def gap_faults(recording: Recording) -> Iterator[Fault]:
    """A recording that consists of gaps."""
    intervals, is_gap = gaps_of(recording.time)
    if (missing := intervals[is_gap].sum()) > MOST_GAPS * intervals.sum():
        yield (
            int(recording.lines[np.argmax(is_gap) + 1]),
            f"follows a gap, and gaps are {100.0 * missing / intervals.sum():.3g} % of the recording; keep a piece "
            "between gaps",
        )


def reading_faults(recording: Recording) -> Iterator[Fault]:
    """A column that is constant, has an outlier, has one value again and again, or is cut off."""
    for key, readings in zip(recording.columns, recording.readings, strict=True):
        name = recording.names[key].lstrip("-")
        scale = UNITS[recording.unit]
        if np.ptp(readings) == 0.0:
            yield f"has the same value in every line of the column {name}; check the sensor and its channel"
            return
        sizes = np.abs(readings - np.median(readings))
        if sizes.max() > OUTLIER * np.quantile(sizes, 0.95) > 0.0:
            sample = int(np.argmax(sizes))
            yield (
                int(recording.lines[sample]),
                f"{name} = {readings[sample] / scale:.4g} stands out of all other values; check the cable, and "
                f"{remedy_of_line(recording.sampling == 'rate')}",
            )
            return
        if (value := repeated_value(readings)) is not None:
            is_failed = readings == value
            yield (
                int(recording.lines[np.argmax(is_failed)]),
                f"and {np.count_nonzero(is_failed) - 1:,} further lines have {name} = {value / scale:.4g}, as where "
                f"readings fail; {remedy_of_line(recording.sampling == 'rate')}",
            )
            return
        if (sample := clipped(readings, recording.quanta.max())) is not None:
            yield (
                int(recording.lines[sample]),
                f"{name} = {readings[sample] / scale:.4g} is cut off there and in other cycles; record again "
                "with a larger range of the sensor",
            )


def time_faults(recording: Recording) -> Iterator[Fault]:
    """Times that are too coarse for the samples."""
    equal = np.flatnonzero(np.diff(recording.time) == 0.0) + 1
    remedy = "export the time with more digits, or, if the sensor measures evenly, state excitation.rate (Hz)"
    if len(equal) > MOST_EQUAL * len(recording.time):
        yield (
            int(recording.lines[equal[0]]),
            f"and {len(equal) - 1:,} further lines repeat the time of the line before; {remedy}",
        )
    elif recording.rate_error > MOST_RATE_ERROR:
        rate = f"its rate is known to {100 * recording.rate_error:.2g} % only"
        yield f"has times that are rounded, or may be, so that {rate}; {remedy}"


def step_faults(signal: Signal) -> Iterator[Fault]:
    """A column with too few different values to show a wave, and without noise that would make up for it."""
    recording = signal.recording
    for key, readings, quantum in zip(recording.columns, recording.readings, recording.quanta, strict=True):
        noise = max(float((signal.fitted.residual**2).mean()) - quantum**2 / 12.0, 0.0)
        values = round(float(np.ptp(readings)) / quantum) + 1
        if values < LEAST_VALUES and noise < (FINER * quantum) ** 2:
            yield (
                f"has only {values} different values in the column {recording.names[key].lstrip('-')}; record again "
                "with a finer resolution, or a smaller range of the sensor"
            )
            return


def hold_faults(signal: Signal) -> Iterator[Fault]:
    """Readings of a slower channel, which are held until the next one."""
    recording = signal.recording
    for key, readings, quantum in zip(recording.columns, recording.readings, recording.quanta, strict=True):
        changes = np.abs(np.diff(readings)) / quantum
        held = changes < 0.5
        share = min(part.mean() for part in np.array_split(held, PIECES))
        if share > HELD and share * np.median(changes[~held]) > MOVING:
            yield (
                f"repeats the reading of the line before in {100.0 * share:.0f} % of the lines of the column "
                f"{recording.names[key].lstrip('-')}, as where one channel is slower than the other, which makes its "
                "phase and its amplitude wrong; export the readings of both channels as they were measured"
            )
            return


def interpolation_faults(signal: Signal) -> Iterator[Fault]:
    """Samples on straight lines between those that a slower sensor has measured."""
    recording = signal.recording
    # Few phases repeat the same few triples of samples, so that their shares are chance, unless noise changes them.
    # Second differences leave out what drifts slowly.
    noise = float(np.diff(signal.fitted.residual, 2).std()) / math.sqrt(6.0)
    if phases_of(signal.time, signal.fitted) < VARIED and noise < COARSE * recording.quanta.max():
        return
    intervals = np.maximum(np.diff(recording.time), 1e-12)
    weight = intervals[1:] / (intervals[1:] + intervals[:-1])
    for key, readings, quantum in zip(recording.columns, recording.readings, recording.quanta, strict=True):
        between = weight * readings[:-2] + (1.0 - weight) * readings[2:]
        off = np.abs(readings[1:-1] - between) / quantum
        # The roundings of three readings are at most one step. Of a wave, or noise, more lie within the next two steps,
        # unless nearly all do.
        on, near, far = off < 1.01, (off >= 1.01) & (off < 3.01), off >= 3.01
        share = min(part.mean() for part in np.array_split(on, PIECES))
        if share > LINES and on.mean() > STRAIGHT * near.mean() and far.mean() > LINES:
            yield (
                f"has {100.0 * share:.0f} % of the samples of the column {recording.names[key].lstrip('-')} on "
                "straight lines between the samples beside them, as where a slower sensor is interpolated, which makes "
                "amplitudes and harmonics smaller; export the samples as they were measured"
            )
            return


def subharmonic_faults(signal: Signal) -> Iterator[Fault]:
    """A fundamental that may be a weak subharmonic of the drive: every second (third, fourth) cycle differs."""
    frequency = signal.fitted.frequency
    sizes = np.hypot(*np.abs(signal.fitted.amplitudes))
    order = 1 + int(np.argmax(sizes))
    drive = order * frequency
    cycle = CYCLES.get(order)
    if cycle and not signal.settings.get("frequency") and sizes[order - 1] > WEAK * sizes[0]:
        yield (
            f"vibrates at {drive:.5g} Hz and, with {100.0 * sizes[0] / sizes[order - 1]:.2g} % of that, at "
            f"{frequency:.5g} Hz: set model.frequency: {frequency:.5g} if the drive has a strong harmonic; if it "
            f"vibrates at {drive:.5g} Hz and every {cycle} cycle differs, record the plate without parts"
        )
        return
    order = round(frequency / signal.extra_line[0]) if signal.extra_line else 0
    if order in CYCLES and abs(order * signal.extra_line[0] - frequency) < 1.0 / duration_of(signal.time):
        yield (
            f"differs in every {CYCLES[order]} cycle: it vibrates at {frequency:.5g} Hz and, with "
            f"{signal.extra_line[1]:.2g} m/s², at {signal.extra_line[0]:.5g} Hz, as where parts bounce on the plate, "
            "or a magnet is fed unevenly; record the plate without parts, and mend the feed of the magnet"
        )


def count_faults(signal: Signal) -> Iterator[Fault]:
    """Too few cycles or too few samples in a cycle."""
    frequency, stated = signal.fitted.frequency, signal.settings.get("frequency")
    cycles, per_cycle = duration_of(signal.recording.time) * frequency, signal.rate / frequency
    if cycles < LEAST_CYCLES - 0.1:
        yield f"holds {cycles:.2g} cycles of {frequency:.3g} Hz; record at least {LEAST_CYCLES}"
    elif per_cycle < LEAST_PER_CYCLE - 0.1:
        repeated = " (without lines that repeat the one before)" if signal.recording.repeated else ""
        yield (
            f"has {per_cycle:.2g} samples in a cycle of {frequency:.4g} Hz{repeated}, or the drive is faster and "
            f"aliased; sample at least {LEAST_PER_CYCLE} times in a cycle, with the sensor's anti-aliasing filter"
        )
    elif stated and stated > 0.5 * signal.rate:
        alias = abs(stated - round(stated / signal.rate) * signal.rate)
        if abs(alias - frequency) < 0.02 * frequency:
            yield (
                f"is sampled at {signal.rate:.4g} Hz, at which a drive of {stated:g} Hz (model.frequency) looks like "
                f"one of {frequency:.3g} Hz (aliasing); sample at {LEAST_PER_CYCLE * stated:g} Hz or more"
            )


def or_harmonic(signal: Signal) -> str:
    """What else a change from sample to sample may be, if half of the sampling rate is a multiple of the drive's."""
    if not (order := order_at_half(signal.time, signal.fitted)):
        return ""
    return f", or the drive has a harmonic of order {order - 1} or {order + 1}, which another sampling rate shows"


def sampling_faults(signal: Signal) -> Iterator[Fault]:
    """Samples that are lost, or whose times are wrong."""
    modulation = signal.modulation
    phase_per_sample = 2.0 * math.pi * signal.fitted.frequency / signal.rate
    line = timing_line(signal.time, signal.fitted, modulation)
    if line and line[0] * signal.rate < 0.25 * signal.fitted.frequency and not is_sawtooth(modulation, line[0]):
        yield (
            f"has a phase that swings by {line[1]:.2g} rad at {line[0] * signal.rate:.3g} Hz: the drive hunts, or the "
            "times are not those of the samples; keep a piece in which the drive runs steadily, or record the time of "
            "each sample"
        )
    elif line:
        every = 1.0 / line[0] + 1.0
        right = signal.fitted.frequency * (every - 1.0) / every
        yield (
            f"has a phase that swings by {line[1]:.2g} rad over {1.0 / line[0]:.4g} samples, as no vibration does: the "
            f"times are not those of the samples{or_harmonic(signal)}. If one of {every:.3g} samples is lost, the "
            f"drive vibrates at {right:.5g} Hz; record without losses, or with the time of each sample"
        )
    elif not signal.is_as_stated and (
        every := loss_in_step(signal.time, signal.recording.acceleration[:, : len(signal.time)], signal.fitted)
    ):
        yield (
            f"has harmonics that vanish if one of {every} samples is lost, and then the drive vibrates at "
            f"{signal.fitted.frequency * (every - 1.0) / every:.5g} Hz; record without losses, or with the time of "
            "each sample"
        )
    elif (jump := signal.jump("imag")) and abs(jump.size) > LEAST_LOSS * phase_per_sample:
        yield (
            int(signal.recording.lines[jump.sample]),
            f"follows a jump of the phase by {jump.size:.2g} rad, as where samples are lost and the times do not show "
            f"it, so that the frequency would be wrong by {abs(jump.shift):.2g} Hz; keep a piece without the jump, or "
            "record without losses",
        )
    elif (lost := losses_of(signal.time, signal.fitted, modulation)).is_sure:
        yield (
            f"has a phase that jumps, as where about {max(lost.count, 1.0):.0f} samples are lost and the times do not "
            "show it, so that its frequency is wrong; record without losses, or with the time of each sample"
        )
    elif modulation.scatter > MOST_SCATTER:
        scatter = modulation.scatter / (2.0 * math.pi * signal.fitted.frequency)
        yield (
            f"has times that differ by {scatter:.2g} s (standard deviation) from those of the samples; record the "
            "time of each sample, or, if the sensor measures evenly, state excitation.rate (Hz)"
        )


def sensor_faults(signal: Signal) -> Iterator[Fault]:
    """Two sensors in one file, line by line or one after the other."""
    recording, fitted = signal.recording, signal.fitted
    if half := alternates(signal.modulation):
        yield (
            f"alternates from line to line between amplitudes that differ by {200.0 * half:.2g} %, as two sensors in "
            f"one file do, or one whose samples are lost regularly{or_harmonic(signal)}; keep the lines of one sensor, "
            "and record without losses"
        )
    elif jump := signal.jump("real"):
        parts = slice(0, jump.sample), slice(jump.sample, len(signal.time))
        # The offset of a shorter piece is not that of the sensor.
        if min(duration_of(signal.time[part]) for part in parts) * fitted.frequency < LEAST_CYCLES:
            return
        first, last = (
            fit(recording.time[part], recording.acceleration[:, part], fitted.frequency, fitted.orders)
            for part in parts
        )
        change = float(np.hypot(*(last.offsets - first.offsets)))
        noise = math.sqrt(sum((part_fit.residual**2).mean() / part_fit.residual.shape[1] for part_fit in (first, last)))
        if change > LEAST_CHANGE * STANDARD_GRAVITY + SURE * noise:
            yield (
                int(recording.lines[jump.sample]),
                f"follows a change of the amplitude by {100.0 * abs(jump.size):.2g} % and of gravity by {change:.2g} "
                "m/s², as where the lines of another sensor, or of another mount, begin; keep the lines of one sensor",
            )


def mixture_faults(signal: Signal) -> Iterator[Fault]:
    """Lines of two sensors in any order."""
    recording, fitted = signal.recording, signal.fitted
    if (fitted.residual**2).mean() < recording.quanta.max() ** 2:  # steps of the converter make patterns, too
        return
    if difference := mixture_of(signal.time, recording.acceleration[:, : len(signal.time)], fitted):
        yield (
            f"mixes lines with amplitudes that differ by {100.0 * difference:.2g} %, as two sensors in one file do; "
            "keep the lines of one sensor"
        )
    elif (spread := signal.modulation.spread) > MOST_SPREAD:
        yield (
            f"has amplitudes that differ from line to line by {100.0 * spread:.2g} % (standard deviation), and phases "
            "that do not, as two sensors in one file do; keep the lines of one sensor"
        )


def saturation_faults(signal: Signal) -> Iterator[Fault]:
    """Peaks that are cut off, behind which there is noise."""
    recording, fitted = signal.recording, signal.fitted
    phases = np.sort(np.mod((recording.time - fitted.middle) * fitted.frequency, 1.0))
    gap = max(float(np.diff(phases).max()), 1.0 + phases[0] - phases[-1])
    is_fine = signal.rate / fitted.frequency > LEAST_FOR_TOPS
    centred = signal.time - fitted.middle
    design = design_of(centred, centred[-1], fitted.frequency, orders_of(signal.rate, fitted.frequency))
    for key, readings in zip(recording.columns, recording.readings, strict=True):
        quantum = recording.quanta.max()
        is_flat = flattened(readings, quantum, gap) or (is_fine and has_flat_tops(readings))
        if is_flat or is_cut_off(readings[: len(centred)], quantum, design):
            yield (
                f"has cut-off peaks in the column {recording.names[key].lstrip('-')}; record again with a larger range "
                "of the sensor"
            )
            return


def ambiguity_faults(signal: Signal) -> Iterator[Fault]:
    """Other times of the samples that are as likely, and with which the drive has another frequency.

    Buffers that are stamped faster than they were measured look like a faster drive, sampled in bursts.
    """
    frequency, stated = signal.fitted.frequency, signal.settings.get("frequency")
    for alternative in () if signal.is_as_stated else signal.recording.others:
        time = alternative.time[:CHECKED]
        other_frequency = first_fit(time, alternative.acceleration[:, :CHECKED], stated)[0].frequency
        if abs(other_frequency - frequency) > DIFFERENT / duration_of(time):
            yield (
                f"fits a drive of {frequency:.5g} Hz and, with other times of its samples, one of "
                f"{other_frequency:.5g} Hz; state model.frequency, and excitation.rate: "
                f"{(len(time) - 1) / np.ptp(time):.5g} if the sensor measures evenly"
            )
            return


def size_deviation(signal: Signal, pieces: int) -> float:
    """Relative standard deviation of the effective value from piece to piece, whatever the phase does."""
    fitted = signal.fitted
    vibration = signal.recording.acceleration[:, : len(signal.time)] - fitted.offsets[:, None]
    sizes = np.array([math.sqrt((piece**2).mean()) for piece in np.array_split(vibration, pieces, axis=1)])
    return float(sizes.std(ddof=1) / sizes.mean())


def is_unsteady(steady: Mapping[str, float]) -> bool:
    """Whether the fundamental varies from piece to piece, by `steadiness`."""
    return steady["deviation"] > max(UNSTEADY, 3.0 * steady["deviation_of_noise"])


def phase_faults(signal: Signal) -> Iterator[Fault]:
    """A phase that wanders, so far that the fundamental gets smaller in some pieces, though the vibration does not."""
    steady = steadiness(signal.time, signal.fitted)
    size = size_deviation(signal, steady["pieces"])
    turns = is_unsteady(steady) and size < 0.5 * steady["deviation"]
    # Where a drive stops, the phase is that of noise.
    if turns or (steady["wander"] > MOST_WANDER and size < UNSTEADY):
        yield (
            f"has a phase that wanders by {steady['wander']:.2g} rad (standard deviation) against "
            f"{signal.fitted.frequency:.4g} Hz: samples are lost, or the drive does not run steadily; record without "
            "losses, or with the time of each sample, and keep a piece in which the drive runs steadily"
        )


def clock_faults(signal: Signal) -> Iterator[Fault]:
    """A phase between both axes that drifts, as of two loggers."""
    change = drift_between_axes(signal.time, signal.fitted)
    if abs(change) > MOST_DRIFT:
        relative = abs(change) / (2.0 * math.pi * signal.fitted.frequency * np.ptp(signal.time))
        yield (
            f"has a phase between both axes that drifts by {abs(change):.2g} rad from begin to end: two loggers with "
            f"clocks that differ by {1e6 * relative:.3g} ppm measured the axes, a second vibration is near, or the "
            "drive changes; record both axes with one logger, and keep a piece in which the drive runs steadily"
        )


def steadiness_faults(signal: Signal) -> Iterator[Fault]:
    """An amplitude that changes, or a second vibration."""
    frequency = signal.fitted.frequency
    extra_line = signal.extra_line
    steady = steadiness(signal.time, signal.fitted)
    if is_unsteady(steady):
        yield (
            f"is not steady: its amplitude at {frequency:.4g} Hz varies by {100.0 * steady['deviation']:.2g} % "
            "(standard deviation); keep a piece in which the drive runs steadily, and record one drive alone"
        )
    elif extra_line:
        yield (
            f"vibrates at {frequency:.4g} Hz and, with {extra_line[1]:.2g} m/s², at {extra_line[0]:.4g} Hz, no "
            "multiple of it; record one drive alone, and use the sensor's anti-aliasing filter, because a harmonic "
            "above half the sampling rate looks like such a line"
        )


def repeat_faults(signal: Signal) -> Iterator[Fault]:
    """A stated rate that may count lines or samples, if lines repeat the one before."""
    rate, repeated = signal.settings.get("rate"), signal.recording.repeated
    if rate and repeated and not signal.is_as_stated:
        yield (
            f"repeats the readings of the line before in {repeated:,} lines; if excitation.rate = {rate:g} is the rate "
            f"of the sensor, delete these lines; if it counts all lines, state model.frequency: "
            f"{signal.fitted.frequency:.5g}"
        )


def frequency_faults(signal: Signal) -> Iterator[Fault]:
    """A frequency other than the stated one, or one that no conveyor has."""
    frequency, stated = signal.fitted.frequency, signal.settings.get("frequency")
    acceleration = float(np.hypot(*signal.sizes))
    displacement = acceleration / (2.0 * math.pi * frequency) ** 2
    has_unit = size_fault(gravity_of(signal.fitted, 0.0), acceleration, signal.recording.unit) is None
    if has_unit and displacement > MOST_DISPLACEMENT and acceleration < MOST_ACCELERATION:
        # Another unit in which the frequency would be one of a conveyor.
        stated_unit = signal.recording.time_unit
        scales = {name: scale / TIME_UNITS[stated_unit] for name, scale in TIME_UNITS.items() if name != stated_unit}
        fits = [name for name, scale in scales.items() if LEAST_FREQUENCY < frequency / scale < MOST_FREQUENCY]
        remedy = f"set excitation.time_unit: {fits[0]} if that is the unit of the times, or " if fits else ""
        yield (
            f"vibrates with {acceleration:.4g} m/s² at {frequency:.3g} Hz; the plate would move by {displacement:.3g} "
            f"m: {remedy}sample faster if the drive is faster (aliasing)"
        )
    elif frequency > MOST_FREQUENCY:
        remedy = "state the unit of its times as excitation.time_unit (s, ms, µs, ns)"
        fits = [name for name, unit in LONG.items() if LEAST_FREQUENCY < frequency / unit < MOST_FREQUENCY]
        if fits:
            remedy = f"its times may be in {' or '.join(fits)}; export them in s"
        yield f"vibrates at {frequency:.5g} Hz, as no conveyor does; {remedy}"
    elif stated and not signal.is_as_stated:
        factor = frequency / stated
        if abs(factor - 2.0) < 2.0 * OTHER_FREQUENCY:
            yield (
                f"vibrates at {frequency:.5g} Hz, twice model.frequency = {stated:g}; a magnet pulls twice in each "
                f"cycle of the mains: set model.frequency: {frequency:.5g}, or correct its times"
            )
            return
        lost = f", if one of {factor / (factor - 1.0):.3g} samples is lost," if 1.0 < factor < 2.0 else ""
        yield (
            f"vibrates at {frequency:.5g} Hz, but model.frequency is {stated:g}; its times are wrong by a factor of "
            f"{factor:.5g}{lost} and its rate would be {signal.rate / factor:.5g} Hz, or set model.frequency: "
            f"{frequency:.5g} if the drive runs at that frequency"
        )


def unit_faults(signal: Signal) -> Iterator[Fault]:
    """A mean that is not gravity, or an amplitude that no conveyor has."""
    unit = signal.recording.unit
    acceleration = float(np.hypot(*signal.sizes))
    gravity = gravity_of(signal.fitted, signal.settings.get("inclination", 0.0))
    converted = f", which is {acceleration:.4g} m/s²" if UNITS[unit] != 1.0 else ""
    shown = f"vibrates with {acceleration / UNITS[unit]:.4g} {unit}{converted}"
    if fault := size_fault(gravity, acceleration, unit):
        yield fault
    elif acceleration > MOST_ACCELERATION:
        yield f"{shown}; no conveyor does: state another excitation.unit ({', '.join(UNITS)})"
    elif acceleration < LEAST_ACCELERATION:
        remedy = f"state another excitation.unit ({', '.join(UNITS)}; not a voltage), and record while the drive is on"
        yield f"{shown}; that moves no part: {remedy}"
    elif fault := direction_fault(signal.recording, gravity, signal.settings):
        yield fault


def share_faults(signal: Signal) -> Iterator[Fault]:
    """A fundamental that is missing, or too weak for its harmonics."""
    fitted, sizes = signal.fitted, signal.sizes
    directions = list(DIRECTIONS.values())
    noise = np.sqrt(4.0 * (fitted.residual**2).mean(axis=1) / fitted.residual.shape[1])
    for axis, direction in enumerate(directions):
        if sizes[axis] < max(NO_FUNDAMENTAL * np.hypot(*sizes), 4.0 * noise[axis]):
            yield (
                f"shows no vibration {direction} at {fitted.frequency:.4g} Hz ({sizes[axis]:.2g} m/s²), to which "
                "shares of harmonics and phases refer; check excitation.columns and excitation.mount"
            )
            return
    shares = np.abs(fitted.amplitudes) / sizes[:, None]
    if shares.max() > MOST_SHARE:
        axis, place = np.unravel_index(np.argmax(shares), shares.shape)
        yield (
            f"vibrates {directions[axis]} {shares[axis, place]:.3g} times as much at "
            f"{(place + 1) * fitted.frequency:.4g} Hz as at {fitted.frequency:.4g} Hz, to which shares of harmonics "
            f"refer; model.harmonics take shares up to {MOST_SHARE:g}: check excitation.columns and excitation.mount, "
            "and record one drive alone"
        )


def stated_faults(signal: Signal) -> Iterator[Fault]:
    """An angle of throw or a phase shift other than the stated one."""
    along, normal = signal.fitted.amplitudes[:, 0]
    measured = {
        "angle": math.atan2(abs(normal), abs(along)),
        "phase_shift": float(wrap(np.angle(along) - np.angle(normal))),
    }
    for name, value in measured.items():
        stated = signal.settings.get(name)
        if stated is not None and abs(wrap(value - stated)) > OTHER_DIRECTION:
            yield (
                f"has the {name.replace('_', ' ')} {value:.4g} rad, but model.{name} is {stated:.4g} rad; check "
                f"excitation.mount and the signs of the axes, or leave model.{name} out"
            )


# Where a group finds faults, the next ones would only find their consequences.
OF_TIMES = ((time_faults,), (gap_faults,))
OF_SIGNAL = (
    (count_faults,),
    (step_faults,),
    (hold_faults,),
    (interpolation_faults,),
    (sensor_faults,),
    (subharmonic_faults,),
    (repeat_faults,),
    (frequency_faults, sampling_faults),
    (phase_faults,),
    (clock_faults,),
    (saturation_faults,),
    (mixture_faults,),
    (unit_faults, steadiness_faults),
    (ambiguity_faults,),
    (share_faults,),
    (stated_faults,),
)


def signal_of(recording: Recording, settings: Mapping[str, Any], samples: int = CHECKED) -> Signal:
    """The first samples of a recording, with their fit."""
    time = recording.time[:samples]
    fitted, extra_line = first_fit(time, recording.acceleration[:, :samples], settings.get("frequency"))
    return Signal(recording, fitted, extra_line, modulation_of(time, fitted), settings)


def later_faults(
    recording: Recording, fitted: Fit, extra_line: tuple[float, float] | None, settings: Mapping[str, Any]
) -> list[tuple[int | None, str]]:
    """The faults behind the samples that `checked` has seen, in pieces, and changes between pieces.

    fitted, extra_line : of the whole recording, see `Signal`
    """
    count = len(recording.time)
    place = np.arange(len(recording.time))
    length = max(CHECKED, math.ceil(2 * LEAST_CYCLES * sampling_rate(recording.time) / fitted.frequency))
    # The checked samples have shown which line is the fundamental.
    known = {**settings, "frequency": fitted.frequency}
    for end in [*range(CHECKED + length, count, length), count] if count > CHECKED else ():
        piece = keep(recording, (place >= end - length) & (place < end))._replace(others=())
        if faults := first_faults(signal_of(piece, known, length), OF_SIGNAL[1:]):
            lines = f"in the lines {piece.lines[0]:,} to {piece.lines[-1]:,}, it"
            return [(line, fault if line else f"{lines} {fault}") for line, fault in faults]
    whole = Signal(recording, fitted, extra_line, modulation_of(recording.time, fitted), settings)
    return first_faults(whole, ((phase_faults,), (clock_faults,), (steadiness_faults,)))


def first_faults(subject: Any, groups: tuple) -> list[tuple[int | None, str]]:
    """Line (None for the whole file) and description of each fault that the first group with faults finds."""
    for group in groups:
        if faults := [fault for check in group for fault in check(subject)]:
            return [fault if isinstance(fault, tuple) else (None, fault) for fault in faults]
    return []


def checked(table: Any, settings: Mapping[str, Any]) -> Recording:
    """The recording in a table of common.csv_table, whose error names all faults with file and line.

    settings : as in `parse`, and optionally `inclination` (rad) of the track and the parameters DRIVE that are stated
    """
    raw = parse(table, settings)
    # A reading that is repeated would look like a value at which a sensor stays.
    if faults := first_faults(keep(raw, ~repeats(raw)), ((reading_faults,),)):
        raise table.error(faults)
    recording = resolve(raw)
    faults = first_faults(recording, OF_TIMES) or first_faults(signal_of(recording, settings), OF_SIGNAL)
    if faults:
        raise table.error(faults)
    return recording
