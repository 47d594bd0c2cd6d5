# Measured files of the machine.
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
