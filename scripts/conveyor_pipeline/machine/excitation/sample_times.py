"""When the samples of a recording were taken, if the times in the file do not say it exactly.

Loggers round times, stamp all samples of a buffer at once, or read a sensor more often than it measures. Most sensors
measure evenly, so a recording has up to six interpretations: with its times as stamped, evenly spaced, or evenly spaced
but for lost samples, and with or without the lines that repeat the readings of the line before. The signal decides:
wrong times add power to what a periodic signal leaves, or, if their errors repeat in every cycle of the drive, to its
harmonics.
"""

import math
from typing import NamedTuple

import numpy as np

from conveyor_pipeline.machine.excitation.harmonics import Fit, first_fit, gaps_of
from conveyor_pipeline.machine.excitation.reading import Recording

CHECKED = 2**15  # samples that are searched for lines: more cost seconds at every start
# How the times follow from the file.
STAMPED, ROUNDED, EVEN = "stamped", "rounded", "even"  # beside "rate", as stated
LEAST_REPEATED = 3  # lines that repeat the one before, from which it may be no chance
WORSE = 1.3  # times the smallest residual variance, from which an interpretation is wrong
BETTER = 0.98  # times the power beside the fundamental of the times as stamped, below which others are better
LIKELY = 2.0  # times the power beside the fundamental of the chosen times, up to which others may be right, too
FINE = 0.25  # of the mean interval: rounding by less is no sign of lost samples
LEEWAY = 1.5  # of deviations from a straight line over the resolution, up to which times are rounded
CLUSTER = 0.2  # width of a cluster of intervals, in units of the distance between two
MOST_LOST = 0.2  # share of the samples that may be lost where rounded times show each loss
FEW_GAPS = 0.002  # share of the intervals, beside one; more are the pauses between buffers
MOST_GAPS = 0.75  # share of the recording without samples, beyond which cycles cannot be counted across gaps
# Share of the lines that may repeat the time of the line before, as rounded times of random samples do. Where rounding
# makes more of them equal, it is coarse enough to blur the harmonics.
MOST_EQUAL = 0.05
BENT = 4.0  # standard errors of the rate in half of a recording, from which it differs from that in the other
COUNTS, CLEARLY = 4, 0.9  # rounds in which samples are counted, and intervals by which their times may deviate
DIGITS = 12  # decimals of times that are searched for their resolution


class Even(NamedTuple):
    """Evenly spaced times near those of a file."""

    time: np.ndarray  # s, shape (n,)
    deviation: float  # s, largest minus smallest difference from the times of the file
    resolution: float  # s, of the times of the file
    rate_error: float  # relative standard error of the sampling rate


def resolution_of(time: np.ndarray) -> float:
    """Resolution of times (s): the distance between the two lengths that their intervals have, if they have two, or
    else the last decimal."""
    intervals, is_gap = gaps_of(time)
    intervals = np.sort(intervals[~is_gap])
    jumps = np.diff(intervals)
    if len(jumps) and (jump := jumps.max()) > 0.0:
        place = int(np.argmax(jumps))
        widths = intervals[place] - intervals[0], intervals[-1] - intervals[place + 1]
        if max(widths) < CLUSTER * jump:
            return float(jump)
    return last_decimal(time)


def last_decimal(time: np.ndarray) -> float:
    """The last decimal of times, s; 0 if they have too many."""
    for digits in range(DIGITS):
        if np.abs(time - np.round(time, digits)).max() < 1e-4 * 10.0**-digits:
            return 10.0**-digits
    return 0.0


def numbers_of(time: np.ndarray) -> np.ndarray:
    """The numbers of samples without losses, shape (n,): only long gaps take more than one."""
    intervals, is_gap = gaps_of(time)
    if np.count_nonzero(is_gap) > 1 + FEW_GAPS * len(intervals) or not intervals[~is_gap].any():
        is_gap = np.zeros_like(is_gap)
    steps = np.where(is_gap, np.maximum(np.round(intervals / intervals[~is_gap].mean()), 1.0), 1.0)
    return np.concatenate([[0.0], np.cumsum(steps)])


def numbers_with_losses(time: np.ndarray) -> np.ndarray | None:
    """The numbers of samples of which some are lost, if times that are rounded by less than an interval show each loss,
    or None."""
    intervals = np.diff(time)
    usual = float(np.median(intervals))
    widest = LEEWAY * resolution_of(time)
    if usual <= 0.0:
        return None
    for _ in range(COUNTS):
        steps = np.maximum(np.round(intervals / usual), 1.0)
        numbers = np.concatenate([[0.0], np.cumsum(steps)])
        usual, start = np.polyfit(numbers, time, 1)
    span = np.ptp(time - start - usual * numbers)
    is_clear = span <= min(widest, CLEARLY * usual)
    return numbers if is_clear and 1.0 < steps.mean() < 1.0 + MOST_LOST else None


