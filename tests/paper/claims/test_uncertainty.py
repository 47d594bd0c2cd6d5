"""Uncertainty of the claims: the tables with tighter tolerances, and the changes that they cause."""

import json

import numpy as np
import pandas as pd
import pytest
from project import merged, read_config

from conveyor_pipeline.config import canonical, problems
from conveyor_pipeline.config.entries import by_methods, with_tighter
from conveyor_pipeline.config.tables import tighter_claims
from conveyor_pipeline.paper.claims import uncertainty
from conveyor_pipeline.paper.claims.statements import read_claims
from conveyor_pipeline.paper.claims.verdicts import REPRODUCED

CONFIG = read_config()


def tightened(overlay: dict) -> dict:
    return with_tighter(by_methods(canonical(merged(CONFIG, overlay))))


def test_only_the_tolerance_of_a_tighter_table_differs():
    config = tightened({"uncertainty": {"tighter": 100.0, "claims": ["C01"]}})
    plain, twin = (config["sweeps"][name] for name in ("amplitudes", "amplitudes.tighter"))
    assert twin == plain | {"tolerance": plain["tolerance"] / 100.0}
    assert "amplitudes_euler.tighter" not in config["sweeps"]


def test_a_missing_tolerance_is_the_default_of_the_solver():
    config = tightened({"uncertainty": {"tighter": 10.0, "claims": ["C07"]}})
    assert "tolerance" not in config["critical"]["edge"]
    assert config["critical"]["edge.tighter"]["tolerance"] == config["solver"]["tolerance"] / 10.0


def test_a_claim_about_a_fit_reads_tighter_heights():
    tables = tighter_claims(tightened({"uncertainty": {"claims": ["C09"]}}), read_claims())["C09"]["tables"]
    assert tables["converged"] == "critical/edge.tighter"
    assert tables["euler"] == "critical/edge_euler"


def test_tables_without_a_tolerance_stay():
    """A claim about first impacts, which have closed forms, reads the same table again."""
    claims = {"C01": {"tables": {"converged": "sweeps/amplitudes", "map": "impacts/map"}}}
    config = tightened({"uncertainty": {"claims": ["C01"]}})
    assert tighter_claims(config, claims)["C01"]["tables"] == {
        "converged": "sweeps/amplitudes.tighter",
        "map": "impacts/map",
    }


@pytest.mark.parametrize(
    ("overlay", "words"),
    [
        ({"tighter": 1.0}, "uncertainty.tighter = 1.0 should be more than 1"),
        ({"claims": ["C99"]}, "uncertainty.claims[0] = 'C99' is unknown; did you mean"),
    ],
)
def test_a_wrong_key_is_named(overlay, words):
    assert any(words in line for line in problems(merged(CONFIG, {"uncertainty": overlay})))


def edges(height: float) -> pd.DataFrame:
    return pd.DataFrame({"acceleration": [40.0], "z0": [height], "is_critical": [True]})


@pytest.mark.parametrize(("tighter", "same"), [(0.0721e-3, True), (0.0761e-3, False)])
def test_changes_and_verdicts_come_from_the_tighter_tables(tighter, same):
    claim = read_claims()["C07"] | {"tables": {"converged": "critical/edge.tighter", "euler": "critical/edge_euler"}}
    before = pd.DataFrame({"id": ["C07"], "verdict": [REPRODUCED], "converged": [[0.072]]})
    read = [edges(0.071e-3), edges(tighter)]
    found = json.loads(
        uncertainty.make({"claims": {"C07": claim}}, ["critical/edge_euler", "critical/edge.tighter"], read, before)
    )["C07"]
    assert found["changes"] == [pytest.approx(abs(1e3 * tighter - 0.072))]
    assert found["same_verdict"] is same


def test_a_missing_number_has_no_change():
    assert uncertainty.differences([1.0, np.nan], [1.5, 2.0]) == [0.5, None]
