"""The claims: their form, their tables, and the signatures of their findings."""

import inspect
import re

import pytest
from project import read_config

from conveyor_pipeline.config.entries import ENTRIES, by_methods
from conveyor_pipeline.config.tables import references
from conveyor_pipeline.paper.claims.statements import read_claims
from conveyor_pipeline.paper.claims.verdicts import finding_of

CLAIMS = read_claims()
KEYS = ["where", "statement", "finding", "settings", "quantities", "tables"]


def is_line(value):
    return isinstance(value, str) and len(value) >= 1 and value.isprintable()


def is_number(value):
    return value is None or type(value) is float


def test_claims_are_numbered():
    assert all(re.fullmatch(r"C\d\d", name) for name in CLAIMS)
    assert set(CLAIMS) <= {f"C{number:02d}" for number in range(1, len(CLAIMS) + 2)}


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_claim_has_its_keys_in_one_order(claim):
    """Keys and their order are part of the settings of the table of claims."""
    entry = CLAIMS[claim]
    assert list(entry) == [key for key in KEYS if key in entry]
    assert entry.keys() >= set(KEYS) - {"settings"}
    assert all(map(is_line, (entry["where"], entry["statement"], entry["finding"])))
    assert entry["quantities"]
    for quantity in entry["quantities"].values():
        assert list(quantity) == ["is", "paper", "accepted", "because"]
        assert is_line(quantity["is"]) and is_number(quantity["paper"])
        assert is_line(quantity["because"]) and len(quantity["because"]) > 2


@pytest.mark.parametrize("claim", CLAIMS)
def test_an_accepted_interval_has_two_ends_in_order(claim):
    for quantity in CLAIMS[claim]["quantities"].values():
        low, high = quantity["accepted"]
        assert is_number(low) and is_number(high)
        assert (low, high) != (None, None)
        assert low is None or high is None or low <= high


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_claim_reads_entries_that_the_config_has(claim):
    tables = set(CLAIMS[claim]["tables"].values())
    assert {table for table in tables if table.startswith(ENTRIES)} <= set(references(by_methods(read_config())))


@pytest.mark.parametrize("claim", CLAIMS)
def test_a_finding_takes_the_tables_and_settings_of_its_claim(claim):
    entry = CLAIMS[claim]
    signature = inspect.signature(finding_of(entry))
    signature.bind(**dict.fromkeys([*entry["tables"], *entry.get("settings", {})]))
