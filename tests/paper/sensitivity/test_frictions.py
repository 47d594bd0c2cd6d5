"""Velocities over the friction: the static friction follows it, and the states of motion do not depend on it."""

import numpy as np
import pandas as pd
import pytest

from conveyor import Conveyor, Start, simulate
from conveyor_pipeline.paper.sensitivity import frictions

MODEL = {"static_friction": 0.4, "angle": np.radians(12.0)}


@pytest.fixture(scope="module")
def table():
    axes = {"friction": [0.1, 0.5], "acceleration": [29.0, 50.0], "z0": [0.0]}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(frictions, "AXES", axes)
        return pd.DataFrame(frictions.make({"model": MODEL}))


def test_states_do_not_depend_on_the_friction(table):
    states = table.groupby("acceleration").state.agg(set)
    assert states.to_dict() == {29.0: {"first"}, 50.0: {"second"}}


def test_the_static_friction_follows_the_friction(table):
    for row in table.itertuples():
        run = simulate(Conveyor(acceleration=row.acceleration, friction=row.friction), Start(row.z0), tolerance=1e-8)
        assert row.mean_velocity == pytest.approx(run.mean_velocity(), rel=1e-6)
