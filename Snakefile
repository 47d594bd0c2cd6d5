from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.config import ConfigError, load_config
from workflow.config.files import DEFAULT_FILES, STAGES
from workflow.interruptions import end_with_the_terminal, name_commands_at_a_lock
from workflow.job_lines import show_a_line_per_job
from workflow.scheduling import look_for_jobs_when_one_ends

min_version("9.27")
end_with_the_terminal()
name_commands_at_a_lock()
show_a_line_per_job()
look_for_jobs_when_one_ends()

try:
    loaded = load_config(DEFAULT_FILES, workflow.overwrite_configfiles, config, check=workflow.is_main_process)
except ConfigError as error:
    raise WorkflowError(str(error))
# What overlays are compared with where the report says what it shows.
PAPER, OWN_MACHINE = loaded.paper, loaded.own_machine

# Nothing that follows from the config may depend on the order of keys or the spelling of numbers in overlays. It is the same
# object that Snakemake hands to the report.
config.clear()
config.update(loaded.config)


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/sweeps.smk"
include: "workflow/rules/motion.smk"
include: "workflow/rules/orbits.smk"
include: "workflow/rules/dimensions.smk"
include: "workflow/rules/fit.smk"
include: "workflow/rules/sensitivity.smk"
include: "workflow/rules/operating.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/identification.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/docs.smk"
include: "workflow/rules/builds.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/make.smk"


rule all:
    default_target: True
    input:
        figure_files(),
        caption_files(),
        result("claims.md"),
        checked_files(),
        result("provenance.json"),
        report_files(),
    localrule: True
    message:
        "All figures and claims are up to date"
