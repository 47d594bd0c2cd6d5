"""Drive design: single designs against the operating table, constraints, fronts with known members, and the page."""

import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT, read_config

from operating import drive, drive_page, shares

CONFIG = read_config("operating")
SETTINGS = {
    **{key: value for key, value in CONFIG["operating"].items() if key not in ("acceleration", "resolution")},
    **CONFIG["drive"],
    **{"settling": 2000, "model": {"friction": 0.15}, "starts": 33, "followed": 2, "cycles": 50},
}
PAPER = [50.0, math.radians(12.0), 0.0]


@pytest.fixture(scope="module")
def outcome() -> pd.DataFrame:
    """One velocity at 22 m/s², two at 40 m/s²."""
    return drive.evaluate(np.array([[22.0, *PAPER], [40.0, *PAPER]]), SETTINGS)


def test_designs_have_the_outcomes_of_the_operating_table(outcome):
    table = shares.motions_at(np.array([22.0, 40.0]), SETTINGS)
    one, two = (table[table.acceleration == acceleration] for acceleration in (22.0, 40.0))
    assert outcome.velocity[0] == pytest.approx(one.mean_velocity.iloc[0], rel=1e-6)
    assert outcome.velocity[1] == pytest.approx(two.mean_velocity[two.share.idxmax()], rel=1e-6)
    assert outcome.share.tolist() == [1.0, two.share.max()]
    assert outcome["mean"][1] == pytest.approx((two.share * two.mean_velocity).sum())
    # Two velocities with a share p: the standard error is that of a binomial share times their difference.
    p, difference = two.share.iloc[0], np.ptp(two.mean_velocity)
    assert outcome.stderr[1] == pytest.approx(difference * math.sqrt(p * (1.0 - p) / SETTINGS["starts"]))
    assert outcome.displacement[1] == pytest.approx(40.0 / (100.0 * math.pi) ** 2)


def test_designs_with_two_velocities_or_too_large_a_displacement_are_refused(outcome):
    assert drive.is_within(outcome, SETTINGS).tolist() == [True, False]
    assert not drive.is_within(outcome, {**SETTINGS, "displacement": 1e-5}).any()
    assert not drive.is_within(outcome.assign(chaos=0.1), SETTINGS).any()
    assert not drive.is_within(outcome.assign(velocity=-0.01), SETTINGS).any()


def test_the_front_keeps_what_nothing_betters():
    objectives = np.array([[1.0, 2.0, 3.0], [1.0, 2.0, 4.0], [0.0, 3.0, 3.0], [1.0, 2.0, 3.0]])
    designs = np.arange(16.0).reshape(4, 4)
    kept, best = drive.best_of_designs(designs, objectives)
    assert best.tolist() == [[0.0, 3.0, 3.0], [1.0, 2.0, 3.0]]
    assert kept.tolist() == designs[[2, 0]].tolist()
    assert drive.hypervolume(best[1:], np.array([2.0, 4.0, 6.0])) == pytest.approx(1.0 * 2.0 * 3.0)
    assert drive.hypervolume(np.empty((0, 3)), np.ones(3)) == 0.0


def test_settings_are_spread_over_the_velocities():
    assert drive.spread(np.array([5.0, 1.0, 3.0, 2.0, 4.0]), 3).tolist() == [1, 2, 0]
    assert drive.spread(np.array([5.0, 1.0]), 5).tolist() == [1, 0]
    assert drive.spread(np.empty(0), 5).tolist() == []


@pytest.fixture
def made(monkeypatch) -> dict[str, pd.DataFrame]:
    """A search whose outcomes are closed forms: velocity and impact speed grow with the amplitude and the angle."""

    def evaluate(x, settings, *, threads=1):
        velocity = x[:, 0] * np.sin(2.0 * x[:, 2]) * np.cos(x[:, 3])
        outcome = {"velocity": velocity, "mean": velocity, "impact_speed": x[:, 0] * np.sin(x[:, 2]) / 100.0}
        fixed = {"stderr": 0.1, "share": 1.0, "chaos": 0.0, "most": 0}
        return pd.DataFrame(outcome).assign(**fixed, displacement=x[:, 0] / (2.0 * np.pi * x[:, 1]) ** 2)

    monkeypatch.setattr(drive, "evaluate", evaluate)
    found = drive.make({**SETTINGS, "population": 40, "generations": 40})
    return {name: pd.DataFrame(columns) for name, columns in found.items()}


def test_a_search_with_known_outcomes_finds_their_front(made):
    """No phase shift is best, and no flat angle above 45° can be."""
    front = made["drive_front"]
    assert front.phase_shift.abs().median() < 0.1
    assert (front.displacement <= SETTINGS["displacement"]).all()
    assert front.acceleration.max() <= SETTINGS["bounds"]["acceleration"][1]
    assert front.recommended.sum() == SETTINGS["recommended"]
    assert front.checked.sum() == SETTINGS["checked"]
    assert drive_page.last_growth(made["drive_generations"]) < 0.05
    for _, rows in made["drive_generations"].groupby("seed"):
        assert (np.diff(rows.hypervolume) >= -1e-12).all()
        assert rows.hypervolume.iloc[-1] <= 1.0 + 1e-12


def test_the_page_lists_the_recommended_settings(made):
    template = (ROOT / "workflow/templates/drive.md").read_text()
    made["drive_front"].attrs = SETTINGS
    page = drive_page.make(template, made["drive_front"], made["drive_generations"])
    assert page.count(" ± 0.2 |") == SETTINGS["recommended"]
    none = made["drive_front"].assign(recommended=False, confirmed=False)
    assert "No design of the search was confirmed" in drive_page.make(template, none, made["drive_generations"])
