"""The house: each stage is a column, and imports point from later stages to earlier ones, never the other way."""

import pytest
from project import ROOT, STAGES

from scripts.pipeline import source_hash
from scripts.pipeline.imports import direct_imports

# Rooms of the library, from the ground up; `conveyor` itself has what leads to solver and methods: simulate, ensembles.
# The module `parameters` imports nothing and stands below them.
ROOMS = (
    "conveyor.solver",
    "conveyor.methods",
    "conveyor",
    "conveyor.analysis",
    "conveyor.certificates",
    "conveyor.interface",
)
FLOORS = ("conveyor.parameters", *ROOMS, "pipeline", *STAGES, "builds", "report", "")


def floor_of(module: str) -> int:
    """The floor on which a module stands; the two scripts stand on top of all."""
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
            assert floor_of(used) <= floor_of(module), f"{module} imports {used}"


@pytest.mark.parametrize("stage", STAGES)
def test_a_stage_has_its_name_everywhere(stage):
    for file in (f"config/{stage}.yaml", f"workflow/rules/{stage}.smk", f"scripts/{stage}/__init__.py"):
        assert (ROOT / file).is_file(), file
    assert list((ROOT / f"tests/{stage}").glob("test_*.py"))


def test_no_script_has_the_name_of_a_module_of_the_library():
    library = {module.rpartition(".")[2] for module in MODULES if module.startswith("conveyor")}
    # Plots have the names of their figures.
    others = {module.rpartition(".")[2] for module in MODULES if not module.startswith(("conveyor", "figures.plots"))}
    assert not library & others
