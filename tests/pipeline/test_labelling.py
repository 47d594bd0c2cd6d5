"""Motions of initial conditions on several conveyors, in batches and in any order."""

import numpy as np
import pytest

from pipeline import grid, labelling

SETTINGS = {
    "axes": {"acceleration": [40.0, 53.0, 80.0], "z0": {"start": 0.0, "stop": 4e-4, "num": 9}},
    "settling": 4000,
    "mean_settling": 1000,
    "tolerance": 1e-8,
}


@pytest.fixture(scope="module")
def starts():
    return grid.product(SETTINGS["axes"], {})[1]


@pytest.fixture(scope="module")
def labels(starts):
    return labelling.label_entry(starts, SETTINGS)


def equal(found, other) -> bool:
    return all(np.array_equal(found[name], other[name], equal_nan=found[name].dtype.kind == "f") for name in found)


def test_all_states_are_there(labels):
    assert {"first", "second", "chaos"} <= set(labels.state)


@pytest.mark.parametrize("conveyors", [1, 2])
def test_labels_do_not_depend_on_batches(monkeypatch, starts, labels, conveyors):
    monkeypatch.setattr(labelling, "CONVEYORS", conveyors)
    assert len(labelling.batches_by_conveyor(starts)) == -(-3 // conveyors)
    assert equal(labelling.label_entry(starts, SETTINGS, threads=2), labels)


def test_labels_do_not_depend_on_the_order_of_initial_conditions(monkeypatch, starts, labels):
    monkeypatch.setattr(labelling, "CONVEYORS", 1)
    order = np.random.default_rng(1).permutation(len(starts))
    found = labelling.label_entry(starts[order], SETTINGS)
    assert equal(found, labels.select(order))


@pytest.mark.parametrize(("count", "settling", "sets"), [(9, 4000, 1), (9, 3000, 0), (7, 20_000, 0)])
def test_attractors_are_searched_if_that_saves_time(count, settling, sets):
    """One conveyor in chaos: a few initial conditions, or short runs, are followed one by one."""
    row = grid.product({"acceleration": [80.0]}, {})[1]
    found = labelling.shared_attractors(row, (1, count), SETTINGS | {"settling": settling})
    assert (len(found.chaotic.low), len(found.orbits.periods)) == (sets, 0)


AT_A_WINDOW = {
    "axes": {"psi0": {"start": 0.0, "stop": 6.0, "num": 20}, "z0": {"start": 0.0, "stop": 5e-4, "num": 20}},
    "model": {"acceleration": 73.0},
    "settling": 20_000,
    "mean_settling": 400,
    "tolerance": 1e-6,
}


@pytest.mark.parametrize(("mean", "taken"), [(1200, 1200), (400, 200)])
def test_searches_of_many_points_take_a_mean_number_of_cycles(monkeypatch, mean, taken):
    """At 73 m/s², chaos is a transient of thousands of cycles. Where hardly any search settles, half is taken."""
    starts = grid.product(AT_A_WINDOW["axes"], AT_A_WINDOW["model"])[1]
    monkeypatch.setattr(labelling, "WHOLE_MAP", 400)
    settings = {**AT_A_WINDOW, "mean_settling": mean}
    found = labelling.label_entry(starts, settings)
    assert 0.75 * taken < found.cycles.mean() < 1.25 * taken
    undecided = found.state == "undecided"
    assert 0.5 < undecided.mean() < 1.0
    assert len(set(found.cycles[undecided])) == 1
    assert (found.cycles[~undecided] <= found.cycles[undecided][0]).all()
    # A part of the table, as a shard has it, and other threads.
    part = labelling.label_entry(starts[150:250], settings, threads=2)
    assert equal(part, found.select(slice(150, 250)))


def test_searches_that_somewhat_more_cycles_complete_have_no_limit(monkeypatch):
    settings = {**AT_A_WINDOW, "mean_settling": 20_000}
    starts = grid.product(settings["axes"], settings["model"])[1][::4]
    free = labelling.label_starts(starts, settings, starts=len(starts))
    monkeypatch.setattr(labelling, "WHOLE_MAP", len(starts))
    for share, is_free in ((0.6, True), (0.2, False)):
        few = {**settings, "mean_settling": int(share * free.cycles.mean())}
        found = labelling.label_starts(starts, few, starts=len(starts))
        assert equal(found, free) == is_free
        assert ("undecided" in found.state) != is_free


def test_searches_of_few_points_and_quick_ones_have_no_limit(monkeypatch):
    settings = AT_A_WINDOW | {"model": {"acceleration": 40.0}}
    starts = grid.product(settings["axes"], settings["model"])[1]
    found = labelling.label_entry(starts, settings)
    monkeypatch.setattr(labelling, "WHOLE_MAP", 400)
    assert equal(labelling.label_entry(starts, settings), found)
    assert "undecided" not in found.state


def test_a_limit_makes_the_mean():
    assert labelling.limit_of_mean(np.array([10, 20, 1000, 5000]), 100.0) == 185
    assert labelling.limit_of_mean(np.array([300, 400]), 200.0) == 200


@pytest.mark.parametrize(
    ("model", "axes", "wanted"),
    [
        ({}, {}, 1000),
        ({"exponent": 1.5}, {}, 1000),
        ({"exponent": 1.0}, {"exponent": [1.0, 1.5]}, 1000),
        ({"exponent": 1.03}, {}, 166),
        ({}, {"exponent": {"start": 1.0, "stop": 1.5, "num": 3}}, 166),
    ],
)
def test_searches_with_slow_series_take_fewer_cycles(model, axes, wanted):
    assert labelling.mean_settling(SETTINGS | {"model": model, "axes": axes}) == wanted
