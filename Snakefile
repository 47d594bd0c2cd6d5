from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.config_files import as_first_written, read, refusal
from workflow.configuration import canonical, problems

min_version("9.27")

CONFIG_FILE = "config/config.yaml"
config_files = [read(file) for file in (CONFIG_FILE, *workflow.overwrite_configfiles)]
if errors := [fault for faults, _ in config_files for fault in faults]:
    raise WorkflowError(refusal(errors))


configfile: CONFIG_FILE


if errors := problems(config):
    raise WorkflowError(refusal(errors))

# Nothing that follows from the config may depend on the order of keys or the spelling of numbers in overlays.
config = canonical(as_first_written(config, [content for _, content in config_files]))


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/sweeps.smk"
include: "workflow/rules/analysis.smk"
include: "workflow/rules/orbits.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"


rule all:
    default_target: True
    input:
        figure_files(),
        caption_files(),
        result("claims.md"),
        result("checked.txt"),
    localrule: True
    message:
        "All figures and claims are up to date"
