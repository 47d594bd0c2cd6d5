"""Fastest drives with and without a second harmonic: searches with known answers, and the page."""

import numpy as np
import pandas as pd
import pytest
from project import ROOT, si_config

from docs import second_harmonic_page
from operating import drive, second_harmonic
from workflow.config.tables import TABLES

SETTINGS = TABLES["operating/second_harmonic"](si_config())
TEMPLATE = (ROOT / "workflow/templates/second_harmonic.md").read_text()
BEST = [50.0, 0.4, 0.2]


def searched(monkeypatch, gain: float, **measures: float) -> pd.DataFrame:
    """The table where drives at BEST are fastest, and a second harmonic of 50 % changes their velocity by a share."""

    def evaluate(designs, settings, errors):
        away = ((designs[:, 1:4] - BEST) / [20.0, 0.6, 3.0]) ** 2
        velocity = 0.1 - 0.1 * away.sum(axis=1)
        if designs.shape[1] == 6:
            velocity += 0.1 * gain * (1.0 - (designs[:, 4] / 0.5 - 1.0) ** 2)
        outcome = {"velocity": velocity, "velocity_50": velocity + 0.01, "displacement": 1e-4}
        outcome |= {"back": 0.0, "failed": 0, "impact_speed": 0.1, **measures}
        return pd.DataFrame(outcome, index=range(len(designs)))

    for module in (drive, second_harmonic):
        monkeypatch.setattr(module, "evaluate", evaluate)
    table = second_harmonic.make(SETTINGS, threads=2)
    table.attrs = SETTINGS
    return table


def page_of(table: pd.DataFrame) -> str:
    return second_harmonic_page.make(TEMPLATE, table)


@pytest.mark.parametrize(("gain", "answer"), [(0.2, "Yes, "), (-0.2, "No: ")])
def test_the_fastest_drives_are_found(monkeypatch, gain, answer):
    table = searched(monkeypatch, gain)
    assert len(table) == 12 and table.within.all() and table.settled.all()
    assert table[list(drive.SEARCHED[1:])].to_numpy() == pytest.approx(np.tile(BEST, (12, 1)), rel=0.05)
    pure, other = (table[table.kind == kind] for kind in second_harmonic.KINDS)
    assert pure.velocity_05.to_numpy() == pytest.approx(0.1, rel=1e-3)
    assert (pure.harmonic_share == 0.0).all()
    if gain > 0.0:
        assert other.velocity_05.to_numpy() == pytest.approx(0.12, rel=1e-3)
        assert other.harmonic_share.to_numpy() == pytest.approx(0.5, rel=0.05)
    else:
        assert other.velocity_05.to_numpy() == pytest.approx(0.1, rel=1e-3)
    page = page_of(table)
    assert page.splitlines()[2].startswith(answer)
    assert page.count("| pure |") == page.count("| with a second harmonic |") == 2
    assert "no search became faster" in page


def test_both_kinds_have_the_same_peak_acceleration():
    points = np.array([[50.0, 0.3, 0.0, 0.4, 0.7], [45.0, 0.2, 0.1, 1.0, -3.0]])
    for designs in (second_harmonic.designs_at(40.0, points), second_harmonic.designs_at(40.0, points[:, :3])):
        assert drive.peak_acceleration(designs) == pytest.approx([40.0, 40.0])
    assert (designs[:, 0] == 40.0).all()


def test_drives_beyond_a_constraint_are_not_compared(monkeypatch):
    table = searched(monkeypatch, 0.2, impact_speed=0.9)
    assert not table.within.any()
    page = page_of(table)
    assert page.splitlines()[2].startswith("Not known: ") and "| none | none | not known | not known |" in page


def test_a_search_without_a_confirmed_drive_does_not_count(monkeypatch):
    table = searched(monkeypatch, 0.2)
    table.loc[table.index[0], ["within", "velocity_05"]] = False, 9.0
    page = page_of(table)
    assert page.splitlines()[2].startswith("Yes, ") and "In 1 of 12 searches, none of these drives keeps" in page
    table.loc[table.index[1], "within"] = False
    assert "| not known | not known |" in page_of(table)


def test_a_search_that_still_grows_is_pointed_out(monkeypatch):
    table = searched(monkeypatch, 0.2)
    unsettled = table.assign(settled=table.seed != 2)
    unsettled.attrs = SETTINGS
    assert "**In 4 of 12 searches**" in page_of(unsettled)


def test_a_drive_within_the_constraints_costs_less_than_any_other():
    rows = {"back": [0.0, 0.5], "failed": 0, "velocity": [0.03, 9.0], "impact_speed": 0.1, "displacement": 1e-4}
    costs = second_harmonic.costs(pd.DataFrame(rows), SETTINGS)
    assert costs[0] == -0.03 and costs[1] > 0.0
