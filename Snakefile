from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

try:
    from workflow.config import ConfigError, replace_config
except ModuleNotFoundError as error:
    if error.name.partition(".")[0] != "workflow":
        raise
    raise WorkflowError('This Snakefile needs the files beside it; in a Git repository, name path="workflow/Snakefile"')

min_version("9.27")

# The config of the paper, with the overlays of the command line merged over it and checked.
try:
    loaded, OVERLAYS, COMMAND_LINE = replace_config(workflow, config)
except ConfigError as error:
    raise WorkflowError(str(error))
config = loaded.config
PAPER, OWN_CONVEYOR = loaded.paper, loaded.own_conveyor


report: "workflow/report/workflow.rst"


container: "conveyor.sif"


include: "workflow/rules/common.smk"
include: "workflow/rules/sweeps.smk"
include: "workflow/rules/motion.smk"
include: "workflow/rules/orbits.smk"
include: "workflow/rules/dimensions.smk"
include: "workflow/rules/fit.smk"
include: "workflow/rules/sensitivity.smk"
include: "workflow/rules/operating.smk"
include: "workflow/rules/excitation.smk"
include: "workflow/rules/calibration.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/identification.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/docs.smk"
include: "workflow/rules/builds.smk"
include: "workflow/rules/report.smk"


rule all:
    default_target: True
    input:
        figure_files(),
        excitation_files(),
        calibration_files(),
        caption_files(),
        CLAIM_FILES,
        BUILD_RECORDS,
        REPORT_FILES,
    localrule: True
    message:
        "All figures and claims are up to date"
