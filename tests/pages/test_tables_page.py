"""The page of tables has every table of every stage, with the path that the workflow uses."""

import re

from project import ROOT, si_config

from conveyor_pipeline.config.stages import STAGES
from conveyor_pipeline.config.tables import kind_of, references
from conveyor_pipeline.pages import tables_page

SCRIPTS = ROOT / "scripts"


def test_every_module_with_tables_is_listed():
    files = [file for file in SCRIPTS.rglob("*.py") if re.search(r"^TABLES = \{", file.read_text(), re.MULTILINE)]
    found = {".".join(file.relative_to(SCRIPTS).with_suffix("").parts) for file in files}
    assert {module.__name__ for package in STAGES.values() for module in tables_page.modules_of(package)} == found


def test_paths_are_the_paths_of_the_workflow():
    tables = [(stage, module.TABLES) for stage, package in STAGES.items() for module in tables_page.modules_of(package)]
    shown = {tables_page.file_of(kind, kinds, stage) for stage, kinds in tables for kind in kinds}
    for reference in references(si_config()):
        folder, name = reference.split("/")
        file = f"results/{name}.parquet" if folder == "results" else f"results/{folder}/{name}.parquet"
        # Entries of the config, and scenes, have names of the user's choice.
        assert {file, f"results/{kind_of(reference)}/NAME.parquet"} & shown, reference


def test_columns_have_units_and_meanings():
    page = tables_page.make((ROOT / "workflow/rules/pages/tables.md").read_text(encoding="utf-8"))
    assert "| `mean_velocity` | m/s | mean feeding velocity over the last quarter" in page
    assert "| `z0` | m |" in page
