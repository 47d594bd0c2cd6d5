"""Motions of initial conditions on several conveyors, in batches and in any order."""

import numpy as np
import pytest

from conveyor_pipeline.common import grid, labelling

SETTINGS = {
    "axes": {"acceleration": [40.0, 53.0, 80.0], "z0": {"start": 0.0, "stop": 4e-4, "num": 9}},
    "settling": 4000,
    "tolerance": 1e-8,
}


def equal(found, other) -> bool:
    return all(np.array_equal(found[name], other[name], equal_nan=found[name].dtype.kind == "f") for name in found)


@pytest.mark.parametrize(("count", "settling", "sets"), [(9, 4000, 1), (9, 3000, 0), (7, 20_000, 0)])
def test_attractors_are_searched_if_that_saves_time(count, settling, sets):
    """One conveyor in chaos: a few initial conditions, or short runs, are followed one by one."""
    row = grid.product({"acceleration": [80.0]}, {})[1]
    found = labelling.shared_attractors(row, count, SETTINGS | {"settling": settling})
    assert (len(found.chaotic.low), len(found.orbits.periods)) == (sets, 0)


def test_a_search_ends_at_the_limit_and_says_so():
    """At 73 m/s², chaos is a transient of thousands of cycles."""
    axes = {"psi0": {"start": 0.0, "stop": 6.0, "num": 20}, "z0": {"start": 0.0, "stop": 5e-4, "num": 10}}
    settings = {"axes": axes, "settling": 500, "tolerance": 1e-6}
    starts = grid.product(axes, {"acceleration": 73.0})[1]
    found = labelling.label_entry(starts, settings)
    assert 0.5 < (found.period == 0).mean() < 1.0
    assert "undecided" in found.state
    assert (found.cycles[found.state == "undecided"] >= 500).all()
    # A part of the table, as a shard has it, and other threads.
    part = labelling.label_entry(starts[75:125], settings, threads=2)
    assert equal(part, found.select(slice(75, 125)))
