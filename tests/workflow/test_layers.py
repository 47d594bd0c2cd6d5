"""The layout: each stage has one name everywhere, and a place in the order of imports."""

import re
from importlib import import_module

import pytest
from project import ROOT

from conveyor_pipeline.config.stages import SHARED, STAGES, declared


@pytest.mark.parametrize(("stage", "package"), STAGES.items())
def test_a_stage_has_one_name_everywhere(stage, package):
    floor = package.split(".")[1]
    folder = package.replace(".", "/")
    for file in (
        f"config/defaults/{floor}/{stage}.yaml",
        f"workflow/rules/{floor}/{stage}.smk",
        f"scripts/{folder}/__init__.py",
    ):
        assert (ROOT / file).is_file(), file
    assert list((ROOT / f"tests/{floor}/{stage}").glob("test_*.py"))


@pytest.mark.parametrize("mapping", ["SECTIONS", "TABLE_SETTINGS"])
def test_no_two_stages_declare_the_same_name(mapping):
    """One would silently replace the other."""
    settings = [import_module(f"{package}.settings") for package in (*STAGES.values(), *SHARED)]
    names = [name for module in settings for name in getattr(module, mapping, {})]
    assert len(names) == len(set(names)) == len(declared(mapping)) > 10


@pytest.mark.parametrize("file", sorted((ROOT / "workflow/rules").rglob("*.smk")), ids=lambda file: file.stem)
def test_rules_refer_to_files_and_not_to_other_rules(file):
    """Otherwise a module that imports some of the rules cannot be read."""
    assert not re.search(r"^use rule|\brules\.", file.read_text(encoding="utf-8"), re.MULTILINE)
