"""The arguments that the config gives to findings are the arguments in their signatures."""

import inspect

import pytest
from project import read_config

from conveyor_pipeline.paper.claims.verdicts import finding_of

CLAIMS = read_config()["claims"]


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_finding_takes_the_tables_and_settings_of_its_claim(claim):
    entry = CLAIMS[claim]
    signature = inspect.signature(finding_of(entry))
    signature.bind(**dict.fromkeys([*entry["tables"], *entry.get("settings", {})]))
