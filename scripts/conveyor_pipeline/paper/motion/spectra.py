"""Amplitude spectra of a part's velocities at the end of a run."""

import numpy as np

from conveyor import AmplitudeSpectrum, Run, harmonic_spectrum, windowed_spectrum
from conveyor_pipeline.common import fields
from conveyor_pipeline.paper.motion.simulated_entries import simulate_entry

TABLES = {
    "spectra": (
        fields.text("signal", "velocity of the part: vx or vz"),
        fields.number("frequency", "Hz", "frequency"),
        fields.number("amplitude", "m/s", "one-sided amplitude; at frequency 0 the modulus of the mean value"),
    ),
}

SIGNALS = ("vx", "vz")
# Share of the run that is transformed if the motion has no period, and samples per excitation cycle.
LAST, SAMPLES_PER_CYCLE = 0.25, 1024


def spectra_of_end(run: Run, period: int) -> dict[str, AmplitudeSpectrum]:
    """Spectra of the velocities over the last period of a run, or over its last part if there is no period.

    period : excitation cycles; 0 for none
    """
    duration = period / run.conveyor.frequency if period else LAST * run.duration
    count = round(SAMPLES_PER_CYCLE * run.conveyor.frequency * duration)
    motion = run.sample(run.duration - duration + np.arange(count) * duration / count)
    return {name: (harmonic_spectrum if period else windowed_spectrum)(motion[name], duration) for name in SIGNALS}


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of spectra for the resolved `settings` of an entry of the config."""
    axes, runs, states = simulate_entry(settings, threads)
    spectra = [
        (row, name, spectrum)
        for row, (run, period) in enumerate(zip(runs, states.period, strict=True))
        for name, spectrum in spectra_of_end(run, period).items()
    ]
    lengths = [len(spectrum.frequency) for _, _, spectrum in spectra]
    rows = np.repeat([row for row, _, _ in spectra], lengths)
    return {name: values[rows] for name, values in axes.items()} | {
        "signal": np.repeat([name for _, name, _ in spectra], lengths),
        "frequency": np.concatenate([spectrum.frequency for _, _, spectrum in spectra]),
        "amplitude": np.concatenate([spectrum.amplitude for _, _, spectrum in spectra]),
    }
