from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.config_files import as_first_written, merged, read, refusal
from workflow.configuration import by_methods, canonical, problems, with_tighter
from workflow.interruptions import end_with_the_terminal, name_commands_at_a_lock
from workflow.job_lines import show_a_line_per_job
from workflow.own_machine import fitted, is_own, model_problems, refusals
from workflow.scheduling import look_for_jobs_when_one_ends

min_version("9.27")
end_with_the_terminal()
name_commands_at_a_lock()
show_a_line_per_job()
look_for_jobs_when_one_ends()

# The config of the paper, one file for each stage; overlays of the command line are merged over it.
STAGES = (
    "sweeps",
    "motion",
    "orbits",
    "dimensions",
    "fit",
    "sensitivity",
    "operating",
    "accuracy",
    "claims",
    "identification",
    "figures",
    "docs",
)
files = [f"config/{name}.yaml" for name in ("config", *STAGES)] + [*workflow.overwrite_configfiles]
read_files = [read(file) for file in files]
if errors := [fault for faults, _ in read_files for fault in faults]:
    raise WorkflowError(refusal(errors))

contents = [content for _, content in read_files]
# What overlays are compared with where the report says what it shows.
PAPER = merged(*contents[: len(STAGES) + 1])
# Another machine's config is the paper's in that machine's own scales.
OWN_MACHINE = is_own(PAPER, config)
if OWN_MACHINE:
    if errors := model_problems(PAPER, config):
        raise WorkflowError(refusal(errors))
    contents = [fitted(PAPER, config), *contents[len(STAGES) + 1 :]]
whole = as_first_written(merged(*contents, config), contents)
# A job on a cluster starts Snakemake again: the config has been checked by then.
if workflow.is_main_process and (errors := problems(whole)):
    raise WorkflowError(refusal(errors))

# Nothing that follows from the config may depend on the order of keys or the spelling of numbers in overlays. It is the same
# object that Snakemake hands to the report.
config.clear()
config.update(with_tighter(by_methods(canonical(whole))))


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
