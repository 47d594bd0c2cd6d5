"""The script of all rules: a table has the schema of its output."""

from types import SimpleNamespace

import pytest

from conveyor_pipeline import make
from conveyor_pipeline.common import fields


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
