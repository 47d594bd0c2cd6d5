"""Files of measurements: good ones in several spellings, and bad ones, each rejected with its line and a remedy."""

import math
import re

import pytest
import yaml
from project import call_snakemake

from conveyor_pipeline.common import csv_table
from conveyor_pipeline.common.csv_table import TableError
from conveyor_pipeline.config import load_config
from conveyor_pipeline.config.files import merge
from conveyor_pipeline.machine.calibration import measurements
from conveyor_pipeline.machine.calibration.measurements import EXAMPLE, HEADER_UNITS, MOST_BYTES, first_comments, wanted

MODEL = {"frequency": 60.0, "angle": 0.35, "mass": 2e-3, "gravity": 9.81, "inclination": 0.0}
SETTINGS = {"parameters": ["friction", "damping", "stiffness"], "model": MODEL}
HEAD = "acceleration,velocity"


def parse(text, path="mine.csv", settings=None):
    """The measurements in the text of a file."""
    table = csv_table.parse(text, path, wanted, HEADER_UNITS, EXAMPLE)
    return measurements.parse(table, settings or SETTINGS)


def read_text(path):
    return csv_table.read_text(path, "calibration.measurements", MOST_BYTES)


GOOD = "30,0.02\n40,0.05\n50,0.06\n"

