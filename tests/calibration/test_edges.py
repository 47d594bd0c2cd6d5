"""Edges: amplitudes above which initial conditions no longer lead to the first state."""

import numpy as np
import pytest

from calibration import edges
from conveyor import Conveyor, parameter_table
from conveyor.analysis.attractors.labels import classify

SCAN = np.arange(10.0, 31.0, 2.0)


@pytest.fixture(autouse=True)
def far_tongues(monkeypatch):
    """Tongues that are wider, and edges that are sharper, than those of the table."""
    monkeypatch.setattr(edges, "FURTHER", 0.1 * np.arange(1.0, 11.0))
    monkeypatch.setattr(edges, "RESOLUTION", 1e-6)


def first_below(*intervals):
    """The state at each amplitude: first within the intervals."""

    def decide(parameters):
        a = parameters["acceleration"]
        return np.where(np.any([(a > low) & (a < high) for low, high in intervals], axis=0), "first", "second")

    return decide


@pytest.mark.parametrize(
    "intervals, expected",
    [
        ([(0.0, 17.3)], 17.3),
        ([(0.0, 17.3), (17.6, 18.1)], 18.1),  # a tongue below the edge
        ([(0.0, 17.3), (17.6, 18.1), (18.8, 19.5)], 19.5),  # and another
        ([(0.0, 17.3), (17.6, 17.93)], 17.93),  # one between two amplitudes of the scan
        ([(0.0, 16.7), (16.9, 17.02), (17.31, 17.54)], 17.54),  # two of them
        ([(0.0, 17.3), (25.0, 27.0)], 17.3),  # another motion far above
        ([(0.0, 40.0)], np.nan),
        ([(0.0, 5.0)], np.nan),
    ],
)
def test_the_edge_lies_above_all_tongues(intervals, expected):
    found = edges.find_edges(np.full(1, parameter_table(Conveyor())), SCAN, first_below(*intervals))
    # The middle of its bracket.
    assert found == pytest.approx([expected], abs=0.5e-6, nan_ok=True)


def test_each_row_may_have_its_own_scan():
    rows = np.full(2, parameter_table(Conveyor()))
    scan = np.array([[17.0, 10.0], [18.0, 11.0]])
    found = edges.find_edges(rows, scan, first_below((0.0, 17.3)))
    assert found == pytest.approx([17.3, np.nan], abs=1e-6, nan_ok=True)


def test_edges_hold_for_all_angles_frictions_and_frictionless_tension():
    """States of motion depend on the vertical amplitude only, not on friction, also if the contact pulls."""
    z0 = np.array([0.0, 1e-4, 3e-4])
    for degrees, friction, tension in ((9.0, 0.3, "allow"), (15.0, 0.1, "frictionless")):
        angle = np.radians(degrees)
        rows = np.full(6, parameter_table(Conveyor(angle=angle, friction=friction, tension=tension)))
        vertical = np.full(6, parameter_table(Conveyor(angle=0.5 * np.pi)))
        a_z = np.repeat([6.2, 9.5], 3)
        rows["acceleration"], vertical["acceleration"] = a_z / np.sin(angle), a_z
        rows["z0"] = vertical["z0"] = np.tile(z0, 2)
        states = [classify(one, tolerance=1e-6).state.tolist() for one in (rows, vertical)]
        assert states[0] == states[1]
        assert {"first", "second"} == set(states[0])
        assert rows["friction"][0] == friction and vertical["angle"][0] == 0.5 * np.pi
