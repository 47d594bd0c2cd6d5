import os
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import min_version

# This folder comes first, so that no installed package and no package of another workflow takes the place of these.
FOLDER = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).resolve()
if not (FOLDER / "scripts/conveyor_pipeline").is_dir():
    raise WorkflowError('This Snakefile needs the files beside it; in a Git repository, name path="workflow/Snakefile"')
sys.path.insert(0, str(FOLDER / "scripts"))

from conveyor_pipeline.config import ConfigError, load_config
from conveyor_pipeline.config.files import ROOT, USER_FILE

min_version("9.27")


# The user's config. The defaults, config/defaults/, are added below.
configfile: str(USER_FILE)


# It and the files of the option --configfile are overlays. As a module of another workflow, whose Snakefile may also lie in a folder
# of this project, all that counts is the config that the other workflow passes.
OVERLAYS = []
if Path(workflow.main_snakefile).resolve() in (ROOT / "Snakefile", ROOT / "workflow/Snakefile"):
    OVERLAYS = [os.path.relpath(file) for file in (USER_FILE, *workflow.overwrite_configfiles)]
    # Values of the option --config alone, because load_config reads the files itself.
    config = dict(workflow.config_settings.config)

if set("{}") & set(os.path.relpath(ROOT)):
    raise WorkflowError(
        f"{os.path.relpath(ROOT)} has braces, which Snakemake takes for a wildcard; rename the folder, or work inside it"
    )

try:
    loaded = load_config(OVERLAYS, config)
except ConfigError as error:
    raise WorkflowError(str(error))
config = loaded.config
IS_PAPER = loaded.is_paper


report: "workflow/report/workflow.rst"


container: "conveyor.sif"


include: "workflow/rules/common.smk"
# The floors. To remove machine or study, delete its line (see CONTRIBUTING.md).
include: "workflow/rules/paper/paper.smk"
include: "workflow/rules/machine/machine.smk"
include: "workflow/rules/study/study.smk"
include: "workflow/rules/pages/pages.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/builds.smk"


rule all:
    """All that this config has. Of another conveyor, figures and claims of the paper are made by name only."""
    default_target: True
    input:
        [figure_files(), caption_files(), BUILD_RECORDS] if IS_PAPER else [],
        FLOOR_FILES,
    localrule: True
