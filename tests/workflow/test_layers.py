"""The layout: each stage has one name everywhere, and a place in the order of imports."""

import re
import tomllib
from importlib import import_module

import pytest
from project import ROOT, STAGES

from conveyor_pipeline.common import source_hash
from conveyor_pipeline.config.stages import declared

MODULES = {
    ".".join(path.relative_to(source_hash.SCRIPTS).with_suffix("").parts): path
    for path in source_hash.SCRIPTS.rglob("*.py")
    if path.name != "__init__.py"
}


def test_every_package_has_a_place_among_the_layers():
    """So that lint-imports, which checks the imports, leaves none out."""
    linter = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    layers = next(contract["layers"] for contract in linter["contracts"] if "sweeps" in contract.get("layers", ()))
    packages = {file.parent.name for file in source_hash.SCRIPTS.glob("*/__init__.py")}
    assert packages == set(linter["root_packages"]) == set(layers)
    assert [layer for layer in reversed(layers) if layer in STAGES] == list(STAGES)


@pytest.mark.parametrize("stage", STAGES)
def test_a_stage_has_one_name_everywhere(stage):
    for file in (f"config/defaults/{stage}.yaml", f"workflow/rules/{stage}.smk", f"scripts/{stage}/__init__.py"):
        assert (ROOT / file).is_file(), file
    assert list((ROOT / f"tests/{stage}").glob("test_*.py"))


@pytest.mark.parametrize("mapping", ["SECTIONS", "TABLE_SETTINGS"])
def test_no_two_stages_declare_the_same_name(mapping):
    """One would silently replace the other."""
    settings = [import_module(f"scripts.{stage}.settings") for stage in STAGES]
    names = [name for module in settings for name in getattr(module, mapping, {})]
    assert len(names) == len(set(names)) == len(declared(mapping)) > 10


def test_no_script_has_the_name_of_a_module_of_the_library():
    library = {module.rpartition(".")[2] for module in MODULES if module.startswith("conveyor")}
    # Plots have the names of their figures.
    others = {module.rpartition(".")[2] for module in MODULES if not module.startswith(("conveyor", "figures.plots"))}
    assert not library & others


@pytest.mark.parametrize("file", sorted((ROOT / "workflow/rules").glob("*.smk")), ids=lambda file: file.stem)
def test_rules_refer_to_files_and_not_to_other_rules(file):
    """Otherwise a module that imports some of the rules cannot be read."""
    assert not re.search(r"^use rule|\brules\.", file.read_text(encoding="utf-8"), re.MULTILINE)