def even(time: np.ndarray, index: np.ndarray) -> Even:
    """The straight line through times over the numbers of the samples, shape (n,)."""
    slope, start = np.polyfit(index - index.mean(), time, 1)
    fitted = start + slope * (index - index.mean())
    residual = time - fitted
    resolution = resolution_of(time)
    span = float(np.ptp(residual))
    # Errors of one sign side by side have one cause, so runs of them count, not samples. The last decimal may hide any
    # slow error.
    runs = 1 + np.count_nonzero(np.diff(residual > 0.0))
    scatter = max(float(residual.std()) * math.sqrt(12.0 / runs), min(last_decimal(time), slope) / math.sqrt(3.0))
    # Clocks that change their rate leave a bend.
    halves = [slice(None, len(time) // 2), slice(len(time) // 2, None)]
    bend = max(abs(np.polyfit(index[half] - index[half].mean(), residual[half], 1)[0]) for half in halves)
    chance = float(residual.std()) * math.sqrt(12.0 * 8.0 / len(time)) / (index[-1] - index[0])
    return Even(fitted, span, resolution, max(scatter / np.ptp(time), bend / slope if bend > BENT * chance else 0.0))


def repeats(recording: Recording) -> np.ndarray:
    """Which lines repeat both readings of the line before, shape (n,)."""
    is_repeated = (np.diff(recording.readings, axis=1) == 0.0).all(axis=0)
    return np.concatenate([[False], is_repeated])


def keep(recording: Recording, mask: np.ndarray) -> Recording:
    """A part of the samples."""
    return recording._replace(
        time=recording.time[mask],
        acceleration=recording.acceleration[:, mask],
        readings=recording.readings[:, mask],
        lines=recording.lines[mask],
    )


def is_even(line: Even) -> bool:
    """Whether the times of the file are themselves evenly spaced."""
    return line.deviation < 1e-6 * float(np.ptp(line.time)) / len(line.time)


def interpretations(recording: Recording) -> list[Recording]:
    """The recording as stamped, and with other times that its lines may mean."""
    is_repeated = repeats(recording)
    stamped = [recording]
    if np.count_nonzero(is_repeated) >= LEAST_REPEATED and np.count_nonzero(~is_repeated) > 2:
        stamped.append(keep(recording, ~is_repeated)._replace(repeated=int(np.count_nonzero(is_repeated))))

    def rate_error(line: Even) -> float:
        return line.rate_error if recording.sampling == STAMPED else 0.0

    versions, spaced = [], []
    for version in stamped:
        line = even(version.time, numbers_of(version.time))
        if is_even(line):
            versions.append(version._replace(rate_error=rate_error(line)))
            continue
        versions.append(version._replace(resolution=last_decimal(version.time)))
        lines = [line]
        if (numbers := numbers_with_losses(version.time)) is not None:
            lines.append(even(version.time, numbers))
        for candidate in lines:
            sampling = ROUNDED if candidate.deviation <= LEEWAY * candidate.resolution else EVEN
            spaced.append(version._replace(time=candidate.time, sampling=sampling, rate_error=rate_error(candidate)))
    return versions + spaced


def is_usable(recording: Recording) -> bool:
    """Whether the times may be those of the samples: they are not mostly gaps, and few are equal."""
    intervals, is_gap = gaps_of(recording.time)
    return intervals[is_gap].sum() <= MOST_GAPS * intervals.sum() and (intervals == 0.0).mean() <= MOST_EQUAL


def residual_variance(fitted: Fit) -> float:
    """Variance of the residual of both axes (m²/s⁴)."""
    count = fitted.residual.shape[1]
    return float((fitted.residual**2).sum()) / max(count - 2.0 * fitted.orders - 2.5, 1.0)


def power_beside_fundamental(fitted: Fit) -> float:
    """Mean square (m²/s⁴) of what the fundamental leaves: harmonics, and the residual."""
    return residual_variance(fitted) + 0.5 * float((np.abs(fitted.amplitudes[:, 1:]) ** 2).sum())


def resolve(recording: Recording) -> Recording:
    """The recording with the times that its signal fits best.

    Errors of the times that repeat in every cycle make harmonics and hardly change the residual, so where other times
    are possible, `others` has them.
    """
    if np.ptp(recording.time) == 0.0:  # a fault that is named later
        return recording
    versions = [version for version in interpretations(recording) if is_usable(version)] or [recording]
    if len(versions) == 1:
        return versions[0]
    fits = [first_fit(version.time[:CHECKED], version.acceleration[:, :CHECKED])[0] for version in versions]
    residuals, powers = (
        np.array([power(fit) for fit in fits]) for power in (residual_variance, power_beside_fundamental)
    )
    possible = residuals <= WORSE * residuals.min()
    interval = np.diff(recording.time).mean()
    for place, version in enumerate(versions):
        is_rounded = version.sampling == ROUNDED and not version.repeated
        if possible[place] and is_rounded and resolution_of(recording.time) < FINE * interval:
            return version
    best = int(np.argmin(np.where(possible, powers, np.inf)))
    best = 0 if possible[0] and powers[best] > BETTER * powers[0] else best
    if versions[best].sampling == ROUNDED:
        return versions[best]
    likely = possible & (powers <= LIKELY * powers[best])
    return versions[best]._replace(
        others=tuple(version for place, version in enumerate(versions) if likely[place] and place != best)
    )
