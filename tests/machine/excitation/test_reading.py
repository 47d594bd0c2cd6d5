"""Accelerometer files: good ones in several spellings, and bad ones, each rejected with file, line and remedy."""

import os
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import yaml
from accelerometer import Drive, check, read, table_of

from conveyor.parameters import HARMONIC
from conveyor_pipeline import make
from conveyor_pipeline.common.csv_table import TableError, read_text, to_numbers
from conveyor_pipeline.config import ConfigError, load_config
from conveyor_pipeline.config.files import merge
from conveyor_pipeline.machine.excitation.faults import MOST_SHARE
from conveyor_pipeline.machine.excitation.harmonics import first_fit
from conveyor_pipeline.machine.excitation.reading import MOST_BYTES, STANDARD_GRAVITY, parse

DRIVE = Drive(cycles=20.0)
GOOD = DRIVE.text()
LINES = GOOD.splitlines()


def with_line(number: int, content: str) -> str:
    """The good file with another line; lines are numbered from 1."""
    return "\n".join([*LINES[: number - 1], content, *LINES[number:], ""])


def with_rounded_times(text: str, digits: int) -> str:
    """The file with times of fewer digits after the point."""
    header, *lines = text.splitlines()
    rows = [line.split(",", 1) for line in lines]
    return "\n".join([header, *(f"{float(time):.{digits}f},{rest}" for time, rest in rows), ""])


# Text of the file, line of the fault, and a part of its message. Faults of any table: calibration/test_measurements.py.
BAD_TEXTS = {
    "no normal": (GOOD.replace("normal", "y", 1), 1, "has no column normal; there are time, along, y"),
    "only x": (GOOD.replace("along,normal", "x,y", 1), 1, "has no column z"),
    "unknown unit": (GOOD.replace("along", "along (V)", 1), 1, "states the unit 'V'; state excitation.unit"),
    "two units": (GOOD.replace("along,normal", "along (g),normal (m/s^2)", 1), 1, "states the units g and m/s²"),
    "misspelt column": (
        GOOD.replace("normal", "nromal", 1),
        1,
        "excitation.columns: {time: time, along: along, normal: nromal}",
    ),
    "column twice": (
        GOOD.replace("normal", "along,normal", 1).replace("\n", ",1\n").replace("normal,1", "normal"),
        1,
        "has the column along twice",
    ),
    "four columns": (
        "time,along,normal,x,z\n0,1,2,3,4\n",
        1,
        "has both along, normal and x, z; name one pair in excitation.columns",
    ),
    "time goes back": (
        with_line(20, LINES[11]),
        20,
        "is earlier than the line before; sort the lines, or state excitation.rate",
    ),
    "short": ("\n".join(LINES[:40]), 40, "ends after 39 samples"),
}
# Drive of the file, and a part of the message.
BAD_SIGNALS = {
    "few cycles": (replace(DRIVE, cycles=6.0), "holds 6 cycles of 50 Hz; record at least 8"),
    "slow sampling": (replace(DRIVE, rate=300.0), "has 6 samples in a cycle of 50 Hz"),
    "aliased": (replace(DRIVE, rate=80.0, cycles=100.0), "anti-aliasing"),
    "aliased to a slow drive": (replace(DRIVE, rate=45.0, cycles=100.0), "looks like one of 5 Hz (aliasing)"),
    "an aliased harmonic": (
        replace(DRIVE, rate=520.0, cycles=60.0, harmonics=((8, 0.2, 0.0, 0.2, 0.0),)),
        "at 120",
    ),
    "two frequencies": (replace(DRIVE, also={77.0: 8.0}), "Hz, no multiple of it; record one drive alone"),
    "two drives that beat": (
        replace(DRIVE, also={47.0: 2.0}, cycles=80.0),
        "Hz, no multiple of it; record one drive alone",
    ),
    "a line of one axis": (
        replace(DRIVE, also={77.0: 1.2}, cycles=80.0),
        "Hz, no multiple of it; record one drive alone",
    ),
    "4000 m/s²": (replace(DRIVE, acceleration=4000.0), "no conveyor does: state another excitation.unit"),
    "a drive that is off": (replace(DRIVE, acceleration=0.03, noise=1e-4), "and record while the drive is on"),
    "minutes": (
        replace(DRIVE, frequency=3000.0, rate=120_000.0),
        "its times may be in minutes; export them in s",
    ),
    "a drive that starts": (replace(DRIVE, drift=1.2), "is not steady: its amplitude at 50 Hz varies by "),
    "two drives of nearly one frequency": (replace(DRIVE, angle=1.2, cycles=60.0, also={49.5: 20.0}), "is not steady"),
    "a fundamental too weak for its harmonics": (
        replace(DRIVE, harmonics=((2, 0.1, 0.0, 12.0, 0.5),), cycles=40.0),
        "vibrates normal to the track 12 times as much at 100 Hz",
    ),
    "no motion along the track": (replace(DRIVE, angle=1.5707), "shows no vibration along the track"),
    "no motion normal to it": (replace(DRIVE, angle=1e-4), "shows no vibration normal to the track"),
}


