import os
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.config import ConfigError, load_config
from workflow.config.files import DEFAULT_FILES, ROOT

min_version("9.27")

# As a module of another workflow, all that counts is the config that the other workflow passes.
is_module = not Path(workflow.main_snakefile).resolve().is_relative_to(ROOT)
OVERLAYS = [] if is_module else [os.path.relpath(file) for file in workflow.overwrite_configfiles]
try:
    # Jobs start Snakemake again; the config has been checked by then.
    loaded = load_config(DEFAULT_FILES, OVERLAYS, config, check=workflow.is_main_process)
except ConfigError as error:
    raise WorkflowError(str(error))
# The same object, because Snakemake hands it to the report.
config.clear()
config.update(loaded.config)
PAPER, OWN_MACHINE, REFUSED = loaded.paper, loaded.own_machine, loaded.refused


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
        caption_files(),
        rules.claims.output,
        rules.provenance.output,
        rules.report_figures.output,
        rules.report_summary.output,
    localrule: True
    message:
        "All figures and claims are up to date"
