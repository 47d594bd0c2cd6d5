"""Drive design: single designs and the operating table, constraints, fronts with known members, and the page."""

import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT, read_config

from operating import drive, drive_page, shares
from pipeline import pareto
from workflow.config.tables import TABLES

SETTINGS = {
    **TABLES["operating/drive_front"](read_config()),
    **{"settling": 2000, "starts": 33, "followed": 2, "cycles": 50},
}
TEMPLATE = (ROOT / "workflow/templates/drive.md").read_text()
PAPER = [50.0, math.radians(12.0), 0.0]
EXACTLY = np.zeros(1)  # no error of the amplitude


@pytest.fixture(scope="module")
def outcome() -> pd.DataFrame:
    """One velocity at 22 m/s², two at 40 m/s²."""
    return drive.evaluate(np.array([[22.0, *PAPER], [40.0, *PAPER]]), SETTINGS, EXACTLY)


def test_outcomes_of_designs_agree_with_the_operating_table(outcome):
    table = shares.motions_at(np.array([22.0, 40.0]), SETTINGS)
    one, two = (table[table.acceleration == acceleration] for acceleration in (22.0, 40.0))
    most = two.loc[two.share.idxmax()]
    assert outcome.velocity.tolist() == pytest.approx([one.mean_velocity.iloc[0], most.mean_velocity], rel=1e-6)
    assert outcome.share.tolist() == [1.0, most.share]
    assert outcome.impact_speed.tolist() == pytest.approx([one.impact_speed.iloc[0], most.impact_speed], rel=1e-6)
    assert outcome["mean"][1] == pytest.approx((two.share * two.mean_velocity).sum())
    extremes = outcome.loc[1, ["velocity_low", "velocity_high", "impact_low", "impact_high"]].to_list()
    ends = (two.mean_velocity.min(), two.mean_velocity.max(), two.impact_speed.min(), two.impact_speed.max())
    assert extremes == pytest.approx(ends)
    assert outcome.displacement[1] == pytest.approx(40.0 / (100.0 * math.pi) ** 2)


def test_velocities_of_brief_runs_agree_with_long_runs(outcome):
    designs = np.array([[22.0, *PAPER], [40.0, *PAPER]])
    few = {**SETTINGS, "followed": 1, "cycles": 60}
    brief = drive.evaluate(designs, few, EXACTLY, measure=shares.brief_velocities)
    for name in ("velocity", "velocity_low", "velocity_high"):
        np.testing.assert_allclose(brief[name], outcome[name], rtol=1e-3)
    np.testing.assert_allclose(brief.impact_speed, outcome.impact_speed, rtol=1e-3, atol=1e-9)
    assert brief.share.tolist() == outcome.share.tolist()


def test_velocities_that_differ_little_are_one():
    velocity, share = np.array([0.1, 0.2, 0.101]), np.array([0.35, 0.4, 0.25])
    found = drive.outcome_of_conveyor(velocity, share, np.array([1.0, 2.0, 3.0]), np.zeros(3, dtype=bool), 0.02)
    assert found["share"] == pytest.approx(0.6)
    assert found["velocity"] == 0.1
    assert (found["impact_speed"], found["impact_low"], found["impact_high"]) == (1.0, 1.0, 3.0)
    assert found["chaos"] == 0.0


def motions(states: list[str], velocities: list[float], counts: list[float]) -> pd.DataFrame:
    columns = {"state": states, "mean_velocity": velocities, "share": counts}
    return pd.DataFrame(columns).assign(impact_speed=0.1)


def test_undecided_motions_count_as_chaos(monkeypatch):
    table = motions(["first", "chaos", "undecided"], [0.1] * 3, [0.7, 0.2, 0.1]).assign(conveyor=0)
    monkeypatch.setattr(drive, "motions_of_conveyors", lambda *_, **__: table)
    assert drive.evaluate(np.array([[10.0, *PAPER]]), SETTINGS, EXACTLY).chaos[0] == pytest.approx(0.3)


