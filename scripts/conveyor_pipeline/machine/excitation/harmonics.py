"""A periodic signal in noise: its frequency by least squares, and its harmonics as complex amplitudes.

Both axes of a recording are the sum of an offset, a linear drift of the offset, and harmonics with one frequency:
a_j(t) = o_j + d_j t + Re Σ_k Z_jk exp(i k ω t), with t from the middle of the recording. For a given frequency, the
rest is linear, so only the frequency is searched (variable projection, Golub and Pereyra 1973). Nothing here needs
even sampling, except for the first estimate of the frequency, which interpolates.

The config check uses this module, too; SciPy's optimisers are imported when they are needed.
"""

import math
from typing import NamedTuple

import numpy as np

MOST_ORDER = 20  # harmonics of higher orders move the plate by less than 1/400 of their share of the acceleration
HIGHEST = 0.49  # frequency up to which harmonics are fitted, in units of the sampling rate: below 1/2
PADDING = 4  # the first estimate of the frequency is on a grid of 1/4 of the resolution 1/T
BLOCK = 2**16  # samples whose design matrix is in memory at a time
GAP = 6.0  # mean intervals between two samples from which on they have a gap between them
LEAST_CYCLES = 1.5  # of the lowest frequency that is a vibration and no drift
PIECE = 4  # cycles, at least, of a piece of the recording whose amplitude is measured
MOST_PIECES = 50
# Pieces for a straight line through them, and standard errors of its slope from which it is no noise.
LEAST_PIECES, CLEAR_DRIFT = 8, 8.0
CHECKED_ORDERS = 8  # of a first fit
PHASES = 64  # in a cycle that count as different; a drive that is nearly locked to the sampling drifts by less
# A further line counts from this share of the fundamental of its axis, if its power is this multiple of the noise's
# median power nearby, and if it is this far from all multiples of the fundamental; the last two in units of 1/T.
SHARE, OUT_OF_NOISE, NEARBY, FOOT = 0.05, 40.0, 20, 2.0
MOST_SUBHARMONIC = 4  # the fundamental may be weaker than its harmonics up to this order
SEARCHED = 0.6  # half width of the searched frequencies around it, in units of 1/T: less than to the next minimum


class Fit(NamedTuple):
    """Harmonics of both axes with one frequency."""

    frequency: float  # Hz
    middle: float  # s, the time at which the phases are stated
    amplitudes: np.ndarray  # m/s², complex, Z_jk of axis j and order k = 1, 2, …, shape (2, K)
    offsets: np.ndarray  # m/s², shape (2,)
    residual: np.ndarray  # m/s², shape (2, n)

    @property
    def orders(self) -> int:
        return self.amplitudes.shape[1]


