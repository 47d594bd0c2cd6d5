"""Impacts: states of initial conditions, and of their first impacts on the plate."""

import numpy as np

from conveyor.analysis.basins.first_impact import first_impacts, on_conveyor
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.labelling import label_entry
from conveyor_pipeline.paper.motion import impacts

SETTINGS = {
    "axes": {"acceleration": [40.0, 53.0], "z0": [-1.0e-3, 0.5e-4, 1.0e-4, 2.0e-4, 3.0e-4]},
    "model": {},
    "settling": 1000,
}


def test_states_equal_the_states_of_single_runs():
    made = impacts.make(SETTINGS, threads=2)
    _, parameters = grid.product(SETTINGS["axes"], SETTINGS["model"])
    found = first_impacts(parameters)
    mapped = np.isfinite(found.time)
    assert 0 < np.count_nonzero(mapped) < len(parameters)
    alone = label_entry(parameters, SETTINGS).state
    images = label_entry(on_conveyor(parameters, found)[mapped], SETTINGS).state
    assert made["state"].tolist() == alone.tolist()
    assert made["mapped_state"][mapped].tolist() == images.tolist()
    assert made["mapped_state"][~mapped].tolist() == [None] * np.count_nonzero(~mapped)
    assert len(set(alone)) > 1
