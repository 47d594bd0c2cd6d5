# The floor machine: where to run one's own conveyor, the drive from an accelerometer, and parameters from measured velocities.
from conveyor_pipeline.config.entries import MEASURED_FILES

MEASURED = {section: config[section].get(key) for section, key in MEASURED_FILES.items()}
# Errors for a config without such a file.
NOT_MEASURED = {
    "calibration": "a calibration needs measured velocities; give an overlay with a prefix that names a CSV file of them, relative "
    "to itself: calibration: {measurements: FILE.csv}",
    "excitation": "a measured drive needs the file of an accelerometer; give an overlay with a prefix that names a CSV file, relative "
    "to itself: excitation: {measured: FILE.csv}",
}


def measured_file(section):
    """Input: the measured file that a section names; an error for a config without one."""

    def file(wildcards):
        if not MEASURED[section]:
            raise WorkflowError(NOT_MEASURED[section])
        return MEASURED[section]

    return file


# A figure of a measured file has the name of the section that names this file.
NO_FIGURES |= {section: reason for section, reason in NOT_MEASURED.items() if not MEASURED[section]}


include: "operating.smk"
include: "excitation.smk"
include: "calibration.smk"


MACHINE_FILES = [*OPERATING_FILES, *EXCITATION_FILES, *CALIBRATION_FILES]
FLOOR_FILES += MACHINE_FILES


rule machine:
    input:
        MACHINE_FILES,
    localrule: True
    message:
        "The answers for this machine are up to date"
