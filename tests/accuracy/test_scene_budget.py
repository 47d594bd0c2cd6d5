"""The budget of a table: threads share what is not timed, and change nothing."""

import pandas as pd

from accuracy import scene_budget

SETTINGS = {
    "axes": {"acceleration": [30.0, 40.0, 80.0], "z0": [1.0e-4, 3.0e-4]},
    "model": {},
    "duration": 0.1,
    "method": "event",
    "tolerance": 1.0e-8,
    "settling": 200,
}
BUDGET = {
    "points": {"sweeps": 6},
    "shifts": [1.0e-11, -1.0e-11],
    "tolerances": [1.0e-4],
    "pixels": 0.01,
    "line": 0.005,
    "reasons": {},
    "shortened": {},
}


def test_values_are_known_whatever_the_threads():
    one, four = (pd.DataFrame(scene_budget.rows_of_table("sweeps/some", SETTINGS, BUDGET, n)) for n in (1, 4))
    untimed = [name for name in one if name not in ("seconds", "full_seconds", "ratio")]
    pd.testing.assert_frame_equal(one[untimed], four[untimed])
    # Every start is looked at, in every variant.
    assert (one.points == 6).all()
    assert 0.0 < one.known.iloc[0] <= 1.0
    assert set(one.variant) >= {"full model", "feeding", "half the time", "rigid part"}
