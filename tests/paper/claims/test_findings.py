"""The arguments that the config gives to findings are the arguments in their signatures."""

import inspect

import pytest
from project import read_config

from conveyor_pipeline.paper.claims.verdicts import FINDINGS

CLAIMS = read_config()["claims"]


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_finding_takes_the_tables_and_settings_of_its_claim(claim):
    entry = CLAIMS[claim]
    module, function = entry["finding"].split(".")
    assert module in FINDINGS, f"add {module} to FINDINGS in scripts/conveyor_pipeline/paper/claims/verdicts.py"
    signature = inspect.signature(getattr(FINDINGS[module], function))
    signature.bind(**dict.fromkeys([*entry["tables"], *entry.get("settings", {})]))
