"""Velocities over inclination and phase shift: single runs, and where parts slide away."""

import math

import numpy as np
import pandas as pd
import pytest
from project import si_config

from conveyor import Start, simulate
from conveyor.solver.model import Conveyor
from conveyor_pipeline.machine.operating import track

SETTINGS = {
    **{key: value for key, value in si_config()["operating"].items() if key != "resolution"},
    **si_config()["track"],
    "settling": 2000,
    "model": {"friction": 0.15},
}


def make(**settings) -> pd.DataFrame:
    return pd.DataFrame(track.make({**SETTINGS, **settings})).set_index(["inclination", "state", "phase_shift"])


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    return make(inclination=[-0.2, 0.0, 0.05, 0.2], phase_shift=[0.0, 1.0])


@pytest.mark.parametrize(("inclination", "phase_shift"), [(0.0, 0.0), (0.05, 0.0), (0.0, 1.0)])
def test_velocities_agree_with_single_runs(table, inclination, phase_shift):
    conveyor = Conveyor(acceleration=40.0, inclination=inclination, phase_shift=phase_shift)
    for state, height in (("first", 0.0), ("second", 3e-4)):
        alone = simulate(conveyor, Start(height), duration=4.0).mean_velocity()
        assert table.mean_velocity[inclination, state, phase_shift] == pytest.approx(alone, abs=3e-5)


def test_a_track_steeper_than_friction_holds_has_no_velocity(table):
    steep = table.loc[[-0.2, 0.2]]
    assert math.tan(0.2) > 0.15
    assert (steep.status == track.SLIDES_AWAY).all()
    assert steep.mean_velocity.isna().all()
    assert np.isfinite(table.drop(index=[-0.2, 0.2], level=0).mean_velocity).all()


def test_velocities_settle_on_tracks_that_are_nearly_too_steep():
    """A part in the second state gains speed for a thousand cycles; then it is as fast as on a level track."""
    steep = 0.1483
    assert 0.149 > math.atan(0.15) > steep
    found = make(inclination=[steep], phase_shift=[0.0]).mean_velocity[steep, "second", 0.0]
    x = simulate(Conveyor(acceleration=40.0, inclination=steep), Start(3e-4), duration=60.0).sample(
        np.array([50.0, 60.0])
    )["x"]
    assert found == pytest.approx((x[1] - x[0]) / 10.0, abs=2e-3)


def test_static_friction_does_not_stop_a_part_that_slides():
    """At 40 m/s² parts slide, and friction takes less than the slope gives: g (sin α - μ cos α) is 0.5 m/s²."""
    steep = {"friction": 0.15, "static_friction": 0.3}
    found = make(inclination=[0.2], phase_shift=[0.0], model=steep)
    assert (found.status == track.SLIDES_AWAY).all()
    run = simulate(Conveyor(acceleration=40.0, inclination=0.2, **steep), Start(3e-4), duration=20.0)
    assert run.vx_end == pytest.approx(-20.0 * 9.81 * (math.sin(0.2) - 0.15 * math.cos(0.2)), rel=0.01)


def test_a_part_that_slides_slowly_on_a_nearly_steep_track_is_found():
    """It gains 0.02 m/s in each second, which the plate's 0.125 m/s hide for a while."""
    found = make(inclination=[0.151], phase_shift=[0.0], model={"friction": 0.15, "static_friction": 0.3})
    assert found.status[0.151, "second", 0.0] == track.SLIDES_AWAY


def test_a_state_is_not_ruled_out_where_the_search_ended_early():
    """Parts in the first state settle within eight cycles, parts in the second state do not."""
    found = make(inclination=[0.0], phase_shift=[0.0], settling=8)
    assert list(found.status) == ["ok", "not all initial conditions settled"]
    assert list(found.mean_velocity.isna()) == [False, True]