def gaps_of(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The intervals between samples (s), and which of them are gaps."""
    intervals = np.diff(time)
    return intervals, intervals > GAP * intervals.mean()


def sampling_rate(time: np.ndarray) -> float:
    """Mean number of samples per second, outside gaps."""
    intervals, is_gap = gaps_of(time)
    return 1.0 / float(intervals[~is_gap].mean())


def duration_of(time: np.ndarray) -> float:
    """Duration of a recording (s), with its gaps and the interval that its last sample stands for."""
    return time[-1] - time[0] + 1.0 / sampling_rate(time)


def orders_of(rate: float, frequency: float) -> int:
    """Highest order whose frequency the sampling resolves."""
    return max(1, min(MOST_ORDER, math.floor(HIGHEST * rate / frequency)))


def design_of(time: np.ndarray, half: float, frequency: float, orders: int) -> np.ndarray:
    """The columns of the linear least squares as rows: offset, drift, cosines and sines, shape (2 + 2 K, n).

    time, half : times from the middle of the recording, and half of its duration, s
    """
    design = np.empty((2 + 2 * orders, len(time)))
    first = np.exp(2j * math.pi * frequency * time)
    cosines, sines = design[2 : 2 + orders], design[2 + orders :]
    design[0], design[1], cosines[0], sines[0] = 1.0, time / half, first.real, first.imag
    for k in range(1, orders):
        cosines[k] = cosines[k - 1] * cosines[0] - sines[k - 1] * sines[0]
        sines[k] = cosines[k - 1] * sines[0] + sines[k - 1] * cosines[0]
    return design


def project(
    time: np.ndarray, signals: np.ndarray, frequency: float, orders: int, slopes: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of the linear least squares, shape (2 + 2 K, 2), and the residual, shape (2, n).

    The rows of the design are nearly orthogonal, so the normal equations lose no digits. With `slopes`, the derivative
    of the harmonics with respect to the frequency (m/s²/Hz) takes the place of the residual.
    """
    parts = [slice(begin, begin + BLOCK) for begin in range(0, len(time), BLOCK)]
    size = 2 + 2 * orders
    gram, products = np.zeros((size, size)), np.zeros((size, len(signals)))
    remainder = np.empty_like(signals)
    for part in parts:
        design = design_of(time[part], time[-1], frequency, orders)
        gram += design @ design.T
        products += design @ signals[:, part].T
    try:
        values = np.linalg.solve(gram, products)
    except np.linalg.LinAlgError:  # fewer samples than columns of the design, which the checks refuse
        values = np.linalg.lstsq(gram, products, rcond=None)[0]
    angular_orders = 2.0 * math.pi * np.arange(1, orders + 1)[:, None]
    cosines, sines = values[2 : 2 + orders], values[2 + orders :]
    turned = np.vstack([angular_orders * sines, -angular_orders * cosines])  # of the cosines and of the sines
    for part in parts:
        if len(parts) > 1:  # a single part still has its design
            design = design_of(time[part], time[-1], frequency, orders)
        if slopes:
            remainder[:, part] = time[part] * (turned.T @ design[2:])
        else:
            remainder[:, part] = signals[:, part] - values.T @ design
    return values, remainder


def spectrum(time: np.ndarray, signals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz), shape (m,), and amplitudes of sines at these frequencies, shape (2, m), with a Hann window.

    Uneven samples are interpolated, and gaps are left out, which only spectra for the eye and first estimates may do.
    """
    count = round((time[-1] - time[0]) * sampling_rate(time)) + 1
    is_gap = gaps_of(time)[1]
    even, spacing = np.linspace(time[0], time[-1], count, retstep=True)
    window = np.hanning(count) * ~is_gap[np.clip(np.searchsorted(time, even) - 1, 0, len(is_gap) - 1)]
    length = PADDING * 2 ** math.ceil(math.log2(count))
    values = np.array([np.interp(even, time, signal - signal.mean()) for signal in signals])
    frequencies = np.fft.rfftfreq(length, spacing)
    return frequencies, 2.0 / window.sum() * np.abs(np.fft.rfft(window * values, length))


def strongest(time: np.ndarray, signals: np.ndarray) -> tuple[float, float]:
    """Frequency (Hz) and amplitude (m/s²) of the strongest line of both axes together."""
    frequencies, amplitudes = spectrum(time, signals)
    lowest = LEAST_CYCLES / duration_of(time)
    power = np.where(frequencies >= lowest, (amplitudes**2).sum(axis=0), 0.0)
    place = int(np.argmax(power))
    return float(frequencies[place]), math.sqrt(power[place])


def fit(time: np.ndarray, signals: np.ndarray, guess: float, orders: int) -> Fit:
    """The frequency near a first estimate (Hz), and the harmonics; `signals` has the shape (2, n)."""
    from scipy.optimize import least_squares

    resolution = 1.0 / duration_of(time)
    middle = 0.5 * (time[0] + time[-1])
    centred = time - middle

    def residual(shift: np.ndarray) -> np.ndarray:
        return project(centred, signals, guess + shift[0] * resolution, orders)[1].ravel()

    def jacobian(shift: np.ndarray) -> np.ndarray:
        """The derivative without what the linear coefficients compensate (Kaufman 1975)."""
        frequency = guess + shift[0] * resolution
        slope = project(centred, signals, frequency, orders, slopes=True)[1]
        return -resolution * project(centred, slope, frequency, orders)[1].reshape(-1, 1)

    options = {"xtol": 1e-10, "ftol": 1e-12, "gtol": None, "max_nfev": 12}
    minimum = least_squares(residual, [0.0], jacobian, bounds=(-SEARCHED, SEARCHED), **options)
    frequency = guess + float(minimum.x[0]) * resolution
    values, remainder = project(centred, signals, frequency, orders)
    amplitudes = (values[2 : 2 + orders] - 1j * values[2 + orders :]).T
    return Fit(frequency, middle, amplitudes, values[0], remainder)


class Pieces(NamedTuple):
    """Pieces of a recording, each with its own fundamental."""

    middles: np.ndarray  # s, from the middle of the recording, shape (n,)
    sizes: np.ndarray  # samples, shape (n,)
    errors: np.ndarray  # complex relative errors of the fundamental: amplitude, and phase in rad, shape (2, n)


def pieces_of(time: np.ndarray, fitted: Fit) -> Pieces:
    """The fundamental of each axis in pieces of at least PIECE cycles, relative to that of the whole recording."""
    cycles = fitted.frequency * duration_of(time)
    count = max(2, min(MOST_PIECES, math.floor(cycles / PIECE)))
    centred = time - fitted.middle
    begins = np.linspace(0, len(time), count, endpoint=False).astype(np.int64)  # a gap leaves no piece empty
    sizes = np.diff([*begins, len(time)])
    waves = np.exp(-2j * math.pi * fitted.frequency * centred)
    errors = 2.0 * np.add.reduceat(fitted.residual * waves, begins, axis=1) / sizes / fitted.amplitudes[:, :1]
    return Pieces(np.add.reduceat(centred, begins) / sizes, sizes, errors)


def steadiness(time: np.ndarray, fitted: Fit) -> dict[str, float]:
    """How amplitude and phase of the fundamental change from piece to piece of the recording."""
    middles, sizes, errors = pieces_of(time, fitted)
    weights = np.abs(fitted.amplitudes[:, 0]) ** 2
    whole = weights @ errors / weights.sum()
    amplitude = whole.real
    noise = (fitted.residual**2).mean(axis=1) * 2.0 / sizes.mean()
    duration = time[-1] - time[0]
    return {
        "pieces": len(sizes),
        "deviation": float(amplitude.std(ddof=1)),
        "wander": float(np.angle(1.0 + whole).std(ddof=1)),
        "deviation_of_noise": math.sqrt(float(weights @ noise)) / float(weights.sum()),
        "drift": float(np.polyfit(middles, amplitude, 1)[0] * duration),
    }


def drift_between_axes(time: np.ndarray, fitted: Fit) -> float:
    """The change (rad) of the phase between both axes from begin to end, by a straight line; 0 if it may be noise.

    A common wander of both phases does not count.
    """
    middles, sizes, errors = pieces_of(time, fitted)
    if len(sizes) < LEAST_PIECES:
        return 0.0
    along, normal = np.angle(1.0 + errors)
    (slope, _), covariance = np.polyfit(middles, along - normal, 1, cov=True)
    is_clear = abs(slope) > CLEAR_DRIFT * math.sqrt(covariance[0, 0])
    return float(slope * (time[-1] - time[0])) if is_clear else 0.0


def further_line(time: np.ndarray, fitted: Fit) -> tuple[float, float] | None:
    """Frequency (Hz) and amplitude (m/s²) of the strongest line that is no multiple of the fundamental, or None."""
    from scipy.ndimage import median_filter

    frequencies, amplitudes = spectrum(time, fitted.residual)
    resolution = 1.0 / duration_of(time)
    multiple = np.round(frequencies / fitted.frequency)
    # Where an amplitude drifts, its line has a foot.
    is_harmonic = (np.abs(frequencies - multiple * fitted.frequency) < FOOT * resolution) & (multiple > 0.0)
    searched = ~is_harmonic & (frequencies > max(fitted.frequency / (MOST_SUBHARMONIC + 0.5), 3.0 * resolution))
    if not searched.any():
        return None
    # Coloured noise is strong only near some frequencies, so its median nearby counts.
    # Axis by axis, because SciPy filters a single dimension twenty times as fast.
    noise = np.array([median_filter(channel, NEARBY * PADDING, mode="nearest") for channel in amplitudes])
    shares = amplitudes / np.abs(fitted.amplitudes[:, :1])
    counts = searched & (amplitudes**2 > OUT_OF_NOISE * noise**2) & (shares > SHARE)
    axis, place = np.unravel_index(np.argmax(np.where(counts, shares, 0.0)), shares.shape)
    return (float(frequencies[place]), float(amplitudes[axis, place])) if counts[axis, place] else None


def phases_of(time: np.ndarray, fitted: Fit) -> int:
    """The number of different phases of the drive at which samples were taken, up to PHASES."""
    return len(np.unique(np.round(PHASES * (time - fitted.middle) * fitted.frequency) % PHASES))


def first_fit(time: np.ndarray, signals: np.ndarray, stated: float | None = None) -> tuple[Fit, tuple | None]:
    """The harmonics, and a line that is no multiple of their frequency, or None.

    stated : frequency of the drive (Hz), if it is known; it decides whether a weaker line is the fundamental
    """
    rate = sampling_rate(time)

    def fitted(guess: float) -> Fit:
        return fit(time, signals, guess, min(CHECKED_ORDERS, orders_of(rate, guess)))

    model = fitted(strongest(time, signals)[0])
    extra_line = further_line(time, model)
    # The strongest line may be a harmonic of a weaker fundamental.
    for order in range(2, MOST_SUBHARMONIC + 1) if extra_line else ():
        is_stated = stated and stated > model.frequency / math.sqrt(order)
        if abs(order * extra_line[0] - model.frequency) < 1.0 / duration_of(time) and not is_stated:
            model = fitted(model.frequency / order)
            return model, further_line(time, model)
    return model, extra_line