def faults_of(text: str, **settings) -> list[str]:
    try:
        check(text, {"mount": 0.0, "frequency": 50.0, **settings})
    except TableError as error:
        return error.faults
    return []


@pytest.mark.parametrize("name", BAD_TEXTS)
def test_bad_texts_are_rejected_with_line_and_remedy(name, tmp_path):
    content, line, message = BAD_TEXTS[name]
    file = tmp_path / "mine.csv"
    file.write_text(content)
    with pytest.raises(TableError) as error:
        text = read_text(file, "excitation.measured", MOST_BYTES)
        parse(table_of(text, {}, file), {"mount": 0.0})
    assert error.value.faults[0].startswith(f"{file}:{line}: ")
    assert message in error.value.faults[0]
    assert all("\n" not in fault for fault in error.value.faults)


@pytest.mark.parametrize("name", BAD_SIGNALS)
def test_bad_signals_are_rejected_with_a_remedy(name):
    drive, message = BAD_SIGNALS[name]
    assert message in "".join(faults_of(drive.text(), unit=drive.unit))


@pytest.mark.parametrize(("limit", "noise"), [(15.0, 0.3), (30.0, 0.3), (36.5, 0.1), (30.0, 0.0), (38.6, 1.0)])
@pytest.mark.parametrize("mount", [0.0, 0.2])
def test_clipped_signals_are_rejected_with_their_first_line(limit, noise, mount):
    drive = replace(DRIVE, limit=limit, noise=noise, mount=mount)
    fault = faults_of(drive.text(), mount=mount)[0]
    assert "is cut off there" in fault
    header, *rows = drive.text().splitlines()
    column = header.split(",").index(fault.split()[1])
    at_limit = [abs(float(row.split(",")[column])) == limit for row in rows]
    assert at_limit.index(True) + 2 == int(fault.split(":")[1])


def test_a_sample_far_from_all_others_is_rejected_with_its_line():
    time, along, _ = LINES[41].split(",")
    fault = faults_of(with_line(42, f"{time},{along},{1e4}"))[0]
    assert fault.startswith("mine.csv:42: normal = 1e+04 stands out of all other values; check the cable, and delete")


def test_a_recording_of_gaps_is_rejected_with_the_line_after_the_first():
    fault = faults_of(replace(DRIVE, gap=(0.1, 0.95), cycles=80.0).text())[0]
    assert fault.startswith("mine.csv:322: follows a gap, and gaps are 85 % of the recording; keep a piece")


def test_the_largest_share_is_the_models():
    assert {MOST_SHARE} == {HARMONIC[name][2][1] for name in ("along", "normal")}


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"acceleration": 0.1 * STANDARD_GRAVITY, "unit": "g", "noise": 0.01},
        {"cycles": 8.0, "rate": 400.0, "noise": 2.0, "angle": 0.6},
        {"quantum": 1.0, "noise": 0.02},
        {"noise": 0.0, "rate": 400.0},
        {"noise": 0.0, "rate": 800.0, "psi0": 0.0, "phase_shift": 0.0},
        {"drift": 0.3},
        {"jitter": 0.9, "mount": 0.3},
        {"random": True},
        {"gap": (0.3, 0.5), "cycles": 40.0},
        # The mean interval with its gap would be too long for eight samples in a cycle, and for the fifth harmonic.
        {"gap": (0.2, 0.7), "cycles": 80.0, "rate": 650.0, "harmonics": ((5, 0.2, 0.0, 0.2, 1.0),)},
        {"bias": (0.1, -0.2), "mount": 1.2},
        # A sensor that removes gravity.
        {"bias": (0.05, 0.1 - STANDARD_GRAVITY)},
        {"inclination": 0.1},
        {"inclination": -0.1, "mount": 0.3},
        {"acceleration": 4.0, "noise": 1.0, "colour": 0.95, "cycles": 200.0, "rate": 1000.0},
        {"also": {77.0: 0.5}},
        {"also": {2.0: 5.0}},
        {"harmonics": ((2, 0.6, 1.0, 0.9, 0.0), (3, 0.3, 1.0, 0.9, 2.0))},
        {"phase_shift": 3.1},
    ],
)
def test_good_signals_are_accepted(changes):
    drive = replace(DRIVE, **changes)
    assert faults_of(drive.text(), **drive.settings) == []


def test_a_weak_fundamental_is_found_below_its_second_harmonic():
    drive = replace(DRIVE, harmonics=((2, 3.0, 0.0, 3.0, 0.5),), cycles=40.0)
    assert faults_of(drive.text()) == []


@pytest.mark.parametrize("mount", [0.0, 0.7])
@pytest.mark.parametrize("unit", ["g", "m/s²"])
def test_columns_are_turned_and_scaled(unit, mount):
    drive = replace(DRIVE, unit=unit, mount=mount, noise=0.0, bias=(0.0, 0.0))
    found = read(drive.text(), drive.settings)
    expected = drive.plate(found.time + drive.record()[0][0])
    expected[1] += STANDARD_GRAVITY
    np.testing.assert_allclose(found.acceleration, expected, atol=2e-3)


