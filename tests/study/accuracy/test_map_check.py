"""Points of maps by brute force: known attractors, and the criteria for a boundary and for a period."""

import numpy as np
import pandas as pd
import pytest

from conveyor import Conveyor, Start, classify, parameter_table
from conveyor_pipeline.study.accuracy import map_check


@pytest.fixture(autouse=True)
def few_cycles(monkeypatch):
    monkeypatch.setattr(map_check, "CYCLES", 1024)


def found(*starts: tuple[float, float]) -> dict:
    """The result of brute force for amplitudes (m/s²) and initial heights (m)."""
    rows = np.stack([parameter_table(Conveyor(acceleration=amplitude), Start(height)) for amplitude, height in starts])
    return map_check.brute_force(rows)


def test_the_states_of_the_paper():
    """Rest and jumps at 40 m/s², a period of two beyond the first doubling at 54.2 m/s², chaos at 80 m/s²."""
    states = found((40.0, 0.0), (40.0, 3e-4), (57.0, 3e-4), (80.0, 0.0))
    assert states["state"].tolist() == ["first", "second", "second", "chaos"]
    assert states["period"].tolist() == [1, 1, 2, 0]
    assert states["cycles"][3] == 1024
    assert np.isnan(states["exponent"][:3]).all()


def test_a_motion_without_a_period_and_without_a_positive_exponent_is_undecided(monkeypatch):
    """Close to the doubling at 54.218 m/s² jumps settle in thousands of cycles."""
    monkeypatch.setattr(map_check, "CYCLES", 256)
    states = found((54.2182, 3e-4))
    assert states["state"].tolist() == ["undecided"]
    assert states["exponent"][0] < 0.0


def test_micro_bounces_do_not_count_as_flights():
    """At 48 m/s² the plate falls faster than the part for a small part of a cycle (label of the library: first)."""
    assert found((48.0, 0.0))["state"][0] == classify(parameter_table(Conveyor(acceleration=48.0))).state == "first"


def test_boundary_points_have_a_neighbour_with_another_label():
    labels = np.array([["a", "a", "a"], ["a", "b", "a"], ["a", "a", "a"], ["a", "a", "a"]])
    near = map_check.is_near_boundary(labels)
    assert near.tolist() == [[0, 1, 0], [1, 1, 1], [0, 1, 0], [0, 0, 0]]
    random = np.random.default_rng(1)
    rows = map_check.draw_rows(near.ravel(), 8, random)
    assert near.ravel()[rows].sum() == 4
    assert len(set(rows)) == 8
    assert len(map_check.draw_rows(near.ravel(), 100, random)) == 12


def test_a_wrong_label_of_a_map_is_found():
    """A map of two points; one has the label of the other point."""
    table = pd.DataFrame({"state": ["first", "first"]})
    table.attrs = {"axes": {"acceleration": [40.0], "z0": [0.0, 3e-4]}, "model": {}}
    made = map_check.make({"maps": ["one"], "points": 2}, [table])
    assert made["label"] == ["first", "first"]
    assert made["state"].tolist() == ["first", "second"]
