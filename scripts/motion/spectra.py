"""Amplitude spectra of a part's velocities at the end of its run."""

import numpy as np

from conveyor.analysis.amplitude_spectrum import Spectrum, harmonics, windowed
from conveyor.simulation import Run, simulate
from conveyor.solver.model import unpack
from pipeline import fields, grid
from pipeline.motions import motions_after

TABLES = {
    "spectra": (
        fields.text("signal", "velocity of the part: vx or vz"),
        fields.number("frequency", "Hz", "frequency"),
        fields.number("amplitude", "m/s", "one-sided amplitude; at frequency 0 the modulus of the mean value"),
    ),
}

SIGNALS = ("vx", "vz")


def spectra_of_end(run: Run, period: int, last: float, samples_per_cycle: int) -> dict[str, Spectrum]:
    """Spectra of the velocities over the last period of a run, or over its last share if it has no period.

    Parameters
    ----------
    run : as from simulate
    period : of the motion it leads to, in excitation cycles; 0 for none
    last : share of the run, for motions without a period
    samples_per_cycle : samples in an excitation cycle
    """
    duration = period / run.conveyor.frequency if period else last * run.duration
    count = round(samples_per_cycle * run.conveyor.frequency * duration)
    motion = run.sample(run.duration - duration + np.arange(count) * duration / count)
    return {name: (harmonics if period else windowed)(motion[name], duration) for name in SIGNALS}


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of spectra for the resolved `settings` of an entry of the config."""
    options = {name: settings[name] for name in ("duration", "method", "tolerance", "step") if name in settings}
    axes, parameters = grid.product(settings["axes"], settings["model"])
    runs = [simulate(*unpack(row), **options) for row in parameters]
    ends = np.array([(run.z_end, run.vz_end) for run in runs]).T
    periods = motions_after(parameters, *ends, settings, threads=threads).period
    spectra = [
        spectra_of_end(run, period, settings["last"], settings["samples_per_cycle"])
        for run, period in zip(runs, periods, strict=True)
    ]
    lines = [(row, name, one) for row, of_run in enumerate(spectra) for name, one in of_run.items()]
    lengths = [len(one.frequency) for _, _, one in lines]
    rows = np.repeat([row for row, _, _ in lines], lengths)
    return {name: values[rows] for name, values in axes.items()} | {
        "signal": np.repeat([name for _, name, _ in lines], lengths),
        "frequency": np.concatenate([one.frequency for _, _, one in lines]),
        "amplitude": np.concatenate([one.amplitude for _, _, one in lines]),
    }
