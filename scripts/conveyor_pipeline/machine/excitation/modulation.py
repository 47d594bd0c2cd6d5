"""Errors of a recording that follow the number of the sample, not the motion of the plate.

What the fundamental A cos θ leaves of a signal, times cos θ and −sin θ, tells relative errors of its amplitude and
errors of its phase as functions of time. A vibration of another frequency has both, in equal parts. Lost samples and
wrong times have errors of the phase alone, and alternating samples of two sensors errors of the amplitude alone, also
where a line of their spectrum lies at a multiple of the drive's frequency, like a harmonic.
"""

import math
from typing import NamedTuple

import numpy as np

from conveyor_pipeline.machine.excitation.harmonics import Fit, duration_of, project, sampling_rate

NEARBY = 41  # frequencies whose median is the noise at the one in the middle
OUT_OF_NOISE = 6.0  # times the noise, from which a line is none of it
ONE_SIDED = 3.0  # ratio of both parts from which a line is no vibration of another frequency,
LOCKED = 20.0  # and the ratio at multiples of the drive's frequency, where two harmonics may look like it
FOOT = 2.5  # half width of a line in units of 1/T, and
SLOW = 4.0  # frequencies that are slow changes of the drive
# Least amplitude of the phase error of lost samples, in units of the phase between two samples; 1/π in theory.
LOST = 0.12
LEAST_PHASE = 0.005  # rad, of a slower swing than a quarter of the drive's frequency: a motor may hunt
LEAST_GAIN, ALTERNATING = 0.003, 5.0
# Modulation frequencies, in units of the drive's, at which phases that jump have power; it is compared with the noise
# at higher frequencies and with the power of the amplitude.
JUMPS, ABOVE_JUMPS = (0.1, 0.5), 1.5
LEAST_LINES, MANY_LINES, LEAST_LOST = 5, 10, 0.3
SHORT = 0.25  # lowest of these frequencies in a short recording, in units of the drive's
# The first frequencies tell a jump from a swing of the phase: a jump alone leaves at most this share of their power.
SLOW_LINES, ALONE = 7, 0.1
EDGE = 0.03  # energy that a straight line leaves of a step, per sample, below which the step is too near an end
PLACES = 50.0  # of a jump in a recording, as if their noise were independent
HALF_RATE = 8  # highest order of a harmonic that may have half of the sampling rate
# Samples that are tried with losses at the same phases of each cycle; most losses in a cycle, and fewest samples
# between two; least amplitude of harmonics over the fundamental's; shares of their power, and of the rest's, that may
# remain.
TRIED, MOST_LOSSES, LEAST_BETWEEN, LEAST_SHARE, VANISHED, KEPT = 4096, 8, 3, 0.005, 0.2, 1.1
SCATTERED = 1.5  # ratio of the powers of both parts from which times, or amplitudes from line to line, scatter


class Modulation(NamedTuple):
    """Spectra of the errors of phase and amplitude over the number of the sample."""

    frequency: np.ndarray  # cycles per sample, shape (m,)
    phase: np.ndarray  # rad, amplitude, shape (m,)
    gain: np.ndarray  # relative amplitude, shape (m,)
    alternating: np.ndarray  # relative amplitude of an error of the amplitude and of the phase (rad) that changes its
    # sign from sample to sample, of each axis, shape (2, 2)
    alternating_noise: np.ndarray  # its standard deviation, shape (2,)
    scatter: float  # rad, standard deviation of errors of the phase from sample to sample beyond those of the amplitude
    spread: float  # the same of relative errors of the amplitude beyond those of the phase

    @property
    def count(self) -> int:
        """Number of samples."""
        return 2 * (len(self.frequency) - 1)


def median_nearby(values: np.ndarray) -> np.ndarray:
    """Running median."""
    from scipy.ndimage import median_filter

    return median_filter(values, NEARBY, mode="mirror")


