"""Tables, overlay and page of a measured drive, from files whose truth is known."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import yaml
from accelerometer import Drive
from project import ROOT

from conveyor_pipeline.common import tables
from conveyor_pipeline.machine.excitation import measure, overlay, page
from conveyor_pipeline.machine.excitation.comparison import NO, PERHAPS, WITH, WITHOUT, YES, change, verdict

DRIVE = Drive(harmonics=((2, 0.05, 0.7, 0.08, -2.5), (3, 0.02, 3.0, 0.0, 0.0)), cycles=200.0, noise=0.1)


TEMPLATE = (ROOT / "workflow/rules/machine/excitation.md").read_text()


def tables_of(drive: Drive) -> dict[str, pd.DataFrame]:
    """The tables as the rule writes them."""
    settings = {"measured": "mine.csv", **drive.settings}
    made = measure.make(drive.text(), settings)
    found = {}
    for name, columns in made.items():
        found[name] = tables.make(name, measure.TABLES[name], columns, settings).to_pandas()
        found[name].attrs = settings
    return found


@pytest.fixture(scope="module")
def made() -> dict[str, pd.DataFrame]:
    return tables_of(DRIVE)


def test_the_waveform_is_the_plates_acceleration(made):
    waveform = made["waveform"]
    time = (2.0 * np.pi * waveform.cycle - DRIVE.psi0) / (2.0 * np.pi * DRIVE.frequency)
    along, normal = DRIVE.plate(time.to_numpy())
    np.testing.assert_allclose(waveform.along, along, atol=0.03)
    np.testing.assert_allclose(waveform.normal, normal, atol=0.03)


@pytest.mark.parametrize("ending", ["", "_fundamental"])
def test_the_second_derivative_of_the_displacement_is_the_acceleration(made, ending):
    waveform = made["waveform"]
    step = waveform.cycle[1] / DRIVE.frequency
    for axis in measure.AXES:
        position = waveform[f"{axis}_displacement{ending}"].to_numpy()
        found = (position[2:] - 2.0 * position[1:-1] + position[:-2]) / step**2
        np.testing.assert_allclose(found, waveform[f"{axis}{ending}"][1:-1], atol=0.05)
        assert abs(position[:-1].mean()) < 1e-9


def test_samples_lie_on_the_waveform(made):
    samples, waveform = made["samples"], made["waveform"]
    for axis in measure.AXES:
        rest = samples[axis] - np.interp(samples.cycle, waveform.cycle, waveform[axis])
        assert rest.std() == pytest.approx(DRIVE.noise, rel=0.1)


def test_lines_of_the_spectrum_have_the_amplitudes_of_the_harmonics(made):
    spectrum = made["spectrum"]
    size = DRIVE.acceleration * np.cos(DRIVE.angle)
    for order, share in ((1, 1.0), (2, 0.05), (3, 0.02)):
        near = (spectrum.frequency - order * DRIVE.frequency).abs() < 5.0
        assert spectrum.along[near].max() == pytest.approx(size * share, rel=0.03)
    # Of white noise with a Hann window: the median of Rayleigh's distribution.
    expected = DRIVE.noise * np.sqrt(np.log(4.0)) * np.sqrt(2.0 * 1.5 / (DRIVE.cycles / DRIVE.frequency * DRIVE.rate))
    assert spectrum.along_floor.median() == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize("drift", [0.0, 0.04, -0.1])
def test_a_drift_of_the_amplitude_is_found(drift):
    quality = tables_of(replace(DRIVE, drift=drift))["quality"].iloc[0]
    assert quality.drift == pytest.approx(drift, abs=1e-3)
    if drift:
        assert quality.deviation == pytest.approx(abs(drift) / np.sqrt(12.0), rel=0.1)
    else:
        assert quality.deviation == pytest.approx(quality.deviation_of_noise, rel=0.4)


def test_a_gap_leaves_rate_cycles_and_steadiness_as_they_are():
    drive = replace(DRIVE, gap=(0.3, 0.6))
    quality = tables_of(drive)["quality"].iloc[0]
    assert quality.sampling_rate == pytest.approx(drive.rate, rel=1e-6)
    assert quality.cycles == pytest.approx(drive.cycles, rel=1e-4)
    assert quality.deviation == pytest.approx(quality.deviation_of_noise, rel=0.4)


def test_offsets_and_noise_are_found(made):
    quality = made["quality"].iloc[0]
    assert [quality.along_offset, quality.normal_offset] == pytest.approx(DRIVE.offsets, abs=0.01)
    assert [quality.along_noise, quality.normal_noise] == pytest.approx([DRIVE.noise] * 2, rel=0.05)
    assert np.isnan(quality.other_frequency)
    assert quality.along_distortion == pytest.approx(np.hypot(0.05, 0.02), rel=0.01)


def test_the_overlay_has_the_harmonics_above_the_noise(made):
    model = yaml.safe_load(overlay.make(made["parameters"], made["harmonics"]))["model"]
    for name in ("acceleration", "frequency", "angle", "phase_shift"):
        assert model[name] == pytest.approx(getattr(DRIVE, name), abs=5e-3)
    second, third = model["harmonics"]
    assert (second["order"], third["order"], third["normal"], third["normal_phase"]) == (2, 3, 0.0, 0.0)
    assert list(second.values())[1:] == pytest.approx(DRIVE.harmonics[0][1:], abs=5e-3)


def test_a_pure_drive_has_an_empty_list_of_harmonics():
    made = tables_of(replace(DRIVE, harmonics=()))
    assert yaml.safe_load(overlay.make(made["parameters"], made["harmonics"]))["model"]["harmonics"] == []


def test_the_example_has_the_drive_that_its_file_names():
    example = yaml.safe_load((ROOT / "config/examples/accelerometer.yaml").read_text())["excitation"]
    text = (ROOT / "config/examples/accelerometer.csv").read_text()
    found = measure.make(text, {**example, "inclination": 0.0})["parameters"]
    truth = {"acceleration": 36.0, "frequency": 50.0, "angle": 0.22, "phase_shift": 0.12}
    for name, value, stderr in zip(found["parameter"], found["value"], found["stderr"], strict=True):
        assert abs(value - truth[name]) < 3.0 * stderr
    assert found["value"][0] == pytest.approx(truth["acceleration"], rel=0.02)


def comparison(slow: float, median: float, stderr: float = 1e-4) -> pd.DataFrame:
    """A made-up table: velocities without harmonics are 0.01 and 0.04 m/s."""
    rows = [
        {"drive": WITH, "velocity_05": slow, "velocity_50": median, "late": 0.25},
        {"drive": WITHOUT, "velocity_05": 0.01, "velocity_50": 0.04, "late": 0.5},
    ]
    table = pd.DataFrame(rows).assign(velocity_05_stderr=stderr, velocity_50_stderr=stderr)
    spread = {"friction": 0.15, "mass": 0.0, "calibrated": True, "seed": 2}
    table.attrs = {"starts": 256, "length": 0.5, "longest": 20.0, "spread": spread}
    return table


def page_of(made: dict[str, pd.DataFrame], compared: pd.DataFrame) -> str:
    """The page on the tables of a drive and on a comparison."""
    return page.make(TEMPLATE, made["parameters"], made["harmonics"], made["quality"], compared, "mine")


@pytest.mark.parametrize(
    ("slow", "median", "stderr", "expected"),
    [
        (0.0101, 0.0401, 1e-4, NO),
        (0.012, 0.04, 1e-4, YES),
        (0.01, 0.037, 1e-4, YES),
        (0.012, 0.04, 1e-2, PERHAPS),
        (0.0101, 0.0401, 1e-2, NO),
        (-0.01, 0.04, 1e-4, YES),
    ],
)
def test_harmonics_matter_if_they_change_a_velocity_beyond_chance(slow, median, stderr, expected):
    table = comparison(slow, median, stderr)
    changes = [change(table, name) for name in ("velocity_05", "velocity_50")]
    assert verdict(changes) == expected


def test_the_change_is_relative_to_the_drive_without_harmonics():
    found = change(comparison(0.012, 0.04), "velocity_05")
    assert (found["before"], found["after"]) == (0.01, 0.012)
    assert found["change"] == pytest.approx(0.2)
    assert found["stderr"] == pytest.approx(np.sqrt(2.0) * 1e-2)


@pytest.mark.parametrize(
    ("slow", "first"),
    [
        (0.012, "# Measured drive: the harmonics matter here"),
        (0.01, "# Measured drive: the harmonics do not matter here"),
    ],
)
def test_the_first_line_says_whether_the_harmonics_matter(made, slow, first):
    text = page_of(made, comparison(slow, 0.04))
    assert text.splitlines()[0] == first
    assert "50 Hz" in text and "40 m/s²" in text and "| 2 | 5" in text and "nan" not in text.lower()
    assert "the parts differ (friction 15 %)" in text


def test_what_the_noise_could_hide_is_on_the_page_and_part_of_the_verdict():
    """A true second harmonic of 3 % in red noise is not found, but lies below the share that the page names."""
    drive = replace(DRIVE, harmonics=((2, 0.03, 1.0, 0.03, 2.0),), noise=6.0, colour=0.9, cycles=30.0)
    noisy, quiet = tables_of(drive), tables_of(replace(DRIVE, harmonics=()))
    hidden = page.hidden_shares(noisy["harmonics"]).iloc[0]
    assert not noisy["harmonics"].above_noise[0] and hidden.along > 0.03 and hidden.normal > 0.03
    text, clean = (page_of(made, comparison(0.01, 0.04)) for made in (noisy, quiet))
    assert text.startswith("# Measured drive: whether the harmonics matter here is not known")
    assert "The noise could hide harmonics that matter" in text
    assert clean.startswith("# Measured drive: the harmonics do not matter here") and "| 2 | < 0." in clean


def test_a_plate_that_throws_backwards_is_named():
    made = tables_of(replace(DRIVE, phase_shift=3.0))
    text = page_of(made, comparison(0.01, 0.04))
    assert "normal to it by 172°: **the plate throws backwards**" in " ".join(text.split())


def test_overlay_and_page_say_how_many_harmonics_are_left_out():
    many = tables_of(
        replace(DRIVE, harmonics=tuple((order, 0.05, 0.3, 0.05, 1.0) for order in range(2, 17)), cycles=100.0)
    )
    text = overlay.make(many["parameters"], many["harmonics"])
    assert "harmonics:   # 3 smaller ones above the noise are left out; a model takes at most 12" in text
    assert len(yaml.safe_load(text)["model"]["harmonics"]) == 12
    assert "3 harmonics above the noise, the smallest ones" in page_of(many, comparison(0.01, 0.04))