@pytest.mark.parametrize(
    "change",
    [
        lambda text: "\ufeff" + text,
        lambda text: text.replace("\n", "\r\n"),
        lambda text: "# rail A\n\n" + text.replace("\n", "\n# a note; with, signs\n", 2),
        lambda text: "sep=;\n" + text.replace(",", ";").replace(".", ","),
        lambda text: text.replace(",", "\t"),
        lambda text: text.replace("\n", ",\n").replace("normal,", "normal,y").replace(",\n", ",3.5\n"),
        lambda text: text.replace("time,along,normal", " Time , Along , Normal "),
        lambda text: text.replace("\n", ",a note\n").replace("normal,a note", "normal,remark"),
    ],
    ids=["mark", "CRLF", "comments", "sep and semicolons", "tabs", "further", "capitals", "remarks"],
)
def test_other_spellings_of_a_file_are_read(change, tmp_path):
    file = tmp_path / "mine.csv"
    file.write_bytes(change(GOOD).encode())
    text = read_text(file, "excitation.measured", MOST_BYTES)
    np.testing.assert_array_equal(read(text, DRIVE.settings).acceleration, read(GOOD, DRIVE.settings).acceleration)
    assert make.read(str(file), {}) == text


def test_a_mount_belongs_to_the_columns_of_a_sensor():
    assert "turns x and z only" in faults_of(GOOD, mount=0.1)[0]


def load(tmp_path, overlay, *others):
    """The config of an overlay in a folder of its own, and of further ones, as on the command line."""
    files = []
    for place, content in enumerate((overlay, *others)):
        folder = tmp_path / f"folder_{place}"
        folder.mkdir(exist_ok=True)
        files.append(folder / "mine.yaml")
        files[-1].write_text(yaml.safe_dump(content))
    return load_config(files, merge(overlay, *others)).config


def test_random_times_may_be_equal_after_rounding():
    drive = replace(DRIVE, random=True, cycles=80.0)
    rounded = with_rounded_times(drive.text(), 5)
    times = [line.split(",")[0] for line in rounded.splitlines()]
    assert len(set(times)) < len(times)
    recordings = [check(text, drive.settings) for text in (drive.text(), rounded)]
    sizes = [np.abs(first_fit(one.time, one.acceleration)[0].amplitudes[:, 0]) for one in recordings]
    np.testing.assert_allclose(*sizes, rtol=1e-4)


def test_the_file_is_relative_to_its_overlay(tmp_path):
    (tmp_path / "folder_0").mkdir()
    (tmp_path / "folder_0/mine.csv").write_text(GOOD)
    overlay = {"prefix": "mine", "excitation": {"measured": "mine.csv"}}
    for others in ((), ({"model": {"frequency": 49.9, "angle": 0.3}},)):
        config = load(tmp_path, overlay, *others)
        assert os.path.samefile(config["excitation"]["measured"], tmp_path / "folder_0/mine.csv")
        assert "excitation" in config["figures_on_request"]


def test_an_overlay_with_a_file_keeps_its_parts_and_axes_before_the_measured_drive(tmp_path):
    (tmp_path / "folder_0").mkdir()
    (tmp_path / "folder_0/mine.csv").write_text(GOOD)
    overlay = {
        "prefix": "mine",
        "excitation": {"measured": "mine.csv"},
        "parts": {"friction": 0.1},
        "operating": {"acceleration": {"start": 25.0, "stop": 50.0, "num": 6}},
    }
    config = load(tmp_path, overlay, {"model": {"frequency": 49.9, "angle": 0.3}})
    assert config["parts"]["friction"] == 0.1
    assert config["operating"]["acceleration"]["stop"] == 50.0


@pytest.mark.parametrize(
    ("overlay", "message"),
    [
        ({"prefix": "mine", "excitation": {"measured": "none.csv"}}, "none.csv: No such file or directory"),
        ({"excitation": {"measured": "mine.csv"}}, "give the config a prefix"),
        ({"prefix": "mine", "excitation": {"measured": "mine.csv", "unit": "V"}}, "excitation.unit = 'V'"),
        ({"prefix": "mine", "excitation": {"measured": "mine.csv", "mount": 90.0}}, "excitation.mount = 90.0"),
        ({"prefix": "mine", "excitation": {"measured": "mine.csv", "mount": 0.5}}, "turns x and z only"),
    ],
)
def test_faults_end_the_run_before_any_job(overlay, message, tmp_path):
    (tmp_path / "folder_0").mkdir()
    (tmp_path / "folder_0/mine.csv").write_text(GOOD)
    with pytest.raises(ConfigError) as error:
        load(tmp_path, overlay)
    assert message in str(error.value)


@pytest.mark.parametrize("sign", ["'", "\u00a0", "\u202f"])
def test_signs_between_thousands_are_read(sign):
    texts = pd.Series([f"12{sign}345.5", "-0.25"])
    assert to_numbers(texts, (".", "")).tolist() == [12345.5, -0.25]
