"""The layout: each stage has one name everywhere, and later stages import earlier ones, never the reverse."""

import re

import pytest
from project import ROOT, STAGES

from scripts.pipeline import source_hash
from scripts.pipeline.imports import direct_imports

# Packages of the library, lowest first; `conveyor` itself has the functions on top of solver and methods.
# The module `parameters` imports nothing, and `arguments` imports `parameters` only: both are below all packages.
ROOMS = (
    "conveyor.solver",
    "conveyor.methods",
    "conveyor",
    "conveyor.analysis",
    "conveyor.certificates",
    "conveyor.interface",
)
FLOORS = ("conveyor.parameters", "conveyor.arguments", *ROOMS, "pipeline", *STAGES, "builds", "report", "")


def layer_of(module: str) -> int:
    """The layer of a module; the two scripts are above all stages."""
    package = module if module in FLOORS else module.rpartition(".")[0]
    while package not in FLOORS:
        package = package.rpartition(".")[0]
    return FLOORS.index(package)


MODULES = {
    ".".join(path.relative_to(source_hash.SCRIPTS).with_suffix("").parts): path
    for path in source_hash.SCRIPTS.rglob("*.py")
    if path.name != "__init__.py"
}


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_downwards(module):
    files, _ = direct_imports(MODULES[module], source_hash.SCRIPTS)
    for file in files:
        used = ".".join(file.relative_to(source_hash.SCRIPTS).with_suffix("").parts)
        if not used.endswith("__init__"):
            assert layer_of(used) <= layer_of(module), f"{module} imports {used}"


@pytest.mark.parametrize("stage", STAGES)
def test_a_stage_has_one_name_everywhere(stage):
    for file in (f"config/{stage}.yaml", f"workflow/rules/{stage}.smk", f"scripts/{stage}/__init__.py"):
        assert (ROOT / file).is_file(), file
    assert list((ROOT / f"tests/{stage}").glob("test_*.py"))


def test_no_script_has_the_name_of_a_module_of_the_library():
    library = {module.rpartition(".")[2] for module in MODULES if module.startswith("conveyor")}
    # Plots have the names of their figures.
    others = {module.rpartition(".")[2] for module in MODULES if not module.startswith(("conveyor", "figures.plots"))}
    assert not library & others


@pytest.mark.parametrize("file", sorted((ROOT / "workflow/rules").glob("*.smk")), ids=lambda file: file.stem)
def test_rules_refer_to_files_and_not_to_other_rules(file):
    """Otherwise a module that imports some of the rules cannot be read."""
    assert not re.search(r"^use rule|\brules\.", file.read_text(encoding="utf-8"), re.MULTILINE)
