"""Drive design: single designs and the operating table, constraints, fronts with known members, and the page."""

import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT, si_config

from conveyor_pipeline.config.tables import TABLES
from conveyor_pipeline.machine.operating import drive, drive_page, pareto, populations, transit

SETTINGS = {**TABLES["operating/drive_front"](si_config()), "starts": 24, "longest": 2.0}
TEMPLATE = (ROOT / "workflow/rules/machine/drive.md").read_text()
PAPER = [50.0, math.radians(12.0), 0.0]


def test_the_worst_within_the_margin_counts():
    """Compared with the transit table at each of the amplitudes."""
    settings = {**SETTINGS, "margin": 0.05}
    found = drive.evaluate(np.array([[40.0, *PAPER], [50.0, *PAPER]]), settings, drive.CHECK_ERRORS)
    model = settings["model"] | dict(zip(drive.SEARCHED[1:], PAPER, strict=True))
    for place, amplitude in enumerate((40.0, 50.0)):
        amplitudes = amplitude * np.array([0.95, 1.0, 1.05])
        alone = transit.measure(amplitudes, {**settings, "model": model}, (populations.VARIED,))
        assert found.velocity[place] == alone.velocity_05.min()
        assert found.velocity_95[place] == alone.velocity_95.max()
        assert found.impact_speed[place] == alone.impact_speed.max()
        assert found.late[place] == alone.late.max()
        assert found.displacement[place] == pytest.approx(amplitude / (100.0 * math.pi) ** 2)


GOOD = pd.DataFrame(
    [{"back": 0.0, "failed": 0, "velocity": 0.1, "impact_speed": 0.1, "displacement": 1e-4, "late": 0.0}], dtype=float
).assign(velocity_50=0.11, velocity_95=0.12)


