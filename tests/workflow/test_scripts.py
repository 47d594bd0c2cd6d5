"""Every script can be imported without Snakemake."""

import importlib
import os

import pytest
from project import ROOT

SCRIPTS = ROOT / "scripts"
MODULES = sorted(
    ".".join(path.relative_to(SCRIPTS).with_suffix("").parts)
    for path in SCRIPTS.rglob("*.py")
    # The declarations of settings belong to the workflow, which imports them as modules of the package `scripts`.
    if path.name not in ("__init__.py", "settings.py", "table_settings.py") and "conveyor" not in path.parts
)


@pytest.mark.parametrize("name", MODULES)
def test_a_script_is_a_module(name):
    before = dict(os.environ)
    assert importlib.import_module(name)
    # Importing it does not change the settings of the process.
    assert dict(os.environ) == before