# Text of the file (bytes where it is not text), line of the fault, and a part of its message.
BAD = {
    "empty": ("", 1, "is empty"),
    "no velocity": ("acceleration,sd\n30,0.01\n", 1, "has no column velocity (m/s); add it"),
    "no header": ("30,0.02\n40,0.05\n50,0.06\n", 1, "must name the columns, such as acceleration,velocity"),
    "misspelt column": (f"{HEAD},frequncy\n30,0.02,50\n", 1, "did you mean frequency?"),
    "another unit in the header": (
        "acceleration (V),velocity\n30,0.02\n",
        1,
        "states acceleration in 'V'; give it in m/s²",
    ),
    "column twice": (f"{HEAD},velocity\n30,0.02,0.02\n", 1, "has the column velocity twice"),
    "searched parameter": (
        f"{HEAD},friction\n30,0.02,0.2\n",
        1,
        "delete the column, or take friction out of calibration.parameters",
    ),
    "decimal comma": (
        f'{HEAD}\n30,0.02\n40,"0,05"\n50,0.06\n',
        3,
        "has a decimal comma, other numbers have points; write 0.05",
    ),
    "decimal comma without quotes": (
        f"{HEAD}\n30,0.02\n40,0,05\n50,0.06\n",
        3,
        "has 3 values for 2 columns; leave no field out, and separate columns by semicolons if numbers have commas",
    ),
    "text in a number": (f"{HEAD}\n30,0.02\n40,fast\n50,0.06\n", 3, "velocity = 'fast' is text"),
    "unit in a number": (f"{HEAD}\n30 m/s²,0.02\n40,0.05\n50,0.06\n", 2, "without the unit"),
    "nan": (f"{HEAD}\n30,0.02\n40,nan\n50,0.06\n", 3, "is not a measured number; delete the line"),
    "empty velocity": (f"{HEAD}\n30,0.02\n40,\n50,0.06\n", 3, "has no velocity; fill it in"),
    "no duration": (f"{HEAD},duration\n30,0.02,1\n40,0.05,0\n50,0.06,1\n", 3, "duration = 0 must be more than 0"),
    "negative sd": (f"{HEAD},sd\n30,0.02,-0.001\n40,0.05,\n50,0.06,\n", 2, "sd = -0.001 is outside"),
    "sd without a unit": (
        "acceleration,velocity (cm/s),sd\n30,2,0.05\n40,5,0.05\n50,6,0.05\n",
        1,
        "states velocity in cm/s, and no unit of sd; state the units of both",
    ),
    "sd in cm/s": (
        f"{HEAD},sd\n30,0.02,0.5\n40,0.05,\n50,0.06,\n",
        2,
        "sd = 0.5 m/s is larger than the largest velocity of the plate",
    ),
    "height in the plate": (f"{HEAD},z0\n30,0.02,0.0003\n40,0.05,-0.3\n50,0.06,\n", 3, "z0 = -0.3 m is in the plate"),
    "negative amplitude": (f"{HEAD}\n-0.3,0.02\n40,0.05\n50,0.06\n", 2, "acceleration = -0.3 must not be negative"),
    "semicolons below commas": (
        f"{HEAD}\n30;0.02\n40;0.05\n50;0,06\n",
        1,
        "a line above the values, separated like them",
    ),
    "zero sd": (f"{HEAD},sd\n30,0.02,0.001\n40,0.05,0\n50,0.06,\n", 3, "leave sd empty"),
    "angle in degrees": (f"{HEAD},angle\n30,0.02,20\n40,0.05,20\n50,0.06,20\n", 2, "(angles in rad)"),
    "velocities in cm/s": (f"{HEAD}\n30,2\n40,5\n50,6\n", 2, "in cm/s: divide by 100"),
    "velocities in m/min": (f"{HEAD}\n30,1.2\n40,3\n50,3.6\n", 2, "in m/min: divide by 60"),
    "velocities in mm/s": (f"{HEAD}\n30,20\n40,50\n50,60\n", 2, "in mm/s: divide by 1000"),
    "mm/s below cm/s": (
        "acceleration,velocity (cm/s)\n30,20\n40,50\n50,60\n",
        2,
        "in cm/s, as the header says, or m/min: divide by 60?",
    ),
    "accelerations in g": (f"{HEAD}\n3,0.02\n4,0.05\n5,0.06\n", 2, "Is the acceleration in g: multiply by 9.81?"),
    "fewer rows than parameters": (f"{HEAD}\n30,0.02\n40,0.05\n", 3, "2 measurements cannot determine 3 parameters"),
    "a spreadsheet": (b"PK\x03\x04\x14\x00\x06\x00\xff\xfe" + bytes(300), 1, "is not text"),
    "open quote": (f'{HEAD}\n30,0.02\n40,"0.05\n50,0.06\n', 4, "is not CSV"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_rejected_with_line_and_remedy(name, tmp_path):
    text, line, message = BAD[name]
    file = tmp_path / "mine.csv"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(TableError) as error:
        parse(read_text(file), file)
    assert error.value.faults[0].startswith(f"{file}:{line}: ")
    assert message in error.value.faults[0]
    assert all("\n" not in fault for fault in error.value.faults)


def test_quotes_in_comments_begin_no_field():
    text = f'{HEAD}\n25,0.02\n# rail A, "hard\n30,0.03\n  # lining", and "others" of it\n35,0.04\n"# rail B, soft",\n'
    assert [(row.line, row.acceleration) for row in parse(text, "mine.csv")] == [
        (2, 25.0),
        (4, 30.0),
        (6, 35.0),
    ]


def test_comments_before_the_header_are_quoted():
    text = f"\n# rail A\n  #  hard lining \n#\n{HEAD}\n# not this one\n25,0.02\n"
    assert first_comments(text) == ["rail A", "hard lining"]


@pytest.mark.parametrize("kind", ["missing", "folder"])
def test_files_that_cannot_be_read_are_named(kind, tmp_path):
    path = tmp_path if kind == "folder" else tmp_path / "nothing.csv"
    with pytest.raises(TableError, match=r"calibration\.measurements names a CSV file"):
        read_text(path)


def test_all_faults_of_a_file_are_named_at_once():
    with pytest.raises(TableError) as error:
        parse(f"{HEAD}\n30,x\n40,0.05\n-1,0.06\n", "mine.csv")
    assert [fault.split(":")[1] for fault in error.value.faults] == ["2", "4"]


def test_optional_columns_have_defaults_and_lines_are_those_of_the_file():
    text = "# a comment\n\nacceleration, velocity, sd, before, frequency, z0\n"
    text += "30, 0.02, , 2, , 1e-4\n40,0.05,0.001,,61,\n50,.06,,,,\n"
    one, two, three = parse(text, "mine.csv")
    assert [row.line for row in (one, two, three)] == [4, 5, 6]
    assert (one.sd, one.before, one.duration, one.changed) == (None, 2.0, 1.0, {"z0": 1e-4})
    assert (two.sd, two.before, two.changed) == (0.001, 1.0, {"frequency": 61.0})
    assert three == (6, 50.0, 0.06, None, 1.0, 1.0, {})


def test_parameters_may_have_their_unit_in_the_header():
    text = (
        "acceleration,velocity,frequency (Hz),inclination (deg),z0 [mm]\n30,0.02,50,1,0.3\n40,0.05,60,,\n50,0.06,,,\n"
    )
    first, second, _ = parse(text)
    assert first.changed == pytest.approx({"frequency": 50.0, "inclination": math.radians(1.0), "z0": 3e-4})
    assert second.changed == {"frequency": 60.0}
    for header, fault in {
        "frequency (rpm)": "states frequency in 'rpm'; give it in Hz, without the unit in the header",
        "mass (g)": "states mass in 'g'; give it in kg",
        "static_friction": "state it as model.static_friction",
    }.items():
        with pytest.raises(TableError) as error:
            parse(f"{HEAD},{header}\n{GOOD.replace(chr(10), ',1' + chr(10))}")
        assert fault in str(error.value)


@pytest.mark.parametrize(
    ("text", "durations"),
    [
        ("26;37;1,025\n36;39;1,110\n56;41;1,204\n", [1.025, 1.11, 1.204]),
        ("26;37;2\n36;39;1,110\n56;41;1,204\n", None),
        ("26\t37\t1,025\n36\t39\t1,110\n56\t41\t1,204\n", None),
        ("26.5\t37\t1,025\n36\t39\t1,110\n56\t41\t1,204\n", [1025.0, 1110.0, 1204.0]),
    ],
    ids=["semicolons", "beside whole numbers", "tabs", "points"],
)
def test_a_comma_before_three_digits_is_decimal_for_sure_or_refused(text, durations):
    separator = ";" if ";" in text else "\t"
    text = separator.join(["acceleration", "velocity (mm/s)", "duration"]) + "\n" + text
    if durations:
        assert [row.duration for row in parse(text)] == durations
    else:
        with pytest.raises(TableError, match=r"has the number 1,\d{3}, which may be 1\d{3} or 1\.\d{3}"):
            parse(text)


def test_harmonics_make_the_plate_faster():
    text = f"{HEAD}\n80,0.6\n80,0.6\n80,0.6\n"
    with pytest.raises(TableError, match="impossible"):
        parse(text, "mine.csv")
    second = {"order": 2, "along": 1.2, "along_phase": 0.5, "normal": 0.0, "normal_phase": 0.0}
    parse(text, "mine.csv", SETTINGS | {"model": MODEL | {"harmonics": [second]}})


def test_parts_that_slide_down_a_steep_track_may_be_faster_than_the_plate():
    steep = SETTINGS | {"model": MODEL | {"inclination": -0.3}}
    assert len(parse(f"{HEAD}\n30,0.9\n40,0.9\n50,0.9\n", "mine.csv", steep)) == 3
    with pytest.raises(TableError, match="impossible"):
        parse(f"{HEAD}\n30,0.9\n40,0.9\n50,0.9\n", "mine.csv")


@pytest.mark.parametrize(
    "text",
    [
        "Trial of May\n\nAcceleration (m/s²),Velocity (cm/s)\n30,2\n40,5\n50,6\n",
        "acceleration,velocity\nm/s^2,mm/s\n30,20\n40,50\n50,60\n",
    ],
    ids=["header", "line below it"],
)
def test_velocities_have_the_unit_that_the_file_states(text):
    rows = [(row.acceleration, row.velocity) for row in parse(text)]
    assert rows == [(30.0, 0.02), (40.0, 0.05), (50.0, pytest.approx(0.06))]


def run_snakemake(overlay, *targets):
    return call_snakemake("--dry-run", *targets, "--configfile", str(overlay))


def test_a_bad_file_ends_snakemake_before_any_job(tmp_path):
    (tmp_path / "mine.yaml").write_text(
        "prefix: mine\nmodel: {frequency: 60.0}\ncalibration: {measurements: mine.csv}\n"
    )
    (tmp_path / "mine.csv").write_text(f"{HEAD}\n30,2\n40,5\n50,6\n")
    run = run_snakemake(tmp_path / "mine.yaml", "results/mine/calibration.md")
    assert run.returncode != 0
    assert "mine.csv:2: velocity = 2 m/s is impossible" in run.stdout
    assert "cm/s: divide by 100" in run.stdout
    assert "Building DAG" not in run.stdout


def test_a_file_of_measurements_on_the_command_line_replaces_that_of_the_overlay(tmp_path):
    overlay = {"prefix": "mine", "model": {"frequency": 60.0}, "calibration": {"measurements": "mine.csv"}}
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(overlay))
    for name in ("mine.csv", "other.csv"):
        (tmp_path / name).write_text(f"{HEAD}\n{GOOD}")
    files = [tmp_path / "mine.yaml"]
    assert load_config(files, overlay).config["calibration"]["measurements"] == str(tmp_path / "mine.csv")
    given = {"calibration": {"measurements": str(tmp_path / "other.csv")}}
    loaded = load_config(files, merge(overlay, given))
    assert loaded.config["calibration"]["measurements"] == str(tmp_path / "other.csv")


@pytest.mark.parametrize(
    "target", ["results/mine/calibration.md", "figures/mine/calibration.pdf", "results/mine/calibrated.yaml"]
)
def test_a_config_without_measurements_refuses_a_calibration(target, tmp_path):
    (tmp_path / "mine.yaml").write_text("prefix: mine\nmodel: {frequency: 60.0}\n")
    run = run_snakemake(tmp_path / "mine.yaml", target)
    assert run.returncode != 0
    assert "a calibration needs measured velocities" in run.stdout


def test_the_caption_of_the_figure_needs_the_tables_of_this_figure_only(tmp_path):
    (tmp_path / "mine.yaml").write_text(
        "prefix: mine\nmodel: {frequency: 60.0}\ncalibration: {measurements: mine.csv}\n"
    )
    (tmp_path / "mine.csv").write_text(f"{HEAD}\n{GOOD}")
    run = run_snakemake(tmp_path / "mine.yaml", "results/mine/captions/calibration.rst")
    assert run.returncode == 0, run.stdout
    jobs = dict(re.findall(r"^(\w+) +(\d+)$", run.stdout, re.MULTILINE))
    assert jobs.keys() == {"calibration", "calibration_prediction", "plot", "caption", "total"}
