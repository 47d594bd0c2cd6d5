"""Amplitude spectra in the unit of the signal: one-sided, with the constant part at frequency zero."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import LONGEST, check_number, check_series

SHORTEST = 1e-12  # s, of a signal


class AmplitudeSpectrum(NamedTuple):
    """One-sided amplitude spectrum; a cosine of amplitude A within a constant A_0 gives a line A at its frequency.

    Attributes
    ----------
    frequency : Hz, k / duration, float64, shape (n // 2 + 1,)
    amplitude : unit of the signal, same shape; entry 0 is the modulus of the mean value
    """

    frequency: np.ndarray
    amplitude: np.ndarray


def harmonic_spectrum(samples: ArrayLike, duration: float) -> AmplitudeSpectrum:
    """Spectrum of a settled orbit from n equidistant samples over whole periods, t = 0, T/n, … (T = `duration`, s).

    No window and no leakage: every harmonic and subharmonic below n / (2T) falls on a bin. ValueError if the samples
    are fewer than two, of another shape than (n,), or not finite.

    Examples
    --------
    >>> times = np.arange(64) / 64.0 * 0.02  # s, one cycle of 50 Hz
    >>> spectrum = harmonic_spectrum(3.0 + 2.0 * np.cos(2.0 * np.pi * 100.0 * times), 0.02)
    >>> spectrum.amplitude[:4].round(9).tolist()  # at 0, 50, 100 and 150 Hz
    [3.0, 0.0, 2.0, 0.0]
    """
    samples = check_series("samples", samples, least=2)
    return one_sided(samples, duration, len(samples))


def windowed_spectrum(samples: ArrayLike, duration: float) -> AmplitudeSpectrum:
    """Spectrum of any other motion from n equidistant samples over `duration` (s), with a Hann window.

    Amplitudes are divided by the window's mean, so that a line on a bin has its true height; one half-way between
    two bins is lower by the factor 8/(3π), 15 %. The mean value is taken out before the window is applied. ValueError
    as for `harmonic_spectrum`.

    Examples
    --------
    >>> times = np.arange(256) / 256.0  # s
    >>> spectrum = windowed_spectrum(3.0 + 2.0 * np.cos(2.0 * np.pi * 5.0 * times), 1.0)
    >>> round(float(spectrum.amplitude[0]), 6), round(float(spectrum.amplitude[5]), 6)  # the mean, and 5 Hz
    (3.0, 2.0)
    """
    samples = check_series("samples", samples, least=2)
    # As scipy.signal.windows.hann, whose import takes a second.
    window = 0.5 + 0.5 * np.cos(np.linspace(-np.pi, np.pi, len(samples) + 1))[:-1]
    mean = np.sum(window * samples) / window.sum()
    spectrum = one_sided((samples - mean) * window, duration, window.sum())
    spectrum.amplitude[0] = abs(mean)
    return spectrum


def one_sided(samples: np.ndarray, duration: float, gain: float) -> AmplitudeSpectrum:
    """Amplitudes |Σ samples e^(-iωt)| / gain, doubled where a line shares its height with a negative frequency."""
    n, duration = len(samples), check_number("duration", duration, SHORTEST, LONGEST, "s")
    amplitude = np.abs(np.fft.rfft(samples)) / gain
    amplitude[1 : (n + 1) // 2] *= 2.0
    return AmplitudeSpectrum(np.arange(len(amplitude)) / duration, amplitude)
