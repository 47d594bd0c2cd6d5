# Measured files of the machine, and models of the examples.
from conveyor.parameters import INITIAL_CONDITION
from conveyor_pipeline.common.table_settings import model_of
from conveyor_pipeline.config.entries import MEASURED_FILES

EXAMPLES = ("bowl", "linear", "trough")  # complete conveyors in config/examples

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


def models_of_examples(wildcards):
    """A param: the models of the examples, without amplitude and initial condition, by name."""
    files = {name: ROOT / f"config/examples/{name}.yaml" for name in EXAMPLES}
    configs = {name: load_config([file], {}).merged for name, file in files.items()}
    return {name: model_of(merged, without=INITIAL_CONDITION) for name, merged in configs.items()}
