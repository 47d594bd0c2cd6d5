"""Every script can be imported without Snakemake; a table has the schema of its output."""

import importlib
import os
from types import SimpleNamespace

import pytest
from project import ROOT

from conveyor_pipeline import make
from conveyor_pipeline.common import fields

SCRIPTS = ROOT / "scripts"
MODULES = sorted(
    ".".join(path.relative_to(SCRIPTS).with_suffix("").parts)
    for path in SCRIPTS.rglob("*.py")
    # The declarations of settings belong to the workflow, which imports them as modules of the package `scripts`.
    if path.name not in ("__init__.py", "settings.py", "table_settings.py") and "conveyor" not in path.parts
)


@pytest.mark.parametrize("name", MODULES)
def test_a_script_is_a_module(name):
    before = {"MPLBACKEND": "agg"} | os.environ
    assert importlib.import_module(name)
    # Importing it does not change the settings of the process, except for the backend of Matplotlib.
    assert {"MPLBACKEND": "agg"} | os.environ == before


class Outputs(list):
    """One named output, as Snakemake gives it to a script."""

    def __init__(self, name, path):
        super().__init__([path])
        self.name = name

    def items(self):
        return [(self.name, self[0])]


def test_a_table_has_the_schema_of_its_output(tmp_path):
    """The only table, too: otherwise each rule that reads it would refuse it."""
    path = str(tmp_path / "other.parquet")
    stage = SimpleNamespace(TABLES={"lengths": (fields.number("length", "m", "length"),)})
    ((name, path, columns),) = make.contents(Outputs("other", path), {"length": [1.0]})
    with pytest.raises(KeyError, match="other"):
        make.write(stage, name, path, columns, {})
