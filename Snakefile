import os
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.config import ConfigError, load_config
from workflow.config.files import DEFAULT_FILES, ROOT, STAGES

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


for stage_name in (*STAGES, "builds", "report"):

    include: f"workflow/rules/{stage_name}.smk"


rule all:
    default_target: True
    input:
        figure_files(),
        caption_files(),
        result("claims.md"),
        result("provenance.json"),
        [result("checked.txt")] if CHECKS_RESULTS else [],
        [report_file(name) for name in (*REPORT_PAGES, "summary", "claims", "provenance")],
    localrule: True
    message:
        "All figures and claims are up to date"
