from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.configuration import problems

min_version("9.27")


configfile: "config/config.yaml"


if errors := problems(config):
    raise WorkflowError("The config cannot be used:\n" + "\n".join(errors))


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/sweeps.smk"
include: "workflow/rules/analysis.smk"
include: "workflow/rules/orbits.smk"
include: "workflow/rules/accuracy.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/companion.smk"


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
