"""Motions of initial conditions on several conveyors, in batches and in any order."""

import numpy as np
import pytest

from pipeline import grid, motions

SETTINGS = {
    "axes": {"acceleration": [40.0, 53.0, 80.0], "z0": {"start": 0.0, "stop": 4e-4, "num": 9}},
    "settling": 4000,
    "tolerance": 1e-8,
}


@pytest.fixture(scope="module")
def starts():
    return grid.product(SETTINGS["axes"], {})[1]


@pytest.fixture(scope="module")
def labels(starts):
    return motions.motions(starts, SETTINGS)


def equal(found, other) -> bool:
    return all(np.array_equal(one, two, equal_nan=one.dtype.kind == "f") for one, two in zip(found, other, strict=True))


def test_all_states_are_there(labels):
    assert {"first", "second", "chaos"} <= set(labels.state)


@pytest.mark.parametrize("conveyors", [1, 2])
def test_labels_do_not_depend_on_batches(monkeypatch, starts, labels, conveyors):
    monkeypatch.setattr(motions, "CONVEYORS", conveyors)
    assert len(motions.batches_by_conveyor(starts)) == -(-3 // conveyors)
    assert equal(motions.motions(starts, SETTINGS, threads=2), labels)


def test_labels_do_not_depend_on_the_order_of_initial_conditions(monkeypatch, starts, labels):
    monkeypatch.setattr(motions, "CONVEYORS", 1)
    order = np.random.default_rng(1).permutation(len(starts))
    found = motions.motions(starts[order], SETTINGS)
    assert equal(found, [column[order] for column in labels])


@pytest.mark.parametrize(("count", "settling", "sets"), [(9, 4000, 1), (9, 3000, 0), (7, 20_000, 0)])
def test_attractors_are_searched_if_that_saves_time(count, settling, sets):
    """One conveyor in chaos: a few initial conditions, or short runs, are followed one by one."""
    row = grid.product({"acceleration": [80.0]}, {})[1]
    found = motions.shared_attractors(row, count, {"settling": settling, "tolerance": 1e-8})
    assert (len(found.chaotic.low), len(found.orbits.periods)) == (sets, 0)