def test_the_worst_within_the_margin_counts(monkeypatch):
    """Made-up motions from 9 to 11 m/s²: the velocity grows, the impact speed falls, chaos above 10.5."""

    def motions_of_conveyors(rows, starts, settings, **_):
        amplitudes = rows[::starts, 0]
        return pd.concat(
            motions(["first", "chaos"], [a, a], [1.0 - chaos, chaos])
            .assign(impact_speed=20.0 - a, conveyor=number)
            .query("share > 0.0")
            for number, (a, chaos) in enumerate(zip(amplitudes, np.where(amplitudes > 10.5, 0.5, 0.0), strict=True))
        )

    monkeypatch.setattr(drive, "motions_of_conveyors", motions_of_conveyors)
    found = drive.evaluate(np.array([[10.0, *PAPER]]), {**SETTINGS, "margin": 0.1}, drive.CHECK_ERRORS).iloc[0]
    assert (found.velocity, found.velocity_high, found["mean"]) == pytest.approx((9.0, 11.0, 10.0))
    assert (found.impact_speed, found.impact_low) == pytest.approx((11.0, 9.0))
    assert (found.share, found.chaos) == (1.0, 0.5)


def test_an_unknown_velocity_within_the_margin_is_refused(monkeypatch):
    def motions_of_conveyors(rows, *_, **__):
        table = motions(["first", "first", "first"], [0.1, np.nan, 0.1], [1.0, 1.0, 1.0])
        return table.assign(conveyor=[0, 1, 2], impact_speed=0.1)

    monkeypatch.setattr(drive, "motions_of_conveyors", motions_of_conveyors)
    found = drive.evaluate(np.array([[10.0, *PAPER]]), SETTINGS, drive.CHECK_ERRORS)
    assert found.velocity.isna().all()
    assert not drive.is_within(found, SETTINGS).any()


GOOD = pd.DataFrame(
    [{"share": 1.0, "chaos": 0.0, "velocity": 0.1, "impact_speed": 0.1, "displacement": 1e-4}], dtype=float
)


@pytest.mark.parametrize(
    ("name", "worst"),
    [
        *(("share", 0.98), ("chaos", 0.01), ("impact_speed", 0.61), ("displacement", 0.9e-3)),
        *(("velocity", 0.019), ("velocity", -0.1), ("velocity", np.nan)),
    ],
)
def test_each_constraint_refuses_designs(name, worst):
    assert drive.is_within(GOOD, SETTINGS).all()
    assert not drive.is_within(GOOD.assign(**{name: worst}), SETTINGS).any()


def test_points_of_one_normal_motion_have_one_normal_amplitude():
    low, high = drive.bounds_of_points(SETTINGS["bounds"])
    points = np.random.default_rng(1).uniform(low, high, (200, 4))
    points[:, 0] = 1.5
    designs = drive.designs_of(points, SETTINGS["bounds"])
    least, most = SETTINGS["bounds"]["acceleration"]
    inside = (designs[:, 0] > least) & (designs[:, 0] < most)
    assert inside.sum() > 50
    assert designs[inside, 0] * np.sin(designs[inside, 2]) == pytest.approx(math.exp(1.5))
    assert designs[:, 0].min() >= least
    assert designs[:, 0].max() <= most
    assert (designs[:, 1:] == points[:, 1:]).all()


def test_bounds_of_the_search_hold_all_designs():
    bounds = SETTINGS["bounds"]
    low, high = drive.bounds_of_points(bounds)
    for end, edge in ((0, low), (1, high)):
        corner = np.array([bounds[name][end] for name in drive.SEARCHED])
        assert drive.designs_of(edge[None], bounds)[0] == pytest.approx(corner)


