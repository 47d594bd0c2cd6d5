import os

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

from workflow.config import ROOT, ConfigError, load_config

min_version("9.27")

STAGES = (
    *("sweeps", "motion", "orbits", "dimensions", "fit", "sensitivity", "operating"),
    *("accuracy", "identification", "figures", "claims", "docs"),
)
# The config of the paper. Snakemake's `config` holds what --configfile and --config say, which overrides it.
CONFIG_FILES = [os.path.relpath(ROOT / f"config/{name}.yaml") for name in ("config", *STAGES)]

try:
    # Jobs start Snakemake again: by then the config has been checked.
    loaded = load_config(CONFIG_FILES, workflow.overwrite_configfiles, config, check=workflow.is_main_process)
except ConfigError as error:
    raise WorkflowError(error)
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
