"""The budget of tables does not depend on threads."""

import pandas as pd
import pytest

from conveyor import Conveyor
from conveyor_pipeline.study.accuracy import scene_budget, theory

SETTINGS = {
    "axes": {"acceleration": [30.0, 40.0, 80.0], "z0": [1.0e-4, 3.0e-4]},
    "model": {"stiffness": 1.0e5, "damping": 0.3, "exponent": 1.5},
    "duration": 0.1,
    "method": "event",
    "tolerance": 1.0e-8,
    "settling": 200,
}
BUDGET = {
    "points": {"sweeps": 6},
    "reasons": {},
}


@pytest.mark.parametrize("speed", [0.02, 0.5])
@pytest.mark.parametrize("exponent", [1.0, 1.5])
def test_a_practically_rigid_part_bounces_as_high_in_nearly_no_time(exponent, speed):
    soft = {"exponent": exponent, "stiffness": 1e5, "damping": 0.5}
    found, hard = (theory.simulate_impact(Conveyor(**model), speed) for model in (soft, scene_budget.harden(soft)))
    assert 0.1 < found.restitution < 0.95
    assert hard.restitution == pytest.approx(found.restitution, rel=1e-9)
    assert hard.duration < 0.005 * found.duration


ENTRIES = {"sweeps/some": SETTINGS, "sweeps/other": SETTINGS | {"duration": 0.2}}


def test_budgets_do_not_depend_on_threads():
    drawn = {"fig": ["sweeps/other"], "schematic": [], "last": ["sweeps/some"]}
    one, three = (scene_budget.make(BUDGET, ENTRIES, drawn, threads=n) for n in (1, 3))
    pd.testing.assert_frame_equal(pd.DataFrame(one["scene_budget"]), pd.DataFrame(three["scene_budget"]))
    times, others = (pd.DataFrame(made["budget_times"]) for made in (one, three))
    assert times.table.unique().tolist() == list(ENTRIES)
    pd.testing.assert_frame_equal(times[["table", "variant"]], others[["table", "variant"]])
    # The time of one thread, independent of other threads.
    assert (times.seconds > 0.0).all()
    assert 0.3 < (others.seconds / times.seconds).median() < 3.0


def test_every_initial_condition_is_compared_in_every_variant():
    one = pd.DataFrame(scene_budget.rows_of_table("sweeps/some", SETTINGS, BUDGET))
    assert (one.points == 6).all()
    assert 0.0 < one.known.iloc[0] <= 1.0
    assert set(one.variant) >= {"full model", "feeding", "half the time", "rigid part"}