def test_designs_that_violate_a_constraint_are_dropped_early(monkeypatch):
    """The first has too large a displacement, the second has too small a share with its first initial condition."""
    followed = []

    def evaluate(designs, settings, errors, **_):
        followed.append((settings["starts"], designs[:, 0].tolist()))
        table = pd.concat([GOOD] * len(designs), ignore_index=True).reindex(columns=[*drive.OVERALL, "displacement"])
        return table.assign(share=np.where(designs[:, 0] == 20.0, 0.5, 1.0))

    monkeypatch.setattr(drive, "evaluate", evaluate)
    designs = np.array([[80.0, 40.0, 0.2, 0.0], [20.0, *PAPER], [30.0, *PAPER]])
    objectives, violations = drive.search_outcomes(designs, SETTINGS)
    assert followed == [(drive.FIRST_STARTS, [20.0, 30.0]), (SETTINGS["starts"], [30.0])]
    assert (violations <= 0.0).all(axis=1).tolist() == [False, False, True]
    assert objectives[2].tolist() == [-0.1, 0.1, 30.0]


def test_settings_differ_as_much_as_they_can():
    """The fastest, then the gentlest, then the one farthest from both; units do not matter."""
    objectives = np.array([[-5.0, 9.0, 7.0], [-4.9, 8.9, 7.0], [-1.0, 0.0, 7.0], [-3.0, 4.0, 2.0], [-1.1, 0.1, 7.0]])
    for units in (np.ones(3), np.array([1e-3, 1.0, 50.0])):
        assert drive.spread(units * objectives, 3).tolist() == [0, 2, 3]
    assert sorted(drive.spread(objectives, 9)) == [0, 1, 2, 3, 4]
    assert drive.spread(objectives[:0], 5).tolist() == []


@pytest.fixture
def made(monkeypatch) -> dict[str, pd.DataFrame]:
    """A search whose outcomes are closed forms: velocity and impact speed grow with the amplitude and the angle.

    Designs above 60 m/s² are not confirmed by full runs.
    """

    def evaluate(x, settings, errors, **_):
        velocity = x[:, 0] / 400.0 * np.sin(2.0 * x[:, 2]) * np.cos(x[:, 3])
        found = {"velocity": velocity, "impact_speed": x[:, 0] * np.sin(x[:, 2]) / 100.0}
        found |= {"velocity_low": velocity, "velocity_high": velocity + 0.01, "mean": velocity + 0.005}
        found |= {"impact_low": 0.9 * found["impact_speed"], "impact_high": found["impact_speed"]}
        full = settings["starts"] == SETTINGS["starts"]
        assert (0.0 in errors) == full
        found |= {"share": np.where(full & (x[:, 0] > 60.0), 0.5, 1.0), "chaos": np.zeros(len(x))}
        return pd.DataFrame(found | {"displacement": drive.displacement(x)})

    monkeypatch.setattr(drive, "evaluate", evaluate)
    tables = drive.make({**SETTINGS, "population": 40, "generations": 40})
    tables["drive_front"].attrs = SETTINGS
    return tables


def test_a_search_with_known_outcomes_finds_their_front(made):
    """A phase shift of zero is best. Designs with full runs have the outcomes of these runs."""
    front = made["drive_front"]
    assert front.phase_shift.abs().median() < 0.1
    assert (front.displacement <= SETTINGS["displacement"]).all()
    assert front.velocity.min() >= SETTINGS["velocity"]
    assert front.impact_speed.max() <= SETTINGS["impact_speed"]
    assert front.checked.sum() == SETTINGS["checked"]
    assert (front.confirmed == (front.checked & (front.acceleration <= 60.0))).all()
    assert front.recommended.sum() == SETTINGS["recommended"]
    assert front.confirmed[front.recommended].all()
    checked = front[front.checked]
    assert checked.checked_velocity.to_numpy() == pytest.approx(checked.velocity + 0.005)
    assert checked.velocity_high.to_numpy() == pytest.approx(checked.velocity + 0.01)
    assert front[~front.checked].checked_velocity.isna().all()
    assert drive_page.last_growth(made["drive_generations"]) < 0.05
    for _, rows in made["drive_generations"].groupby("seed"):
        assert (np.diff(rows.hypervolume) >= -1e-12).all()
        assert rows.hypervolume.iloc[-1] <= 1.0 + 1e-12


