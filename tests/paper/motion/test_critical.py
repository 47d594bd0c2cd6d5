"""Tables of critical heights from given states."""

import numpy as np

from conveyor_pipeline.paper.motion import critical

SETTINGS = {
    "axes": {"acceleration": [30.0, 40.0]},
    "model": {"vz0": 0.0},
    "scan": {"start": 0.0, "stop": 4e-4, "num": 9},
    "settling": 2000,
}


def test_changes_are_numbered_from_below_at_each_conveyor(monkeypatch):
    """At 30 m/s² the first state ends at 0.15 mm; at 40 m/s² it also returns at 0.25 mm and ends at 0.35 mm."""

    def decide(rows, **_):
        height, stripe = rows["z0"], rows["acceleration"] == 40.0
        first = (height < 1.5e-4) | (stripe & (height > 2.5e-4) & (height < 3.5e-4))
        return np.where(first, "first", "second")

    monkeypatch.setattr(critical, "find_states", decide)
    monkeypatch.setattr(critical, "shared_attractors", lambda *_, **__: None)
    found = critical.make(SETTINGS)
    assert found["acceleration"].tolist() == [30.0, 40.0, 40.0, 40.0]
    assert found["crossing"].tolist() == [1, 1, 2, 3]
    np.testing.assert_allclose(found["z0"], [1.5e-4, 1.5e-4, 2.5e-4, 3.5e-4], rtol=0, atol=1e-9)
    assert found["state_below"].tolist() == ["first", "first", "second", "first"]
    assert found["is_critical"].tolist() == [True, True, False, False]
    assert set(found["status"]) == {"ok"}


def test_a_height_above_which_the_state_is_unknown_is_not_critical(monkeypatch):
    def decide(rows, **_):
        return np.where(rows["z0"] < 1.5e-4, "first", np.where(rows["acceleration"] == 40.0, "undecided", "second"))

    monkeypatch.setattr(critical, "find_states", decide)
    monkeypatch.setattr(critical, "shared_attractors", lambda *_, **__: None)
    found = critical.make(SETTINGS)
    assert found["state_above"].tolist() == ["second", "undecided"]
    assert found["is_critical"].tolist() == [True, False]