def modulation_of(time: np.ndarray, fitted: Fit) -> Modulation:
    """The errors that the fundamental leaves."""
    count = 2 * (len(time) // 2)
    first = np.exp(2j * math.pi * fitted.frequency * (time[:count] - fitted.middle))
    wave = first.copy()
    residual = fitted.residual[:, :count]
    remainder = residual.copy()
    for order in range(1, fitted.orders):
        wave *= first
        remainder += (fitted.amplitudes[:, order, None] * wave).real
    size = 0.5 * np.abs(fitted.amplitudes[:, 0]) ** 2
    # Real part: error of the amplitude; imaginary part: of the phase.
    turning = np.conj(fitted.amplitudes[:, :1] * first)
    products, window = remainder * turning, np.hanning(count)

    def spectra(errors: np.ndarray) -> list[np.ndarray]:
        return [np.abs(np.fft.rfft(window * part)) * 2.0 / window.sum() for part in (errors.real, errors.imag)]

    gain, phase = spectra(products.sum(axis=0) / size.sum())
    sign = window * np.where(np.arange(count) % 2 == 0, 1.0, -1.0) / window.sum()
    alternating = np.array([(sign * part).sum(axis=1) / size for part in (products.real, products.imag)]).T
    # Without the harmonics, which are no lines over the number of the sample, but noise, if the times are uneven.
    gain_floor, phase_floor = (np.median(part) ** 2 for part in spectra((residual * turning).sum(axis=0) / size.sum()))
    noise = np.sqrt((fitted.residual**2).mean(axis=1) / size) * math.sqrt((window**2).sum()) / window.sum()
    noise *= max(np.median(gain) / math.sqrt(gain_floor), 1.0)
    unit = 4.0 * (window**2).sum() / window.sum() ** 2 * math.log(2.0)
    scatter = math.sqrt((phase_floor - gain_floor) / unit) if phase_floor > SCATTERED * gain_floor else 0.0
    spread = math.sqrt((gain_floor - phase_floor) / unit) if gain_floor > SCATTERED * phase_floor else 0.0
    return Modulation(np.fft.rfftfreq(count), phase, gain, alternating, noise, scatter, spread)


def timing_line(time: np.ndarray, fitted: Fit, modulation: Modulation) -> tuple[float, float] | None:
    """Frequency (cycles per sample) and amplitude (rad) of the strongest error of the phase that no vibration makes."""
    count, drive = 2 * (len(time) // 2), fitted.frequency / sampling_rate(time)
    width = max(1, math.ceil(FOOT))
    near = np.max([np.roll(modulation.gain, shift) for shift in range(-width, width + 1)], axis=0)
    is_harmonic = np.abs(modulation.frequency - np.round(modulation.frequency / drive) * drive) * count < FOOT
    smallest = np.maximum(LOST * 2.0 * math.pi * drive, np.where(modulation.frequency < 0.25 * drive, LEAST_PHASE, 0.0))
    counts = modulation.phase > np.where(is_harmonic, LOCKED, ONE_SIDED) * near
    counts &= (modulation.phase > OUT_OF_NOISE * median_nearby(modulation.phase)) & (modulation.phase > smallest)
    counts &= modulation.frequency * count > SLOW
    place = int(np.argmax(np.where(counts, modulation.phase, 0.0)))
    return (float(modulation.frequency[place]), float(modulation.phase[place])) if counts[place] else None


def loss_in_step(time: np.ndarray, signals: np.ndarray, fitted: Fit) -> int | None:
    """The number of samples of which one is lost, at the same phases of each cycle, or None.

    Such losses look like harmonics, of which those from the third on vanish with the right times.
    """
    per_cycle = sampling_rate(time) / fitted.frequency
    harmonic_power = float((np.abs(fitted.amplitudes[:, 2:]) ** 2).sum())
    if harmonic_power < LEAST_SHARE**2 * float((np.abs(fitted.amplitudes[:, 0]) ** 2).sum()):
        return None
    residual_power = (fitted.residual**2).mean()
    part = signals[:, :TRIED]
    numbers = np.arange(part.shape[1])
    interval = 1.0 / sampling_rate(time)
    for losses in range(1, MOST_LOSSES + 1):
        between = round(per_cycle / losses)
        slip = abs(between * losses / per_cycle - 1.0) * fitted.frequency * duration_of(time)
        for first in range(between) if between >= LEAST_BETWEEN and slip < 1.0 else ():
            right = interval * (numbers + (numbers + first) // between)
            frequency = fitted.frequency * between / (between + 1.0)
            values, residual = project(right - 0.5 * (right[0] + right[-1]), part, frequency, fitted.orders)
            harmonics = values[2:].reshape(2, fitted.orders, 2)[:, 2:]
            if (harmonics**2).sum() < VANISHED * harmonic_power and (residual**2).mean() < KEPT * residual_power:
                return between + 1
    return None


def is_sawtooth(modulation: Modulation, frequency: float) -> bool:
    """Whether an error of the phase with a frequency (cycles per sample) rises slowly and falls at once, as by a sample
    that is lost again and again: twice this frequency has half of its amplitude, and none if a drive hunts."""
    sizes = [
        modulation.phase[np.abs(modulation.frequency - times * frequency) < 1.5 / modulation.count].max()
        for times in (1, 2)
    ]
    return bool(sizes[1] > 0.25 * sizes[0])


def order_at_half(time: np.ndarray, fitted: Fit) -> int | None:
    """The multiple of the drive's frequency that is half of the sampling rate, or None.

    Harmonics of the orders beside it change their sign from sample to sample.
    """
    multiple = 0.5 * sampling_rate(time) / fitted.frequency
    away = abs(multiple - round(multiple)) * fitted.frequency * (time[-1] - time[0])
    return round(multiple) if away < FOOT and round(multiple) <= HALF_RATE else None


def alternates(modulation: Modulation) -> float | None:
    """Half of the relative difference of the amplitudes of every first and every second sample, or None."""
    gain, phase = np.abs(modulation.alternating).T
    counts = (gain > LEAST_GAIN) & (gain > ALTERNATING * phase)
    return float(gain.max()) if counts.all() and (gain > 8.0 * modulation.alternating_noise).any() else None


class Losses(NamedTuple):
    """Samples that seem to be lost between times that do not show it."""

    count: float
    upper_limit: float  # 95 % upper limit
    is_sure: bool  # whether no noise looks like it


def losses_of(time: np.ndarray, fitted: Fit, modulation: Modulation) -> Losses:
    """About how many samples are lost at random.

    Each loss turns the phase by 2π d, with d the drive's frequency in cycles per sample. If the share p of the samples
    is lost at random, the phase has the noise 2 p d²/ν² at the modulation frequency ν (cycles per sample), and the
    amplitude has none.
    """
    from scipy.special import chdtri

    count, drive = 2 * (len(time) // 2), fitted.frequency / sampling_rate(time)
    lowest = max(JUMPS[0] * drive, min(SLOW / count, SHORT * drive))
    highest = JUMPS[1] * drive
    band = (modulation.frequency >= lowest) & (modulation.frequency < highest)
    lines = np.count_nonzero(band)
    noise = modulation.frequency > ABOVE_JUMPS * drive
    phase, gain = (np.median(values[band] ** 2) for values in (modulation.phase, modulation.gain))
    floor = np.median(modulation.phase[noise] ** 2)
    # The square of an amplitude with a Hann window is 3/N times the power per frequency.
    share = (
        np.median(modulation.frequency[band] ** 2 * (modulation.phase[band] ** 2 - floor)) * count / (6.0 * drive**2)
    )
    ratio = phase / max(gain, floor)
    lost = float(share * count) if ratio > ONE_SIDED else 0.0
    is_sure = lines >= LEAST_LINES and ratio > ONE_SIDED * (1.0 + MANY_LINES / lines) and lost > LEAST_LOST
    # The median of the lines of a Hann window has about as many degrees of freedom as lines.
    return Losses(lost, lost * lines / float(chdtri(lines, 0.95)), bool(is_sure))


class Jump(NamedTuple):
    """The jump of the drive's phase or amplitude that explains most of a residual."""

    sample: int  # the first one after the jump
    size: float  # rad, or relative
    slope: float  # rad/s, or 1/s: largest one of a half of the recording
    evidence: float  # squared size over its variance; chi-squared with one degree of freedom if there is no jump
    is_alone: bool  # whether hardly any slow change remains without it

    def is_found(self, chance: float) -> bool:
        """Whether noise alone would look like it, anywhere in the recording, with less than this probability."""
        from scipy.special import chdtri

        return self.evidence > float(chdtri(1.0, chance / PLACES))

    @property
    def shift(self) -> float:
        """Largest difference of the frequency of a half of the recording from the fitted one (Hz), by the phase."""
        return self.slope / (2.0 * math.pi)


def errors_of(time: np.ndarray, fitted: Fit) -> np.ndarray:
    """Relative errors of the amplitude (real part) and errors of the phase (rad, imaginary part), shape (n,)."""
    weights = np.abs(fitted.amplitudes[:, :1]) ** 2
    fundamental = fitted.amplitudes[:, :1] * np.exp(2j * math.pi * fitted.frequency * (time - fitted.middle))
    return 2.0 * (fitted.residual * np.conj(fundamental)).sum(axis=0) / weights.sum()


def jump_of(time: np.ndarray, error: np.ndarray) -> Jump:
    """The jump that fits one part of the errors best.

    The fit of the frequency has taken a straight line out of the phase, and an amplitude may drift, so only what a line
    leaves of a step tells the size of a jump.
    """
    count, centred = len(time), time - time.mean()
    length = math.sqrt((centred**2).sum())
    error = error - error.mean() - (error @ centred) * centred / length**2
    # Sums over the samples after each place: their number, and the products of a step with the line and with the error.
    after, line, sums = (np.cumsum(part[::-1])[::-1][1:] for part in (np.ones(count), centred / length, error))
    energy = after * (1.0 - after / count) - line**2
    place = int(np.argmax(np.where(energy > EDGE * count, sums**2 / energy, 0.0)))
    size = float(sums[place] / energy[place])
    step = (np.arange(count) > place) - after[place] / count - line[place] * centred / length
    before, remainder = (np.abs(np.fft.rfft(signal)) ** 2 / count for signal in (error, error - size * step))
    noise = np.median(before[SLOW_LINES : SLOW_LINES + NEARBY]) / math.log(2.0)
    slow = slice(1, SLOW_LINES)
    halves = [slice(None, count // 2), slice(count // 2, None)]
    slopes = [np.polyfit(centred[half] - centred[half].mean(), error[half], 1)[0] for half in halves]
    return Jump(
        place + 1,
        size,
        float(np.abs(slopes).max()),
        float(sums[place] ** 2 / energy[place] / noise),
        bool(remainder[slow].sum() < ALONE * before[slow].sum()),
    )
