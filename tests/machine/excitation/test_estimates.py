"""Estimates of drives whose truth is known: intervals contain the true values, and conventions are the model's."""

from collections import defaultdict
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from accelerometer import Drive, read

from conveyor_pipeline.machine.excitation.estimates import SHARES, harmonics, noise_of, parameters
from conveyor_pipeline.machine.excitation.gravity import wrap
from conveyor_pipeline.machine.excitation.harmonics import fit, orders_of, sampling_rate, strongest

HARMONICS = ((2, 0.05, 0.7, 0.08, -2.5), (3, 0.02, 3.0, 0.03, 1.0), (5, 0.01, -1.0, 0.0, 0.0))


def estimate(drive: Drive, seed: int = 0) -> tuple[dict, dict]:
    """Values and standard errors by name, and the columns of the harmonics."""
    recording = read(drive.text(seed), drive.settings)
    time, signals = recording.time, recording.acceleration
    guess = strongest(time, signals)[0]
    found = fit(time, signals, guess, orders_of(sampling_rate(time), guess))
    noise = noise_of(recording, found)
    values, columns = dict(parameters(recording, found, noise)), harmonics(found, noise)
    for place, order in enumerate(columns["order"]):
        for name in SHARES:
            values[f"{name}_{order}"] = columns[name][place], columns[f"{name}_stderr"][place]
    return values, columns


def random_drive(random: np.random.Generator, kind: str) -> Drive:
    """A drive with up to four harmonics; the kind names what makes it difficult."""
    amplitude, frequency = random.uniform(5.0, 100.0), random.uniform(20.0, 120.0)
    shares, phases = 10.0 ** random.uniform(-3.0, -0.7, (2, 6)), random.uniform(-3.1, 3.1, (2, 6))
    drive = Drive(
        acceleration=amplitude,
        frequency=frequency,
        angle=random.uniform(0.1, 1.2),
        phase_shift=random.uniform(-3.0, 3.0),
        harmonics=tuple(
            (order, shares[0, order], phases[0, order], shares[1, order], phases[1, order])
            for order in range(2, random.integers(2, 6))
        ),
        psi0=random.uniform(0.0, 6.2),
        cycles=random.uniform(20.0, 60.0),
        rate=frequency * random.uniform(14.0, 30.0),
        noise=amplitude * 10.0 ** random.uniform(-3.0, -1.0),
        mount=random.uniform(-0.5, 0.5),
        unit=str(random.choice(["g", "m/s²"])),
    )
    steps = {"quantum": amplitude / 50.0, "noise": 1e-3 * amplitude}
    changes = {
        "plain": {},
        "short": {"cycles": random.uniform(8.0, 10.0)},
        "colour": {"colour": 0.9},
        "jitter": {"jitter": 0.9},
        "random times": {"random": True},
        "gap": {"gap": (0.3, 0.55)},
        "steps": steps,
        "same phases": {**steps, "rate": 24.0 * frequency},
        "drift": {"drift": 0.05},
    }
    return replace(drive, **changes[kind])


KINDS = ("plain", "short", "colour", "jitter", "random times", "gap", "steps", "same phases", "drift")


@cache
def estimated(kind: str) -> list[tuple[Drive, dict]]:
    """Twelve random drives with their estimates."""
    random = np.random.default_rng(17)
    drives = [random_drive(random, kind) for _ in range(12)]
    return [(drive, estimate(drive, seed)[0]) for seed, drive in enumerate(drives)]


@pytest.mark.parametrize("kind", KINDS)
def test_intervals_contain_the_true_values(kind):
    inside = defaultdict(list)
    for drive, found in estimated(kind):
        for name, value in drive.truth().items():
            error = found[name][0] - value
            error = wrap(error) if "phase" in name else error
            inside[name.rstrip("_0123456789")].append(abs(error) <= 1.96 * found[name][1])
    assert np.mean([one for each in inside.values() for one in each]) >= 0.9
    assert all(np.mean(each) >= 0.6 for each in inside.values()), {name: np.mean(each) for name, each in inside.items()}


@pytest.mark.parametrize("kind", ["plain", "short", "colour"])
def test_intervals_are_not_too_wide(kind):
    """The mean square of the errors over the standard errors would be 1 for perfect ones."""
    scaled = []
    for drive, found in estimated(kind):
        truth = {name: value for name, value in drive.truth().items() if "_" not in name}
        scaled += [((found[name][0] - value) / found[name][1]) ** 2 for name, value in truth.items()]
    assert 0.4 < np.mean(scaled) < 1.6