def growing(*volumes: float) -> pd.DataFrame:
    return pd.DataFrame({"seed": 1, "generation": np.arange(1, len(volumes) + 1), "hypervolume": volumes})


def test_seeds_search_on_their_own_whatever_the_number_of_threads(monkeypatch):
    def search(settings, seed, count):
        amplitude = 30.0 + seed
        design, objectives = np.array([[amplitude, 50.0, 0.3, 0.0]]), np.array([[-0.1, 0.1, amplitude]])
        return pareto.Front(design, objectives, [float(seed)])

    monkeypatch.setattr(drive, "search", search)
    monkeypatch.setattr(drive, "check", lambda front, settings, threads: front)
    for threads in (1, 2):
        found = drive.make({**SETTINGS, "seeds": [5, 3]}, threads=threads)
        generations = found["drive_generations"]
        assert list(generations.seed) == [5, 3]
        assert generations.hypervolume[0] / generations.hypervolume[1] == pytest.approx(5.0 / 3.0)
        assert found["drive_front"].acceleration.tolist() == [33.0]


def test_growth_covers_the_last_quarter_of_the_worst_seed():
    one, other = growing(0.1, 0.5, 0.8, 0.8, 0.8, 0.9, 0.9, 0.9), growing(0.1, 0.5, 0.5, 0.8, 0.8, 0.8, 0.8, 1.0)
    assert drive_page.last_growth(one) == pytest.approx(0.0)
    assert drive_page.last_growth(pd.concat([one, other.assign(seed=2)])) == pytest.approx(0.25)
    assert drive_page.last_growth(growing(0.0, 0.0, 0.0, 0.0)) == math.inf


def test_the_page_lists_the_recommended_settings(made):
    page = drive_page.make(TEMPLATE, made["drive_front"], growing(0.1, 0.9, 0.995, 1.0))
    front = made["drive_front"]
    slowest = front[front.recommended].sort_values("velocity").iloc[0]
    line = next(line for line in page.splitlines() if line.startswith(f"| {slowest.acceleration:.3g} |"))
    low, high = slowest.velocity_low, slowest.velocity_high
    assert f"| {slowest.checked_velocity:.3g} | {low:.3g} to {high:.3g} |" in line
    assert page.count(" | 100.0 |") == SETTINGS["recommended"]
    assert "The search has settled" in page
    assert "fewer than 9.1 % of all initial conditions" in page


def test_the_page_says_that_nothing_was_found(made):
    none = made["drive_front"].assign(recommended=False, confirmed=False)
    none.attrs = SETTINGS
    page = drive_page.make(TEMPLATE, none, growing(0.1, 0.5, 0.9, 1.0))
    assert "No design of the search was confirmed" in page
    assert "**The search has not settled.**" in page
    assert "grew by up to 11 % (limit: 2 %)" in page


def test_a_search_that_finds_nothing_says_so(monkeypatch):
    def evaluate(x, settings, errors, **_):
        found = pd.DataFrame(np.nan, index=range(len(x)), columns=[*drive.OVERALL])
        return found.assign(displacement=drive.displacement(x))

    monkeypatch.setattr(drive, "evaluate", evaluate)
    found = drive.make({**SETTINGS, "drawn": 8, "population": 4, "generations": 4})
    front, generations = found["drive_front"], found["drive_generations"]
    assert len(front) == 0
    assert set(front) == {column.name for column in drive.TABLES["drive_front"]}
    front = front.astype(dict.fromkeys(("checked", "confirmed", "recommended"), bool))
    front.attrs = SETTINGS
    page = drive_page.make(TEMPLATE, front, generations)
    assert "found no design within the constraints." in page
    assert "inf" not in page
