"""Strobes and exponents at a few amplitudes where they are known."""

import numpy as np
import pandas as pd
import pytest
from project import read_config

from conveyor_pipeline.common import grid
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.paper.orbits import branches, exponents, seeds, strobes
from conveyor_pipeline.paper.orbits.limits import SIGNIFICANT

MODEL = read_config()["model"]
SETTINGS = {
    "acceleration": {"start": 70.0, "stop": 90.0, "num": 3},
    "transient": 300,
    "strobes": 16,
    "settling": 2000,
    "tolerance": 1e-10,
    "model": MODEL,
}


@pytest.fixture(scope="module")
def tables():
    """Strobes and their spectrum of exponents: rest and riding upwards, chaos at 80 m/s²."""
    still = {**SETTINGS, "acceleration": {"start": 0.0, "stop": 80.0, "num": 3}}
    points = pd.DataFrame(strobes.make(still))
    return points, pd.DataFrame(exponents.make(points, still))


def test_a_resting_part_has_the_static_penetration(tables):
    points, _ = tables
    rest = points[points.acceleration == 0.0]
    assert len(rest) == 2 * SETTINGS["strobes"]
    # Oscillations decay with -d_c/2m; after 300 cycles only rounding errors remain.
    static = (MODEL["mass"] * MODEL["gravity"] / MODEL["stiffness"]) ** (1.0 / MODEL["exponent"])
    up = rest[rest.branch == "up"]
    assert up.delta.to_numpy() == pytest.approx(np.full(len(up), static), rel=1e-6)
    assert up.period.unique().tolist() == [1]


def test_only_chaos_has_a_positive_exponent(tables):
    _, spectrum = tables
    positive = spectrum.lambda_1 > SIGNIFICANT * spectrum.stderr
    assert (positive == (spectrum.acceleration == 80.0)).all()


def test_limits_below_the_first_doubling_are_named():
    section = read_config()["orbits"]
    settings = {**section, "limits": [20.0, 45.0], "max_period": 1, "model": MODEL}
    with pytest.raises(JobError, match=r"up to 45\.\d+ m/s².*upper value of orbits\.limits"):
        branches.make(settings)


def test_seeds_are_found():
    """At 35 to 45 m/s² a part rides or jumps with the period of the excitation, and no cascade begins."""
    section = read_config()["orbits"]
    settings = {**section, "limits": [35.0, 45.0], "max_period": 1, "model": MODEL}
    settings["seeds"] = []
    found = seeds.seeds(grid.row_of(settings["model"]), settings)
    assert {orbit.period for orbit in found} == {1}
    assert {orbit.longest_flight > 0.5 for orbit in found} == {True, False}
    tables = branches.make(settings)
    assert len(set(tables["branches"]["branch"])) == 2
    assert len(tables["cascade"]["number"]) == 0


def test_a_search_without_a_stable_orbit_leaves_the_tables_empty():
    """In chaos there is no stable orbit."""
    section = read_config()["orbits"]
    settings = {**section, "limits": [79.0, 81.0], "model": MODEL}
    settings["seeds"] = []
    tables = branches.make(settings)
    assert {len(column) for table in tables.values() for column in table.values()} == {0}


def test_no_branch_is_followed_after_the_largest_number_of_orbits(monkeypatch):
    monkeypatch.setattr(branches, "MOST_ORBITS", 1)
    section = read_config()["orbits"]
    settings = {**section, "limits": [38.0, 42.0], "max_period": 1, "model": MODEL}
    tables = branches.make(settings | {"seeds": []})
    assert set(tables["branches"]["branch"]) == {0}