@pytest.mark.parametrize(
    ("name", "worst"),
    [
        *(("back", 0.02), ("failed", 1.0), ("impact_speed", 0.61), ("displacement", 0.9e-3)),
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


def test_designs_with_too_large_a_displacement_are_not_followed(monkeypatch):
    followed = []

    def evaluate(designs, settings, errors, **_):
        followed.append(designs[:, 0].tolist())
        return pd.concat([GOOD] * len(designs), ignore_index=True)

    monkeypatch.setattr(drive, "evaluate", evaluate)
    objectives, violations = drive.search_outcomes(np.array([[80.0, 40.0, 0.2, 0.0], [30.0, *PAPER]]), SETTINGS)
    assert followed == [[30.0]]
    assert (violations <= 0.0).all(axis=1).tolist() == [False, True]
    assert objectives[1].tolist() == [-0.1, 0.1, 30.0]


def test_settings_differ_as_much_as_they_can():
    """The fastest, then the gentlest, then the one farthest from both; units do not matter."""
    objectives = np.array([[-5.0, 9.0, 7.0], [-4.9, 8.9, 7.0], [-1.0, 0.0, 7.0], [-3.0, 4.0, 2.0], [-1.1, 0.1, 7.0]])
    for units in (np.ones(3), np.array([1e-3, 1.0, 50.0])):
        assert drive.spread(units * objectives, 3).tolist() == [0, 2, 3]
    assert sorted(drive.spread(objectives, 9)) == [0, 1, 2, 3, 4]
    assert drive.spread(objectives[:0], 5).tolist() == []


@pytest.fixture(scope="module")
def made() -> dict[str, pd.DataFrame]:
    """A search whose outcomes are closed forms: velocity and impact speed grow with the amplitude and the angle.

    With all parts, half of them move back above 60 m/s².
    """

    def evaluate(x, settings, errors, **_):
        velocity = x[:, 0] / 400.0 * np.sin(2.0 * x[:, 2]) * np.cos(x[:, 3])
        found = {"velocity": velocity, "impact_speed": x[:, 0] * np.sin(x[:, 2]) / 100.0}
        found |= {"velocity_50": velocity + 0.005, "velocity_95": velocity + 0.01, "failed": 0, "late": 0.0}
        full = settings["starts"] == SETTINGS["starts"]
        assert (0.0 in errors) == full
        found |= {"back": np.where(full & (x[:, 0] > 60.0), 0.5, 0.0)}
        return pd.DataFrame(found | {"displacement": drive.peaks_of(x, settings["model"]).displacement})

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(drive, "evaluate", evaluate)
        tables = drive.make({**SETTINGS, "population": 40, "generations": 40})
    tables["drive_front"].attrs = SETTINGS
    return tables


def test_a_search_with_known_outcomes_finds_their_front(made):
    """A phase shift of zero is best. Checked designs have the outcomes with all parts."""
    front = made["drive_front"]
    assert front.phase_shift.abs().median() < 0.1
    assert (front.displacement <= SETTINGS["displacement"]).all()
    assert front.velocity.min() >= SETTINGS["velocity"]
    assert front.impact_speed.max() <= SETTINGS["impact_speed"]
    assert front.checked.sum() == drive.MOST_CHECKED
    assert (front.confirmed == (front.checked & (front.acceleration <= 60.0))).all()
    assert front.recommended.sum() == drive.RECOMMENDED
    assert front.confirmed[front.recommended].all()
    checked = front[front.checked]
    assert checked.checked_velocity.to_numpy() == pytest.approx(checked.velocity)
    assert checked.checked_velocity_95.to_numpy() == pytest.approx(checked.velocity + 0.01)
    assert front[~front.checked].checked_velocity.isna().all()
    assert growth(made["drive_generations"]) < 0.05
    for _, rows in made["drive_generations"].groupby("seed"):
        assert (np.diff(rows.hypervolume) >= -1e-12).all()
        assert rows.hypervolume.iloc[-1] <= 1.0 + 1e-12


def growing(*volumes: float) -> pd.DataFrame:
    return pd.DataFrame({"seed": 1, "generation": np.arange(1, len(volumes) + 1), "hypervolume": volumes})


def growth(generations: pd.DataFrame) -> float:
    front = pd.DataFrame({"checked": [True], "confirmed": [True]})
    front.attrs = SETTINGS
    return drive_page.summarize_search(front=front, generations=generations)["growth"]


def test_seeds_search_on_their_own_whatever_the_number_of_threads(monkeypatch):
    def search(settings, seed, count):
        amplitude = 30.0 + seed
        design, objectives = np.array([[amplitude, 50.0, 0.3, 0.0]]), np.array([[-0.1, 0.1, amplitude]])
        return pareto.Front(design, objectives, [float(seed)])

    monkeypatch.setattr(drive, "search", search)
    monkeypatch.setattr(drive, "check", lambda front, settings, threads: front)
    monkeypatch.setattr(drive, "SEEDS", (5, 3))
    for threads in (1, 2):
        found = drive.make(SETTINGS, threads=threads)
        generations = found["drive_generations"]
        assert list(generations.seed) == [5, 3]
        assert generations.hypervolume[0] / generations.hypervolume[1] == pytest.approx(5.0 / 3.0)
        assert found["drive_front"].acceleration.tolist() == [33.0]


def test_growth_covers_the_last_quarter_of_the_worst_seed():
    one, other = growing(0.1, 0.5, 0.8, 0.8, 0.8, 0.9, 0.9, 0.9), growing(0.1, 0.5, 0.5, 0.8, 0.8, 0.8, 0.8, 1.0)
    assert growth(one) == pytest.approx(0.0)
    assert growth(pd.concat([one, other.assign(seed=2)])) == pytest.approx(0.25)
    assert growth(growing(0.0, 0.0, 0.0, 0.0)) == math.inf


def test_the_page_lists_the_recommended_settings(made):
    page = drive_page.make(TEMPLATE, made["drive_front"], growing(0.1, 0.9, 0.995, 1.0))
    front = made["drive_front"]
    fastest = front[front.recommended].sort_values("velocity").iloc[-1]
    lines = [line for line in page.splitlines() if line.startswith("| ")][1:]
    assert len(lines) == drive.RECOMMENDED
    assert lines[0].startswith(f"| {fastest.acceleration:.3g} |")
    assert f"| {100 * fastest.velocity:.3g} | {100 * fastest.velocity + 0.5:.3g} |" in lines[0]
    assert f"the slowest 5 % of the\nparts travel at {100 * fastest.velocity:.3g} cm/s" in page
    assert "The search has settled" in page
    assert "fewer than 12 % of all parts do" in page


def test_the_first_line_names_bounds_and_limits_at_which_the_search_ended():
    bounds, inside = SETTINGS["bounds"], {"checked_impact_speed": 0.1, "displacement": 1e-4}
    middle = {name: sum(bounds[name]) / 2.0 for name in drive.SEARCHED} | inside
    assert drive_page.ends_reached(middle, SETTINGS) == []
    low, high = bounds["acceleration"]
    at_ends = middle | {"acceleration": high - 0.01 * (high - low), "angle": bounds["angle"][0]}
    at_ends |= {"displacement": 0.99 * SETTINGS["displacement"]}
    named = ["the upper bound of `drive.bounds.acceleration`", "the lower bound of `drive.bounds.angle`"]
    assert drive_page.ends_reached(at_ends, SETTINGS) == [*named, "`drive.displacement`"]


def test_the_page_names_the_harmonics_of_the_plate(made):
    front = made["drive_front"].copy()
    assert "The plate's motion has" not in drive_page.make(TEMPLATE, front, growing(1.0, 1.0))
    assert "Peak acceleration in m/s²" not in drive_page.make(TEMPLATE, front, growing(1.0, 1.0))
    front.attrs = SETTINGS | {"model": SETTINGS["model"] | {"harmonics": [{"order": 3}]}}
    page = drive_page.make(TEMPLATE, front, growing(1.0, 1.0))
    assert "The plate's motion has a harmonic of the order 3" in page
    assert "Peak acceleration in m/s²" in page


def test_the_page_says_that_nothing_was_found(made):
    none = made["drive_front"].assign(recommended=False, confirmed=False)
    page = drive_page.make(TEMPLATE, none, growing(0.1, 0.5, 0.9, 1.0))
    assert "No design of the search was confirmed" in page
    assert "**The search has not settled.**" in page
    assert "grew by up to 11 % (limit: 2 %)" in page


def test_a_seed_that_finds_a_design_late_or_never_is_named(made):
    """Its hypervolume has no relative growth."""
    volumes = growing(0.0, 0.0, 0.0, 1.0), growing(0.0, 0.0, 0.0, 0.0).assign(seed=2)
    page = drive_page.make(TEMPLATE, made["drive_front"], pd.concat(volumes))
    assert "the hypervolume of a seed was still zero" in page
    assert "The hypervolume of a seed is zero." in page
    assert "inf" not in page
    page = drive_page.make(TEMPLATE, made["drive_front"], growing(0.1, 0.5, 0.9, 1.0))
    assert "still zero" not in page and "has at least 100 % of the hypervolume" in page
    stuck = pd.concat([growing(0.1, 1.0, 1.0, 1.0), growing(0.1, 0.19, 0.19, 0.19).assign(seed=2)])
    page = drive_page.make(TEMPLATE, made["drive_front"], stuck)
    assert "**The search has not settled.** A seed has found less than 80 % of the front." in page
    page = drive_page.make(TEMPLATE, made["drive_front"], growing(0.0, 0.0, 0.0, 0.0))
    assert "**Whether the search has settled is not known**" in page and "still zero" not in page


def test_settings_at_which_parts_arrive_late_are_pointed_out(made):
    front = made["drive_front"].copy()
    assert "more than half of the parts need longer" not in drive_page.make(
        TEMPLATE, front, growing(1.0, 1.0, 1.0, 1.0)
    )
    front.loc[front.recommended, "checked_late"] = 0.6
    late = int(front.recommended.sum())
    page = drive_page.make(TEMPLATE, front, growing(1.0, 1.0, 1.0, 1.0))
    assert f"**With {late} setting" in page and "m/s in `drive.velocity`" in page


def test_a_search_that_finds_nothing_says_so(monkeypatch):
    def evaluate(x, settings, errors, **_):
        found = pd.DataFrame(np.nan, index=range(len(x)), columns=[*drive.WORST])
        return found.assign(displacement=drive.peaks_of(x, settings["model"]).displacement)

    monkeypatch.setattr(drive, "evaluate", evaluate)
    found = drive.make({**SETTINGS, "population": 4, "generations": 4})
    front, generations = found["drive_front"], found["drive_generations"]
    assert len(front) == 0
    assert set(front) == {column.name for column in drive.TABLES["drive_front"]}
    front = front.astype(dict.fromkeys(("checked", "confirmed", "recommended"), bool))
    front.attrs = SETTINGS
    page = drive_page.make(TEMPLATE, front, generations)
    assert "found no design within the constraints." in page and "too steep" not in page
    steep = front.copy()
    steep.attrs = SETTINGS | {"model": SETTINGS["model"] | {"friction": 0.3, "inclination": 0.5}}
    page = drive_page.make(TEMPLATE, steep, generations)
    assert "too steep for friction to stop a part" in page and "Widen the bounds" not in page
    assert "inf" not in page


def with_a_second_harmonic(along: float, normal: float) -> dict:
    """The model with a second harmonic that adds half of the acceleration, and an eighth of the displacement."""
    second = {"order": 2, "along": 0.5, "along_phase": along, "normal": 0.5, "normal_phase": normal}
    return SETTINGS["model"] | {"harmonics": [second]}


@pytest.mark.parametrize("phases", [(0.0, 0.0), (math.pi, math.pi), (0.0, math.pi)])
def test_peaks_count_the_harmonics_of_the_model(phases):
    peaks = drive.peaks_of(np.array([[40.0, *PAPER]]), with_a_second_harmonic(*phases))
    assert peaks.acceleration[0] == pytest.approx(60.0, rel=1e-9)
    assert peaks.displacement[0] == pytest.approx(1.125 * 40.0 / (100.0 * math.pi) ** 2, rel=1e-9)


@pytest.mark.long  # the solver is compiled for plates with harmonics
def test_the_search_counts_the_harmonics_of_the_model():
    model, design = with_a_second_harmonic(0.0, math.pi), np.array([[40.0, *PAPER]])
    peaks, few = drive.peaks_of(design, model), {**SETTINGS, "model": model, "search": {"parts": 2, "longest": 0.1}}
    assert drive.evaluate_few(design, few).displacement[0] == peaks.displacement[0]
    (objectives,), _ = drive.search_outcomes(design, few)
    assert objectives[2] == peaks.acceleration[0]


def test_a_design_keeps_the_harmonics_of_the_model():
    model = drive.model_of(np.array([40.0, *PAPER]), {"friction": 0.15, "harmonics": [{"order": 3}]})
    assert model["harmonics"] == [{"order": 3}]
    assert [model[name] for name in drive.SEARCHED[1:]] == PAPER
