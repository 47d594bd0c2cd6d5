"""Settings of the stage excitation: the measured drive and drives with one harmonic, with units and ranges."""

from typing import NotRequired

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import (
    THROW,
    Acceleration,
    Line,
    check_ascending,
    described,
    dimensionless,
    list_of,
    mapping,
    number,
    whole,
    word,
)
from conveyor_pipeline.machine.operating.settings import parts_settings

Column = described(Line, "name of a column in the file; a minus before it reverses the axis")
COLUMNS = dict.fromkeys(("time", "x", "z", "along", "normal"), NotRequired[Column])


class Excitation(TypedDict):
    measured: NotRequired[described(Line, "CSV file of an accelerometer, relative to this overlay")]
    unit: NotRequired[word("unit of the accelerations in the file", "m/s²", "g", "mm/s²", "mg")]
    mount: number("angle of the sensor's axis x above the track, for columns x and z", "rad", ge=-3.1416, le=3.1416)
    columns: NotRequired[mapping("the columns of the file, if they have other names", COLUMNS)]
    time_unit: NotRequired[word("unit of the times in the file", "s", "ms", "µs", "ns")]
    rate: NotRequired[number("samples per second, in place of the times in the file", "Hz", gt=0, le=1e7)]


class CleanDrive(TypedDict):
    dimensionless: dimensionless(
        riding=list_of(THROW, "throw numbers at which the slowest parts ride"),
        chaos=list_of(THROW, "throw numbers in chaos"),
    )
    riding: NotRequired[list_of(Acceleration, "amplitudes at which the slowest parts ride")]
    chaos: NotRequired[list_of(Acceleration, "amplitudes in chaos")]
    orders: list_of(whole("order of a harmonic", 2, 20), "orders of the harmonic")
    shares: list_of(number("share of a harmonic, over the fundamental", gt=0, le=1), "shares", check=check_ascending)
    phases: whole("phases of the harmonic, over a whole turn", 1, 360)


SECTIONS = {
    "excitation": described(Excitation, "the drive from an accelerometer file"),
    "clean_drive": described(CleanDrive, "transit on drives with one harmonic"),
}
EXCITATION_TABLES = ("parameters", "harmonics", "quality", "samples", "waveform", "spectrum")


def excitation_settings(config: dict) -> dict:
    """The recording, and the inclination, to which the direction of gravity refers."""
    return {**config["excitation"], "inclination": config["model"]["inclination"]}


def comparison_settings(config: dict) -> dict:
    """The parts of the transit table, on the measured drive."""
    return parts_settings(config, without=("frequency", "angle", "phase_shift", "harmonics"))


def clean_drive_settings(config: dict) -> dict:
    """The parts of the transit table, on drives with one harmonic."""
    return {**parts_settings(config), **config["clean_drive"]}


TABLE_SETTINGS = {
    **dict.fromkeys((f"excitation/{name}" for name in EXCITATION_TABLES), excitation_settings),
    "excitation/comparison": comparison_settings,
    "excitation/clean_drive": clean_drive_settings,
}
MEASURED_FILES = {"excitation": "measured"}
# Where the config may have a key `dimensionless`: keys below each section, or () for the section itself.
SCALED = {"clean_drive": ((),)}
