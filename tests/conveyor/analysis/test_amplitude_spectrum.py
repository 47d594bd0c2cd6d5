"""Spectra of sums of cosines with known lines."""

import numpy as np
import pytest

from conveyor.analysis.amplitude_spectrum import harmonic_spectrum, windowed_spectrum

LINES = {0.0: 0.06, 50.0: 0.3, 100.0: 0.02, 275.0: 0.005}  # Hz: m/s


def signal(times, lines=LINES):
    return sum(a * np.cos(2 * np.pi * f * times + f) for f, a in lines.items())


@pytest.mark.parametrize("n", [400, 401])
def test_harmonics_are_exact_and_do_not_leak(n):
    duration = 0.04
    spectrum = harmonic_spectrum(signal(np.arange(n) * duration / n), duration)
    expected = np.zeros_like(spectrum.frequency)
    for frequency, amplitude in LINES.items():
        expected[round(frequency * duration)] = amplitude
    assert spectrum.frequency == pytest.approx(np.arange(n // 2 + 1) / duration)
    assert spectrum.amplitude == pytest.approx(expected, abs=1e-14)


def test_highest_frequency_is_not_doubled():
    spectrum = harmonic_spectrum(0.7 * np.cos(np.pi * np.arange(10)), 1.0)
    assert spectrum.amplitude[-1] == pytest.approx(0.7)


def test_all_lines_of_an_odd_number_of_samples_are_doubled():
    found = harmonic_spectrum(0.5 + 3.0 * np.cos(2.0 * np.pi * 4.0 * np.arange(9) / 9.0), 1.0)
    np.testing.assert_allclose(found.amplitude, [0.5, 0.0, 0.0, 0.0, 3.0], atol=1e-14)


def test_window_keeps_amplitudes_of_lines_on_bins():
    duration, n = 1.0, 4000
    spectrum = windowed_spectrum(signal(np.arange(n) * duration / n), duration)
    for frequency, amplitude in LINES.items():
        assert spectrum.amplitude[round(frequency * duration)] == pytest.approx(amplitude, rel=1e-9)


@pytest.mark.parametrize("offset", [0.1, 0.25, 0.5])
def test_window_lowers_lines_between_bins_by_its_transform(offset):
    n = 4000
    samples = 2.0 + 0.3 * np.cos(2 * np.pi * (50.0 + offset) * np.arange(n) / n)
    spectrum = windowed_spectrum(samples, 1.0)
    assert spectrum.amplitude[1:].max() == pytest.approx(0.3 * np.sinc(offset) / (1.0 - offset**2), rel=1e-5)
    assert spectrum.amplitude[0] == pytest.approx(2.0, abs=1e-3)
