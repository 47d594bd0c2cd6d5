"""Accelerometer files of drives whose truth is known."""

from dataclasses import dataclass, field

import numpy as np
from scipy.signal import lfilter

from conveyor_pipeline.common import csv_table
from conveyor_pipeline.machine.excitation.faults import checked
from conveyor_pipeline.machine.excitation.reading import (
    EXAMPLE,
    HEADER_UNITS,
    STANDARD_GRAVITY,
    Recording,
    parse,
    wanted,
)


def table_of(text: str, settings: dict, path: str = "mine.csv") -> csv_table.Table:
    """The table in the text of a file."""
    return csv_table.parse(text, path, wanted(settings), HEADER_UNITS, EXAMPLE)


def read(text: str, settings: dict) -> Recording:
    """The recording in the text of a file, as it stands there."""
    return parse(table_of(text, settings), settings)


def check(text: str, settings: dict) -> Recording:
    """The recording in the text of a file, as the rules use it; an error if it has faults."""
    return checked(table_of(text, settings), settings)


@dataclass(frozen=True)
class Drive:
    """A drive in the conventions of the model, and the sensor that records it."""

    acceleration: float = 40.0  # m/s²
    frequency: float = 50.0  # Hz
    angle: float = 0.3  # rad
    phase_shift: float = 0.2  # rad
    harmonics: tuple = ()  # (order, along, along_phase, normal, normal_phase)
    psi0: float = 1.1  # rad
    cycles: float = 60.0
    rate: float = 2000.0  # samples per second
    noise: float = 0.3  # m/s², standard deviation
    colour: float = 0.0  # correlation of the noise from sample to sample
    bias: tuple = (0.01, -0.02)  # m/s², of the sensor's columns
    mount: float = 0.0  # rad
    inclination: float = 0.0  # rad, of the track
    jitter: float = 0.0  # of the sampling times, in units of the interval
    random: bool = False  # sampling times: uniformly random
    gap: tuple = (1.0, 1.0)  # begin and end of missing samples, in units of the recording
    quantum: float = 0.0  # m/s², step of the converter
    drift: float = 0.0  # relative change of the amplitude from begin to end
    limit: float = np.inf  # m/s², at which the sensor clips
    unit: str = "m/s²"
    also: dict = field(default_factory=dict)  # frequency (Hz): amplitude (m/s²) of further sines normal to the track

    def plate(self, time: np.ndarray) -> np.ndarray:
        """Acceleration along and normal to the track (m/s²), shape (2, n)."""
        theta = 2.0 * np.pi * self.frequency * time + self.psi0
        along, normal = np.cos(theta + self.phase_shift), np.cos(theta)
        for order, share_along, phase_along, share_normal, phase_normal in self.harmonics:
            along = along + share_along * np.cos(order * theta + phase_along)
            normal = normal + share_normal * np.cos(order * theta + phase_normal)
        steady = 1.0 + self.drift * (time / time[-1] - 0.5)
        both = steady * self.acceleration * np.array([np.cos(self.angle) * along, np.sin(self.angle) * normal])
        for frequency, amplitude in self.also.items():
            both[1] += amplitude * np.sin(2.0 * np.pi * frequency * time)
        return both

    @property
    def offsets(self) -> tuple[float, float]:
        """Means of the sensor's columns (m/s²): gravity and bias."""
        upwards = self.mount + self.inclination
        return (
            STANDARD_GRAVITY * np.sin(upwards) + self.bias[0],
            STANDARD_GRAVITY * np.cos(upwards) + self.bias[1],
        )

    def record(self, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Times (s) and readings (m/s²) of the columns along, normal, or, with a mount, x, z."""
        random = np.random.default_rng(seed)
        count = round(self.cycles / self.frequency * self.rate)
        time = np.cumsum(1.0 + self.jitter * random.uniform(-1.0, 1.0, count)) / self.rate
        if self.random:
            time = np.sort(random.uniform(0.0, count / self.rate, count))
        along, normal = self.plate(time)
        cosine, sine = np.cos(self.mount), np.sin(self.mount)
        readings = np.array([along * cosine + normal * sine, -along * sine + normal * cosine])
        readings = readings + np.array(self.offsets)[:, None]
        noise = random.standard_normal((2, count))
        noise[:, 1:] *= np.sqrt(1.0 - self.colour**2)
        noise = lfilter([1.0], [1.0, -self.colour], noise)
        readings = readings + self.noise * noise
        if self.quantum:
            readings = self.quantum * np.round(readings / self.quantum)
        begin, end = self.gap
        kept = (time < begin * time[-1]) | (time >= end * time[-1])
        return time[kept], np.clip(readings, -self.limit, self.limit)[:, kept]

    def text(self, seed: int = 0) -> str:
        """The file."""
        time, readings = self.record(seed)
        names = ("x", "z") if self.mount else ("along", "normal")
        scale = STANDARD_GRAVITY if self.unit == "g" else 1.0
        rows = [f"{t:.9g},{a:.8g},{b:.8g}" for t, (a, b) in zip(time, readings.T / scale, strict=True)]
        return "\n".join([f"time,{names[0]},{names[1]}", *rows, ""])

    @property
    def settings(self) -> dict:
        return {"unit": self.unit, "mount": self.mount, "inclination": self.inclination}

    def truth(self) -> dict[str, float]:
        """The parameters of the drive and the harmonics, by name and by name and order."""
        values = {name: getattr(self, name) for name in ("acceleration", "frequency", "angle", "phase_shift")}
        for order, *shares in self.harmonics:
            names = ("along", "along_phase", "normal", "normal_phase")
            values |= {f"{name}_{order}": value for name, value in zip(names, shares, strict=True)}
        return values