def test_noise_near_a_harmonic_is_the_error_of_this_harmonic():
    """A slow beat of the second harmonic, which the fit leaves in its residual."""
    drive = Drive(harmonics=HARMONICS, noise=0.0)
    recording = read(drive.text(0), drive.settings)
    found = fit(recording.time, recording.acceleration, drive.frequency, 3)
    time = recording.time - found.middle
    beat = 0.01 * np.cos(4.0 * np.pi * found.frequency * time) * np.cos(6.0 * np.pi * time / np.ptp(time))
    noise = noise_of(recording, found._replace(residual=np.stack([beat, beat])))
    first, second, third = (
        np.abs(noise.amplitude[0, order]).max() * abs(found.amplitudes[0, order]) for order in range(3)
    )
    assert max(first, third) < 0.1 * second


@pytest.mark.parametrize("kind", ["plain", "short", "colour", "steps", "same phases"])
def test_noise_makes_no_harmonics(kind):
    random = np.random.default_rng(29)
    for seed in range(10):
        drive = replace(random_drive(random, kind), harmonics=())
        assert not estimate(drive, seed)[1]["above_noise"].any()


@pytest.mark.parametrize("distance", [0.7, 1.5, 3.0])
def test_a_line_beside_an_order_is_no_harmonic(distance):
    """Its distance in units of 1/T; the fit of the harmonic takes a part of it."""
    for order in (2, 3):
        drive = Drive(noise=0.1, cycles=100.0)
        frequency = (order + distance / drive.cycles) * drive.frequency
        _, columns = estimate(replace(drive, also={frequency: 0.3}))
        assert not columns["above_noise"].any()


@pytest.mark.parametrize("order", [2, 3])
def test_a_harmonic_of_one_per_cent_is_found_in_noise_of_a_fifth(order):
    for seed in range(5):
        drive = Drive(
            harmonics=((order, 0.01, 0.4, 0.01, -2.0),), noise=0.002 * 40.0 * np.sin(0.3), cycles=30.0, rate=800.0
        )
        columns = estimate(drive, seed)[1]
        assert list(columns["order"][columns["along_above_noise"] & columns["normal_above_noise"]]) == [order]


def test_harmonics_above_the_noise_are_named_by_axis():
    _, columns = estimate(replace(Drive(), harmonics=HARMONICS, cycles=200.0, noise=0.1))
    assert list(columns["order"][columns["along_above_noise"]]) == [2, 3, 5]
    assert list(columns["order"][columns["normal_above_noise"]]) == [2, 3]


@pytest.mark.parametrize("phase_shift", [-3.1, -0.4, 0.0, 2.0, 3.1])
@pytest.mark.parametrize("mount", [0.0, -0.6])
def test_without_noise_estimates_are_exact(phase_shift, mount):
    drive = Drive(harmonics=HARMONICS, phase_shift=phase_shift, mount=mount, noise=0.0, unit="g", psi0=4.0)
    found, columns = estimate(drive)
    for name, value in drive.truth().items():
        if name != "normal_phase_5":  # of a share of zero
            error = found[name][0] - value
            assert abs(wrap(error) if "phase" in name else error) < 2e-5, name
    assert (np.abs(columns["normal_phase"]) <= np.pi).all() and (columns["along"] >= 0.0).all()


def test_standard_errors_of_white_noise_are_the_bounds_of_theory():
    """Cramér and Rao: 2 σ²/N for an amplitude, 6 σ²/(π² A² N T²) for a frequency (Rife and Boorstyn 1974)."""
    drive = Drive(cycles=400.0, rate=800.0, noise=0.5)
    count, duration = 6400, 8.0
    errors = np.mean([[found[1] for found in estimate(drive, seed)[0].values()][:4] for seed in range(6)], axis=0)
    amplitude = drive.noise * np.sqrt(2.0 / count)
    assert errors[0] == pytest.approx(amplitude, rel=0.15)
    assert errors[1] == pytest.approx(np.sqrt(3.0) * amplitude / (np.pi * drive.acceleration * duration), rel=0.15)
    assert errors[2] == pytest.approx(amplitude / drive.acceleration, rel=0.15)
    sizes = drive.acceleration * np.array([np.cos(drive.angle), np.sin(drive.angle)])
    assert errors[3] == pytest.approx(amplitude * np.hypot(*(1.0 / sizes)), rel=0.15)
