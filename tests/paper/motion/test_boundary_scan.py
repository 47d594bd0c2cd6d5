"""Edges of basins over z0: made-up states with known edges, and the paper's two critical heights."""

import math

import numpy as np
import pytest

from conveyor.analysis.attractors import labels
from conveyor_pipeline.common import grid
from conveyor_pipeline.paper.motion import boundary_scan

HEIGHTS = np.linspace(0.0, 5e-4, 51)


def conveyors(*accelerations):
    return grid.product({"acceleration": list(accelerations)}, {})[1]


def monotone(rows):
    """The first state below z0 = 4 mm m/s² / â."""
    return np.where(rows["z0"] < 4e-3 / rows["acceleration"], "first", "second")


def striped(rows):
    """First, second, first again, chaos; the edges are at 0.1, 0.2 and 0.333 mm."""
    return np.array(["first", "second", "first", "chaos"])[np.searchsorted([1e-4, 2e-4, 1e-3 / 3.0], rows["z0"])]


def test_a_single_edge_is_bracketed_to_the_resolution():
    accelerations = np.array([20.0, 33.3, 77.0])
    for resolution in (1e-6, 1e-9, 1e-12):
        found = boundary_scan.find_crossings(conveyors(*accelerations), HEIGHTS, monotone, resolution)
        np.testing.assert_array_equal(found.point, [0, 1, 2])
        short = 4e-3 / accelerations - found.height
        assert ((short > 0.0) & (short <= resolution)).all()
        assert (found.below == "first").all() and (found.above == "second").all()


def test_every_stripe_is_reported_and_the_lowest_end_of_the_first_state_is_critical():
    found = boundary_scan.find_crossings(conveyors(30.0, 40.0), HEIGHTS, striped, 1e-9)
    np.testing.assert_array_equal(found.point, [0, 0, 0, 1, 1, 1])
    np.testing.assert_allclose(found.height, np.tile([1e-4, 2e-4, 1e-3 / 3.0], 2), atol=1e-9)
    assert list(found.above[:3]) == ["second", "first", "chaos"]
    np.testing.assert_array_equal(boundary_scan.select_critical(found.point, found.below), [True, False, False] * 2)


def test_a_start_in_the_second_state_is_not_critical():
    found = boundary_scan.find_crossings(
        conveyors(30.0), HEIGHTS, lambda rows: np.where(rows["z0"] < 2e-4, "second", "first"), 1e-9
    )
    assert len(found.point) == 1 and not boundary_scan.select_critical(found.point, found.below).any()


def test_a_third_state_inside_an_interval_takes_the_place_of_the_state_above():
    def decide(rows):
        return np.where(rows["z0"] < 1.04e-4, "first", np.where(rows["z0"] < 1.08e-4, "undecided", "second"))

    found = boundary_scan.find_crossings(conveyors(30.0), HEIGHTS, decide, 1e-9)
    np.testing.assert_allclose(found.height, 1.04e-4, atol=1e-9)
    assert list(found.above) == ["undecided"]


def test_one_state_everywhere_has_no_crossing():
    found = boundary_scan.find_crossings(conveyors(30.0, 40.0), HEIGHTS, lambda rows: np.full(len(rows), "first"), 1e-9)
    assert len(found.point) == 0 and len(boundary_scan.select_critical(found.point, found.below)) == 0


def test_only_some_of_many_changes_are_located(monkeypatch):
    """Chaos below 0.4 mm with a label of its own for each height; the first state ends above it."""

    def decide(rows):
        noise = np.where((rows["z0"] * 1e5).round() % 2 == 0, "chaos", "undecided")
        return np.where(rows["z0"] < 4e-4, noise, np.where(rows["z0"] < 4.53e-4, "first", "second"))

    decided = []
    monkeypatch.setattr(boundary_scan, "MOST", 4)
    found = boundary_scan.find_crossings(
        conveyors(30.0, 40.0), HEIGHTS, lambda rows: decided.append(len(rows)) or decide(rows), 1e-9
    )
    assert len(found.point) == 2 * 41
    own = found.point == 0
    np.testing.assert_array_equal(np.flatnonzero(found.located[own]), [0, 1, 2, 40])
    np.testing.assert_allclose(found.height[own][-1], 4.53e-4, atol=1e-9)
    np.testing.assert_array_equal(found.height[own][3:40], HEIGHTS[3:40])
    assert max(decided[1:]) == 2 * 4
    halvings = math.ceil(math.log2(np.diff(HEIGHTS).max() / 1e-9))
    assert sum(decided) <= 2 * (len(HEIGHTS) + 4 * halvings) < 1.1 * sum(decided)


def test_the_paper_s_critical_heights():
    """0.13 mm at 35 m/s² and 0.07 mm at 40 m/s² (Sect. 3.2); both sides lead to different states."""
    parameters = conveyors(35.0, 40.0)
    found = boundary_scan.find_crossings(
        parameters, HEIGHTS, lambda rows: labels.classify(rows, tolerance=1e-10).state, 1e-9
    )
    np.testing.assert_array_equal(found.point, [0, 1])
    np.testing.assert_allclose(found.height, [0.13e-3, 0.07e-3], atol=0.01e-3)
    for offset, state in ((-1e-9, "first"), (2e-9, "second")):
        rows = parameters.copy()
        rows["z0"] = found.height + offset
        assert (labels.classify(rows, tolerance=1e-10).state == state).all()


@pytest.mark.parametrize("resolution", [1e-6, 1e-9])
def test_a_change_is_located_in_any_parameter(resolution):
    """The boundary of `monotone` is z0 â = 4e-3 m²/s²; the last interval has no change."""
    rows = conveyors(20.0, 40.0, 40.0)
    rows["z0"] = 1.9e-4, 1.01e-4, 2e-4
    heights = boundary_scan.locate_change(rows, "z0", 2e-5, monotone, 1e-6 * resolution)
    np.testing.assert_allclose(heights, [2e-4, 1e-4, np.nan], atol=1e-6 * resolution)
    amplitudes = boundary_scan.locate_change(rows, "acceleration", 2.0, monotone, resolution)
    np.testing.assert_allclose(amplitudes, [4e-3 / 1.9e-4, 4e-3 / 1.01e-4, np.nan], atol=resolution)


def test_bisection_ends_at_neighbouring_numbers():
    rows = conveyors(40.0)
    rows["z0"] = 1.01e-4
    (height,) = boundary_scan.locate_change(rows, "z0", 2e-5, monotone, 1e-30)
    assert height == pytest.approx(1e-4, rel=1e-15)
