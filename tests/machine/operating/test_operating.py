"""Shares of initial conditions: the box, its motions and their velocities, and the chart in words."""

import math
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from project import ROOT, si_config

from conveyor import Columns, Conveyor, Start, classify, ensemble, parameter_table, plate_motion, simulate
from conveyor_pipeline.common.labelling import label_entry
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.common.steepness import steepness
from conveyor_pipeline.config.tables import TABLES
from conveyor_pipeline.machine.operating import (
    advice,
    chart,
    parts,
    populations,
    regimes,
    settings,
    shares,
    throws,
    transit,
)

TEMPLATE = (ROOT / "workflow/rules/machine/operating_chart.md").read_text()
BOX = {
    **si_config()["operating"],
    "starts": 64,
    "settling": 2000,
    "model": {"angle": math.radians(12.0), "gravity": 9.81},
}


def test_heights_are_above_the_plate_at_the_initial_phase():
    box = {**BOX, "starts": 3, "model": {"angle": 0.3}}
    rows, starts = parts.population(np.array([30.0, 50.0]), box, populations.IDENTICAL), parts.starts_of_box(box)
    assert rows.shape == (6,)
    for row, acceleration, (height, velocity, phase) in zip(
        rows, np.repeat([30.0, 50.0], 3), np.tile(starts, (2, 1)), strict=True
    ):
        plate = plate_motion(Conveyor(acceleration=acceleration, angle=0.3, psi0=phase), np.zeros(1))["z"][0]
        assert row["z0"] - plate == pytest.approx(height, abs=1e-15)
        assert (row["vz0"], row["psi0"]) == (velocity, phase)


def test_initial_conditions_fill_the_box_and_depend_on_the_seed():
    starts = parts.starts_of_box({**BOX, "starts": 1000})
    for column, name in zip(starts.T, ("height", "vz0", "psi0"), strict=True):
        low, high = BOX[name]
        assert low <= column.min() < low + 0.02 * (high - low)
        assert high - 0.02 * (high - low) < column.max() <= high
    assert (starts == parts.starts_of_box({**BOX, "starts": 1000})).all()
    assert (starts != parts.starts_of_box({**BOX, "starts": 1000, "seed": 2})).all()


def test_motions_differ_by_conveyor_state_period_and_flight():
    found = Columns(
        {
            "state": np.array(["second", "first", "second", "chaos", "second", "second", "chaos"]),
            "period": np.array([1, 1, 2, 0, 1, 1, 0]),
            "longest_flight": np.array([0.92, 0.0, 0.92, np.nan, 1.9, 0.9201, np.nan]),
        }
    )
    number = shares.groups(found, np.zeros(7, dtype=np.int64))
    assert number[0] == number[5]
    assert number[3] == number[6]
    assert len(set(number)) == 5
    number = shares.groups(found, np.arange(7) // 4)
    assert len(set(number)) == 7
    assert number[:4].max() < number[4:].min()


@pytest.fixture(scope="module")
def table():
    """Shares at two amplitudes with one and with two motions."""
    return shares.shares_at(np.array([22.0, 40.0]), BOX, followed=2)


def test_labels_agree_with_sweeps(table):
    """The same initial conditions as rows of a sweep, without shared chaotic sets."""
    parameters = parts.population(np.array([40.0]), BOX, populations.IDENTICAL)
    found = label_entry(parameters, {**BOX, "axes": {"acceleration": [40.0]}})
    own = table[table.acceleration == 40.0].set_index("state").starts
    assert own.to_dict() == pd.Series(found.state).value_counts().to_dict()
    assert own.sum() == BOX["starts"]


def test_velocities_are_means_over_whole_cycles(table):
    """They agree with single long runs, over fifty cycles after the first hundred."""
    for state, start in (("second", Start(3e-4)), ("first", Start(0.0))):
        x = simulate(Conveyor(acceleration=40.0), start, duration=3.0).sample(np.array([2.0, 3.0]))["x"]
        row = table[(table.acceleration == 40.0) & (table.state == state)].iloc[0]
        assert row.mean_velocity == pytest.approx(x[1] - x[0], rel=1e-6)
    assert (table.status == "ok").all()
    assert (table.velocity_stderr < 1e-6).all()
    assert table.vertical.tolist() == pytest.approx(table.acceleration * math.sin(math.radians(12.0)) / 9.81)
    assert table.stderr.tolist() == pytest.approx(np.sqrt(table.share * (1.0 - table.share) / BOX["starts"]))
    assert (table.motion == table.groupby("acceleration").mean_velocity.rank(ascending=False)).all()


def velocity(conveyor: Conveyor, start: Start, period: int, cycles: int = shares.CYCLES) -> tuple[float, str]:
    """The mean velocity of one initial condition that has settled vertically after twenty cycles, and its status."""
    labels = Columns({"period": np.array([period]), "cycles": np.array([20])})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shares, "CYCLES", cycles)
        (found,), _, (status,) = shares.velocities(parameter_table(conveyor, start)[None], labels, BOX)
    return found, status


def test_velocities_wait_for_a_slow_horizontal_motion():
    """With little friction the part gains speed for thousands of cycles, long after it has settled vertically."""
    conveyor = Conveyor(friction=1e-3)
    found, status = velocity(conveyor, Start(3e-4), 1, cycles=20)
    x = simulate(conveyor, Start(3e-4), duration=100.0).sample(np.array([99.0, 100.0]))["x"]
    assert status == "ok"
    plate = 40.0 * math.cos(conveyor.angle) / (100.0 * math.pi)
    assert found == pytest.approx(x[1] - x[0], abs=2.0 * shares.SETTLED * plate)
    # With even less friction, six doublings of the time are not enough.
    found, status = velocity(Conveyor(friction=1e-5), Start(3e-4), 1, cycles=20)
    assert np.isnan(found)
    assert status == "mean velocity not settled"


@pytest.mark.parametrize(("acceleration", "z", "period"), [(40.0, 3e-4, 1), (80.0, 3e-4, 0)])
def test_a_part_that_slides_on_a_steep_track_has_no_velocity(acceleration, z, period):
    """Sliding friction takes less than the slope gives, whatever the static friction is."""
    conveyor = Conveyor(acceleration=acceleration, inclination=-0.2, friction=0.15, static_friction=0.5)
    found, status = velocity(conveyor, Start(z), period, cycles=20)
    assert np.isnan(found)
    assert status == regimes.SLIDES_AWAY
    # A part that never slides stays.
    found, status = velocity(replace(conveyor, acceleration=0.5), Start("conveyor"), 1, cycles=20)
    assert (found, status) == (0.0, "ok")


def test_how_steep_a_track_is_depends_on_both_coefficients_of_friction():
    tracks = parameter_table(Conveyor(friction=0.2, static_friction=0.35), inclination=[-0.1, 0.3, 0.4])
    assert list(steepness(tracks)) == [0, 1, 2]
    level = parameter_table(Conveyor(friction=0.0), inclination=[0.0])
    assert list(steepness(level)) == [0]


def test_a_part_that_sticks_in_every_cycle_has_a_velocity_on_a_steep_track():
    """Its mean velocity is larger than the largest velocity of the plate."""
    amplitude = 7.0 / math.sin(0.5)
    conveyor = Conveyor(angle=0.5, acceleration=amplitude, inclination=-0.2, friction=0.2, static_friction=0.5)
    found, status = velocity(conveyor, Start("conveyor"), 1, cycles=20)
    assert status == "ok"
    assert found == pytest.approx(simulate(conveyor, Start("conveyor"), duration=8.0).mean_velocity(), rel=1e-7)
    assert found > amplitude * math.cos(0.5) / (100.0 * math.pi)


def test_velocities_are_means_over_whole_periods():
    """A motion with a period of four cycles, over a number of cycles that is not a multiple of four."""
    conveyor = Conveyor(acceleration=61.8)
    assert classify(parameter_table(conveyor, Start(3e-4))[None]).period.tolist() == [4]
    found, status = velocity(conveyor, Start(3e-4), 4, cycles=251)
    x = simulate(conveyor, Start(3e-4), duration=40.0).sample(np.array([32.0, 40.0]))["x"]
    assert status == "ok"
    assert found == pytest.approx((x[1] - x[0]) / 8.0, rel=1e-7)


def test_runs_with_the_same_beginning_are_followed_once():
    """The means over the beginning of a run and over the whole run equal the means of two runs."""
    rows = np.stack([parameter_table(Conveyor(acceleration=a), Start(z0)) for a in (40.0, 80.0) for z0 in (0.0, 3e-4)])
    durations = np.array([[0.4, 0.6], [0.4, 0.8], [0.2, 0.8], [0.4, 0.9]])
    means, peaks, status = shares.last_quarters(rows, durations, 1e-9, 1)
    for k, (mean, duration) in enumerate(zip(means.T, durations.T, strict=True)):
        alone = ensemble.sweep(rows, duration=duration, tolerance=1e-9)
        assert mean.tolist() == alone["mean_velocity"].tolist()
        if k == 1:  # peaks of the longest run
            np.testing.assert_array_equal(peaks, np.column_stack([alone["impact_speed"], alone["peak_force"]]))
    assert (status == "ok").all()


def test_brief_runs_are_as_long_as_friction_needs():
    """On a track steeper than friction holds, no length helps."""
    rows = np.stack([parameter_table(Conveyor(inclination=alpha), Start()) for alpha in (0.0, -0.147, 0.14888, 0.2)])
    flat, steep, steepest, beyond = shares.brief_durations(rows, np.ones(4, dtype=int), 60) * 50.0
    assert flat == beyond == pytest.approx(60.0)
    assert 60.0 < steep < steepest == pytest.approx(shares.MOST_CYCLES)


def test_a_run_that_fails_says_why_there_is_no_velocity():
    found, status = velocity(Conveyor(damping=1e6, mass=1e-6), Start(3e-4), 1)
    assert np.isnan(found)
    assert status == "contact too stiff"


@pytest.mark.parametrize(
    ("states", "statuses", "wanted"),
    [
        ("first", ["ok", "ok"], (2.0, 1.0, "ok")),  # 1 and 3 m/s: a standard error of 1
        ("first", ["ok", "mean velocity not settled"], (np.nan, np.nan, "mean velocity not settled")),
        ("undecided", ["ok", "ok"], (np.nan, np.nan, "state not decided")),
    ],
)
def test_velocities_of_a_motion_are_averaged(monkeypatch, states, statuses, wanted):
    def motions_found(parameters, *_, **__):
        n = len(parameters)
        labels = {"state": np.full(n, states), "period": np.ones(n, np.int64), "longest_flight": np.zeros(n)}
        return Columns(labels | {"cycles": np.arange(n)})

    monkeypatch.setattr(shares, "labels_of", motions_found)
    velocities = np.array([1.0, 3.0]), np.array([[0.1, 2.0], [0.2, 1.0]]), np.array(statuses, dtype=object)
    monkeypatch.setattr(shares, "velocities", lambda *_, **__: velocities)
    row = shares.shares_at(np.array([40.0]), BOX, followed=2).iloc[0]
    assert (row.mean_velocity, row.velocity_stderr, row.status) == pytest.approx(wanted, nan_ok=True)
    assert row.starts == BOX["starts"]
    peaks = (0.2, 2.0) if row.status == "ok" else (np.nan, np.nan)
    assert (row.impact_speed, row.peak_force) == pytest.approx(peaks, nan_ok=True)


def test_where_motions_do_not_converge_a_few_initial_conditions_are_followed_to_the_limit(monkeypatch):
    """From 49 m/s² on, every second motion has a long period. One of the first initial conditions at 49 m/s² ends
    undecided, and one at 51 m/s² converges late.
    """
    limit, late = 20_000, 5000

    def followed(parameters, *, cycles, **_):
        amplitude, number = parameters["acceleration"], parameters["z0"]
        slow = (amplitude == 49.0) & (number == shares.TRIED - 1)
        needed = np.where(slow | ((amplitude >= 49.0) & (number % 2 == 0)), np.inf, 10.0)
        needed[(amplitude == 51.0) & (number == 1)] = late
        return Columns({"state": np.where(slow, "undecided", "first"), "cycles": np.minimum(needed, cycles)})

    monkeypatch.setattr(shares, "classify", followed)
    monkeypatch.setattr(shares, "shared_attractors", lambda *_, **__: None)
    starts = 100
    rows = shares.population(np.array([40.0, 49.0, 50.0, 51.0]), {**BOX, "starts": starts}, shares.IDENTICAL)
    rows["z0"] = np.tile(np.arange(starts), 4)
    labels = shares.labels_of(rows, {**BOX, "settling": limit, "starts": starts})
    longest = labels.cycles.reshape(4, starts)
    tried, others = longest[:, : shares.TRIED].max(axis=1), longest[:, shares.TRIED :].max(axis=1)
    assert tried.tolist() == [10, limit, limit, limit]
    assert others.tolist() == [10, shares.BRIEF * limit, shares.BRIEF * limit, limit]
    assert np.flatnonzero(labels.state == "undecided").tolist() == [starts + shares.TRIED - 1]


def rows_at(acceleration: float) -> dict[str, list]:
    """Made-up motions: one velocity below 31.4 m/s², two up to 50 (one of them by two motions), chaos and a jumping
    motion above 50, chaos alone above 56.
    """
    common = {"period": 1, "longest_flight": 0.0, "velocity_stderr": 0.0, "status": "ok", "stderr": 0.05}
    common |= {"acceleration": acceleration, "vertical": acceleration / 47.0}
    motions = [("first", 100, 0.01)]
    if acceleration > 31.4:
        jump = 30 if acceleration < 40.0 else 34
        motions = [("second", jump - 10, 0.06), ("second", 10, 0.0595), ("first", 100 - jump, 0.01)]
    if acceleration > 50.0:
        motions = [("second", 20, 0.07), ("chaos", 80, 0.05)]
    if acceleration > 56.0:
        motions = [("chaos", 100, 0.05)]
    return [
        {**common, "motion": k, "state": state, "starts": starts, "share": starts / 100.0, "mean_velocity": velocity}
        for k, (state, starts, velocity) in enumerate(motions, start=1)
    ]


def made_up(amplitudes, settings, **options):
    return pd.DataFrame([row for acceleration in amplitudes for row in rows_at(acceleration)])


SETTINGS = {**BOX, "acceleration": {"start": 20.0, "stop": 60.0, "num": 9}, "resolution": 0.005, "starts": 100}


@pytest.fixture(scope="module")
def refined() -> pd.DataFrame:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shares, "shares_at", made_up)
        found = shares.make(SETTINGS)["shares"]
    found.attrs = SETTINGS | {
        "model": {"friction": 0.15, "angle": 0.21, "mass": 1e-3, "gravity": 10.0, "frequency": 50.0}
    }
    return found


def test_amplitudes_are_halved_where_the_answer_changes(refined):
    places = refined.acceleration.unique()
    assert (np.diff(places) > 0.0).all()
    for change in (31.4, 50.0):
        below, above = places[places <= change].max(), places[places > change].min()
        assert above - below <= SETTINGS["resolution"] * above
    assert len(places) < 30


def test_boundaries_are_located_with_a_limited_number_of_amplitudes(monkeypatch):
    monkeypatch.setattr(shares, "shares_at", made_up)
    monkeypatch.setattr(shares, "MOST_ADDED", 0)
    table = shares.make(SETTINGS)["shares"]
    np.testing.assert_array_equal(np.unique(table.acceleration), np.linspace(20.0, 60.0, 9))
    table.attrs = SETTINGS
    assert regimes.summarize_shares(table)["located"] == 5.0 / 35.0


def test_chaos_begins_at_its_lowest_amplitude(refined):
    """Also if motion is regular at a higher amplitude, or the interval is narrow."""
    found = intervals_of(refined)
    assert chart.summarize_regimes(found, refined)["chaos_from"] == refined[refined.state == "chaos"].acceleration.min()
    regular = refined[refined.state != "chaos"]
    assert chart.summarize_regimes(found, regular)["chaos_from"] is None


def measures(**changed: float) -> dict[str, float]:
    """Made-up measures of a population."""
    found = dict.fromkeys((column.name for column in transit.MEASURES), 0.0) | {"failed": 0}
    found |= {"velocity_05": 0.02, "velocity_50": 0.03, "velocity_95": 0.05, "mean_velocity": 0.03, "spread": 1.0}
    return found | {"late": 0.125, "impact_speed": 0.1, "peak_force": 0.5} | changed


def advised(**worst: float) -> list[pd.DataFrame]:
    """Made-up tables of transit, advice and changes."""
    rows = pd.DataFrame([measures(acceleration=a, population="varied") for a in (31.0, 58.0)])
    rows.attrs = {"length": 0.5, "longest": 20.0, "starts": 256, "spread": {"friction": 0.15, "mass": 0.0, "seed": 1}}
    rows.attrs["model"] = {"friction": 0.15, "angle": 0.21, "mass": 1e-3, "gravity": 10.0, "frequency": 50.0}
    rows.attrs["model"] |= {"stiffness": 5e5, "exponent": 1.5}
    common = {"throw_number": 0.66, "velocity_worst": 0.01, "spread_worst": 1.1} | worst
    fast = measures(aim="fast", acceleration=31.0, states="first 100 %", states_acceleration=31.25, **common)
    even = measures(aim="even", acceleration=58.0, states="chaos 100 %", states_acceleration=60.0, **common) | {
        "spread": 0.2,
        "back": 0.01,
    }
    advice_rows = pd.DataFrame([fast, even])
    advice_rows.attrs = {"margin": 0.01, "part_length": 0.02, "changes": {"friction": 0.02, "angle": 0.02}}
    changes = [
        {"aim": "fast", "parameter": "friction", "value": 0.17, "gain": 0.2, "widening": -0.004},
        {"aim": "fast", "parameter": "friction", "value": 0.13, "gain": 0.05, "widening": -0.1},
        {"aim": "fast", "parameter": "angle", "value": 0.2, "gain": -0.2, "widening": -0.5},
        {"aim": "fast", "parameter": "angle", "value": 0.24, "gain": 0.1, "widening": math.nan},
        {"aim": "even", "parameter": "angle", "value": 0.2, "gain": -0.2, "widening": -0.5},
    ]
    return [rows, advice_rows, pd.DataFrame(changes).assign(gain_stderr=0.032, widening_stderr=0.01, velocity_05=0.03)]


REMEDIES = {"key": "operating.acceleration", "start": "lower `operating.acceleration.start`"}
REMEDIES["stop"] = "raise `operating.acceleration.stop`"


def page_of(
    shares_table: pd.DataFrame, tables: list[pd.DataFrame], assumed=(), assumed_model=(), measured_drive=""
) -> str:
    rows, advice_rows, changes = tables
    found = intervals_of(shares_table)
    tables = (rows, shares_table, found, advice_rows, changes)
    return chart.make(TEMPLATE, *tables, assumed, assumed_model, measured_drive, REMEDIES)


def intervals_of(table: pd.DataFrame) -> pd.DataFrame:
    return regimes.intervals_of(regimes.summarize_amplitudes(table), table)


def test_a_motion_that_is_faster_than_the_plate_is_pointed_out(refined):
    """The plate moves along the track with up to 0.062 m/s at 20 m/s²."""
    assert "faster than the plate" not in page_of(refined, advised())
    fast = refined.assign(mean_velocity=2.0)
    fast.attrs = refined.attrs
    assert "**At 9 of these amplitudes, from 20 m/s² on, the fastest motion is faster than the plate" in page_of(
        fast[fast.acceleration.isin(np.linspace(20.0, 60.0, 9))], advised()
    )
    fast.attrs = refined.attrs | {"model": refined.attrs["model"] | {"tension": "clip"}}
    assert "faster than the plate" not in page_of(fast, advised())


def test_no_amplitude_is_recommended_where_parts_move_back(refined):
    rows, *others = advised()
    back = rows.assign(velocity_95=-0.01)
    page = page_of(refined, [back, *others])
    assert (
        "**At no amplitude do more than 5 % of the parts move forward** (faster than 1 % of the plate's largest "
        "velocity), so there is no amplitude to recommend. A" in page
    )
    assert "- **Amplitude" not in page and "relative spread is" not in page
    steep = refined.assign(status=regimes.SLIDES_AWAY)
    assert "too steep for friction to stop a part" in page_of(steep, [back, *others])


def test_the_page_begins_with_the_advice(refined):
    page = page_of(refined, advised())
    first, second = "31 m/s² (Γ = 0.66, 0.628 mm peak to peak)", "58 m/s² (Γ = 0.66, 1.18 mm peak to peak)"
    assert page.startswith(f"# Operating chart\n\n**Run at {first} to be fast, or at {second} to feed evenly.**")
    assert (
        "- **Amplitude 31 m/s²** (peak acceleration along the direction of vibration), throw number Γ = 0.66, 0."
        in page
    )
    assert "- **Velocity 3 cm/s** (median); 90 % of the parts have 2 to 5 cm/s (relative spread 1 ± 0); with" in page
    assert "- Up to 90 parts of 20 mm per minute at this velocity, one behind the other\n" in page
    assert "- Late: 12.5 % of the parts need more than 20 s for 0.5 m. None has moved back\n" in page
    assert "- Impact speed up to 10 cm/s, contact force up to 0.5 N (50 times the weight of the part)" in page
    assert "- Motion of the initial conditions: riding (100 %); in the table below: one velocity\n" in page
    assert (
        "- Motion of the initial conditions at 60 m/s², the nearest amplitude at which it was examined: chaos (100 %);"
        in page
    )
    assert "; in the table below: chaos only\n" in page
    assert "m/s" not in re.sub("cm/s|m/s²", "", page)
    assert "  - friction of 0.17 (now 0.15): velocity +20 ± 4 %, spread -0.4 ± 1.0 %\n" in page
    assert "  - angle of 13.8° (now 12°): velocity +10 ± 4 %\n" in page
    assert page.index("**Even.**") < page.index("- **Amplitude 58 m/s²**") < page.index("## What the conveyor does")
    assert "1.0 % have moved back" in page
    assert page.count("(now ") == 3
    assert "The parts differ: relative standard deviations are 15 % of friction." in page
    assert "Assumed" not in page
    assumed = page_of(refined, advised(), ("friction", "mass"))
    told = "Assumed, because `parts` in the config does not state them: friction (15 %) and mass (0 %)."
    assert f"are 15 % of friction. {told} The recommendation" in " ".join(
        assumed.replace("Both recommendations allow", "The recommendation").split()
    )


def test_the_page_of_blocks_compares_its_advice_with_that_of_points(refined):
    rows, advice_rows, changes = advised()
    rows.attrs |= {"body": {"length": 5e-3, "height": 1e-3, "tilt": 0.03}}
    advice_rows["point_acceleration"], advice_rows["point_velocity"] = [31.1, 40.0], [0.02, 0.01]
    page = page_of(refined, [rows, advice_rows, changes])
    begin = page[: page.index("## Where to run")]
    assert "The parts are blocks of 5 mm by 1 mm (length by height) with an initial tilt of up to 0.03 rad." in begin
    assert "**For fast feeding, a point mass would have given the same advice. For even" in begin
    even = "For even feeding, a point mass would have led to another advice: 40 m/s², where the slowest 5 %"
    assert f"{even} of the blocks have 1 cm/s.**" in begin
    assert "Up to 360 parts of 5 mm per minute" in page
    assert "- Motion of the initial conditions, of a point mass: riding" in page
    assert "point mass" not in page_of(refined, advised())


def test_the_page_says_that_riding_parts_have_no_impacts(refined):
    assert "- No impacts, contact force up to 0.5 N" in page_of(refined, advised(impact_speed=0.0))


def test_the_page_says_that_parts_move_back_everywhere(refined):
    tables = advised(velocity_worst=-0.01)
    tables[1] = tables[1].head(1)
    tables[0].attrs["spread"] = {"friction": 0.0, "seed": 1}
    page = page_of(refined, tables)
    assert "**At no amplitude do 95 % of the parts move forward** if the amplitude may be up to 1 % too large" in page
    assert "**Even.**" not in page
    assert "All parts have equal parameters" in page


def test_the_page_names_harmonics_of_the_plate(refined):
    tables = advised()
    assert "whose motion has" not in page_of(refined, tables)
    tables[0].attrs["model"]["harmonics"] = [{"order": 2}, {"order": 3}]
    assert "on a plate whose motion has harmonics of the orders 2 and 3. They come" in page_of(refined, tables)


def test_large_forces_have_no_exponent_and_unknown_ones_are_left_out(refined):
    page = page_of(refined, advised(peak_force=128.0))
    assert "contact force up to 130 N (13000 times the weight of the part)" in page
    page = page_of(refined, advised(peak_force=math.nan)).split("## What")[0]
    assert "contact force" not in page
    assert "Impacts and forces are not known: all parts arrive within 0.4 s" in page


def test_the_page_says_which_parts_its_forces_belong_to(refined):
    """Twenty cycles of 50 Hz take 0.4 s."""
    assert "for 95 % of the parts that are on the track for more than 0.4 s, the time" in page_of(refined, advised())


@pytest.mark.parametrize(("stderr", "unsure"), [(0.0, False), (0.01, True)])
def test_the_page_says_if_the_even_amplitude_is_not_known_to_be_more_even(refined, stderr, unsure):
    rows, advice_rows, changes = advised()
    advice_rows["spread_worst"] = [1.1, 1.0]
    advice_rows[[name for name in advice_rows if name.endswith("_stderr")]] = stderr
    page = page_of(refined, [rows, advice_rows, changes])
    assert "**Even.**" in page
    assert ("the first amplitude may be as even." in page) == unsure


def test_the_page_names_changes_that_the_model_does_not_allow(refined):
    tables = advised()
    tables[1].attrs["changes"] = {"friction": 0.2}
    page = page_of(refined, tables)
    assert "- Not tested, because the model does not allow this value: friction of -0.05\n" in page
    tables[1].attrs["changes"] = {"friction": 1e6}
    page = page_of(refined, [*tables[:2], tables[2].iloc[:0]])
    assert "these values: friction of -1000000 and friction of 1000000\n" in page
    assert "No tested change" not in page


def test_a_spread_without_a_known_error_is_given(refined):
    assert "(relative spread 1)" in page_of(refined, advised(velocity_05_stderr=math.nan))


def test_the_page_says_that_fast_parts_slide_away(refined):
    page = page_of(refined.assign(status=regimes.SLIDES_AWAY), advised())
    assert page.index("## Where to run") < page.index("too steep") < page.index("**Fast for nearly all parts.**")
    assert "too steep" not in page_of(refined, advised())


def test_the_first_line_says_that_the_range_ends(refined):
    """The made-up table has the two recommended amplitudes only."""
    tables = advised()
    first = page_of(refined, tables).splitlines()[2]
    low = "The fast amplitude is the smallest one that was examined, so that a smaller one may be better: lower"
    high = "The even amplitude is the largest one that was examined, so that a larger one may be better: raise"
    assert (
        f"**{low} `operating.acceleration.start`.**" in first and f"**{high} `operating.acceleration.stop`.**" in first
    )
    wide = pd.concat([tables[0], tables[0].assign(acceleration=[20.0, 90.0])])
    assert "was examined" not in page_of(refined, [wide, *tables[1:]]).splitlines()[2]


def test_the_page_says_that_parts_do_not_arrive(refined):
    tables = advised()
    assert "do not arrive" not in page_of(refined, tables)
    tables[1]["late"] = 0.9
    page = page_of(refined, tables)
    assert "Most parts do not arrive in this time: raise `transit.longest`" in page


@pytest.mark.parametrize("friction", [0.0, 0.15])
def test_the_page_says_that_parts_have_calibrated_parameters(refined, friction):
    tables = advised()
    tables[0].attrs["spread"] = {"friction": friction, "calibrated": True, "seed": 1}
    page = page_of(refined, tables)
    assert "The parameters of each part are drawn from the samples of the calibration" in page
    assert "of calibrated" not in page and "All parts have equal parameters" not in page
    assert ("15 % of friction" in page) == (friction > 0.0)


def made_up_transit(slowest: list[float], spread: list[float]) -> pd.DataFrame:
    return pd.DataFrame({"acceleration": 10.0 * np.arange(len(spread)), "velocity_05": slowest, "spread": spread})


def alone(place: int) -> slice:
    """A range of the amplitude that contains no other place of the table."""
    return slice(place, place + 1)


def around_with(table: pd.DataFrame, ends: dict[int, tuple[float, float]]):
    """The measures at a place, and at the ends of its margin if they differ there."""

    def around(place: int) -> pd.DataFrame:
        rows = table.iloc[[place, place]].copy()
        if place in ends:
            rows.iloc[1, 1:] = ends[place]
        return rows

    return around


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        ({}, {"fast": 1, "even": 2}),
        ({1: (0.01, 0.5)}, {"fast": 3, "even": 2}),  # slow within the margin
        ({2: (0.05, 0.9)}, {"fast": 1, "even": 3}),  # uneven within the margin
        ({2: (0.01, 0.1)}, {"fast": 1, "even": 3}),  # too slow within the margin
    ],
)
def test_advice_must_hold_within_the_margin(ends, expected):
    table = made_up_transit([-0.1, 0.09, 0.05, 0.08, 0.01], [0.1, 0.5, 0.2, 0.3, 0.05])
    assert advice.choose(table, around_with(table, ends), alone) == expected


def test_unknown_and_backward_velocities_give_less_advice():
    table = made_up_transit([-0.1, -0.02, np.nan], [0.1, 0.5, 0.2])
    assert advice.choose(table, around_with(table, {}), alone) == {"fast": 1}
    table = made_up_transit([np.nan], [np.nan])
    assert advice.choose(table, around_with(table, {}), alone) == {}


def test_advice_has_the_measures_of_its_amplitude_and_of_changed_conveyors():
    settings = TABLES["operating/transit"](si_config()) | {"starts": 16, "longest": 1.0}
    table = transit.measure(np.array([40.0, 80.0]), settings)
    table.attrs = settings
    shares_table = pd.DataFrame({"acceleration": [39.0, 39.0, 81.0], "state": ["first", "second", "chaos"]})
    shares_table = shares_table.assign(share=[0.3, 0.7, 1.0])
    found = advice.make(table, shares_table, {"range": [0.99, 1.01], "changes": {"friction": 0.02}})
    told, changes = pd.DataFrame(found["advice"]), pd.DataFrame(found["changes"])
    fast = told.iloc[0]
    own = table[(table.population == "varied") & (table.acceleration == fast.acceleration)].iloc[0]
    assert (fast.aim, fast.acceleration, fast.states) == ("fast", 80.0, "chaos 100 %")
    assert fast.velocity_05 == own.velocity_05 == table[table.population == "varied"].velocity_05.max()
    ends = transit.measure(np.array([79.2, 80.8]), settings, ("varied",))
    assert fast.velocity_worst == min(fast.velocity_05, ends.velocity_05.min())
    more = changes[(changes.aim == "fast") & (changes.value > 0.15)].iloc[0]
    other = {**settings, "model": settings["model"] | {"friction": settings["model"]["friction"] + 0.02}}
    alone = transit.measure(np.array([80.0]), other, ("varied",)).iloc[0]
    assert more.velocity_05 == alone.velocity_05
    assert more.gain == pytest.approx(alone.velocity_05 / own.velocity_05 - 1.0)
    assert more.widening == pytest.approx(alone.spread / own.spread - 1.0)
    back = table.assign(velocity_95=-0.01)
    back.attrs = settings
    found = advice.make(back, shares_table, {"range": [0.99, 1.01], "changes": {"friction": 0.02}})
    assert len(found["advice"]["aim"]) == len(found["changes"]["aim"]) == 0
    found = advice.describe_states(shares_table, 40.0)
    assert found == {"states": "second 70 %, first 30 %", "states_acceleration": 39.0}


def test_changes_are_for_the_same_calibrated_parts():
    """A change that changes nothing leaves velocity and spread as they are."""
    settings = TABLES["operating/transit"](si_config()) | {"starts": 16, "longest": 1.0}
    samples = pd.DataFrame({"friction": settings["model"]["friction"] * np.array([0.5, 1.0, 2.0])})
    calibration = samples, pd.DataFrame({"parameter": ["friction"], "best": [settings["model"]["friction"]]})
    own = parts.with_calibration(settings, *calibration)
    table = transit.measure(np.array([40.0, 80.0]), own)
    table.attrs = settings
    shares_table = pd.DataFrame({"acceleration": [40.0], "state": ["first"], "share": [1.0]})
    found = advice.make(table, shares_table, {"range": [1.0, 1.0], "changes": {"friction": 0.0}}, *calibration)
    changes = pd.DataFrame(found["changes"])
    assert len(changes) > 0 and (changes.gain == 0.0).all() and (changes.widening == 0.0).all()


def test_static_friction_keeps_its_ratio_and_values_out_of_range_are_left_out():
    model = {"friction": 0.1, "static_friction": 0.2}
    assert advice.with_parameter(model, "friction", 0.15)["static_friction"] == pytest.approx(0.3)
    assert advice.with_parameter({"friction": 0.15}, "friction", 0.2) == {"friction": 0.2}
    smooth = {"friction": 0.0, "static_friction": 0.1}
    assert [advice.with_parameter(smooth, "friction", value)["static_friction"] for value in (0.05, 0.2)] == [0.1, 0.2]
    settings = TABLES["operating/transit"](si_config()) | {"starts": 8, "longest": 0.2}
    settings["model"] = settings["model"] | {"friction": 0.01}
    raised = settings | {"model": settings["model"] | {"friction": 0.03}}
    (change,) = advice.changes_at(40.0, settings, {"friction": 0.02})
    assert change["value"] == 0.03
    velocity = [transit.measure(np.array([40.0]), one, ("varied",)).velocity_05[0] for one in (settings, raised)]
    assert change["gain"] == pytest.approx((velocity[1] - velocity[0]) / abs(velocity[0]), rel=1e-12)


def test_a_change_that_affects_all_parts_equally_has_no_error():
    """Errors come from the same parts before and after, so that the differences between parts do not count."""
    before = np.random.default_rng(1).normal(1.0, 0.2, 64)
    found = advice.compare(before, 1.1 * before, seed=1)
    assert found["gain"] == pytest.approx(0.1) and found["widening"] == pytest.approx(0.0, abs=1e-12)
    assert max(found["gain_stderr"], found["widening_stderr"]) < 1e-12
    other = advice.compare(before, np.random.default_rng(2).normal(1.1, 0.2, 64), seed=1)
    assert 0.03 < other["gain_stderr"] < 0.4
    still = advice.compare(np.zeros(64), before, seed=1)
    assert all(math.isnan(value) for value in still.values())


def interval_rows(*rows: tuple[str, float, float]) -> pd.DataFrame:
    numbers = {"velocity_low": 0.1, "best_low": 0.2, "best_high": 0.3, "best_share_low": 0.4, "best_share_high": 0.5}
    common = numbers | {"step": 0.1, "amplitudes": 2}
    table = pd.DataFrame(rows, columns=["regime", "begin", "end"])
    return table.assign(number=np.arange(len(rows)), states=table.regime, **common)


def test_neighbouring_narrow_intervals_are_one():
    """The narrow interval at 30 m/s² has wide neighbours and stays; those from 60 m/s² on are one."""
    table = interval_rows(
        *((regimes.ONE, 20.0, 29.9), (regimes.CHAOS, 30.0, 30.05), (regimes.ONE, 30.1, 59.9)),
        *((regimes.BESIDE, 60.0, 60.1), (regimes.CHAOS, 60.2, 60.3), (regimes.BESIDE, 60.4, 60.5)),
        (regimes.CHAOS, 60.6, 70.0),
    )
    table.loc[4, "velocity_low"] = 0.05
    found = regimes.group_narrow(table, 0.01)
    assert found.regime.tolist() == [regimes.ONE, regimes.CHAOS, regimes.ONE, regimes.CHANGING, regimes.CHAOS]
    assert found.regimes.tolist()[3] == [regimes.BESIDE, regimes.CHAOS]
    assert (found.begin[3], found.end[3], found.amplitudes[3], found.velocity_low[3]) == (60.0, 60.5, 6, 0.05)
    assert found.states[3] == f"{regimes.BESIDE}, {regimes.CHAOS}"
    pd.testing.assert_frame_equal(regimes.group_narrow(table, 1e-6).drop(columns="regimes"), table)
    assert len(regimes.group_narrow(table, 0.9)) == 1


def test_unknown_intervals_are_not_joined():
    rows = ((regimes.UNKNOWN, 20.0, 20.0), (regimes.ONE, 20.1, 20.1), (regimes.UNKNOWN, 20.2, 20.2))
    found = regimes.group_narrow(interval_rows(*rows), 0.1)
    assert found.regime.tolist() == [regime for regime, _, _ in rows]


@pytest.mark.parametrize("margin", [0.001, 0.01, 0.1, 0.3])
def test_headline_list_and_table_say_the_same_of_each_amplitude(refined, margin):
    """The regime of each amplitude is that of its row, or one of those that the row changes between."""
    rows = regimes.group_narrow(intervals_of(refined), margin)
    page = page_of(refined, with_margin(margin))
    listed, table = page.split("## What the conveyor does")[1].split("| Amplitude in m/s² |")
    for amplitude in regimes.summarize_amplitudes(refined).itertuples():
        row = rows[(rows.begin <= amplitude.acceleration) & (amplitude.acceleration <= rows.end)].iloc[0]
        assert amplitude.regime in row.regimes
        assert (row.regime == regimes.CHANGING) == (len(row.regimes) > 1)
        motion = chart.motion_at(amplitude.acceleration, refined, rows)
        assert motion["regime"] == row.regime and sum(motion["states"].values()) == pytest.approx(1.0)
        place = f"{row.begin:.1f} to {row.end:.1f}" if row.begin < row.end else f"{row.begin:.1f}"
        assert listed.count(place) == 1
        assert re.search(rf"^\| {place} \|.*\| {row.regime}", table, re.MULTILINE)


def with_margin(margin: float) -> list[pd.DataFrame]:
    tables = advised()
    tables[1].attrs["margin"] = margin
    return tables


def test_the_page_names_intervals_in_which_the_motion_changes(refined):
    """With a margin of 30 %, the three intervals from 31.4 m/s² on are one, in which the motion changes."""
    page = page_of(refined, with_margin(0.5))
    assert (
        "- The motion changes within 50 % of the amplitude, which the drive does not hold: 20.0 to 60.0 m/s²." in page
    )
    kinds = "one velocity, several velocities, chaos beside other motions, chaos only"
    assert f"| changes within the error of the amplitude: {kinds} |" in page


def test_the_largest_share_belongs_to_an_amplitude_that_the_page_names(refined):
    most = chart.summarize_fastest(refined, [{"begin": 31.4, "end": 50.0}])["most"]
    assert most["acceleration"] >= 40.0 and most["best_share"] == pytest.approx(0.34)
    most = chart.summarize_fastest(refined, [{"begin": 31.4, "end": 36.0}])["most"]
    assert most["best_share"] == pytest.approx(0.3)


def test_regimes_and_their_words(refined):
    found = intervals_of(refined)
    assert list(found.regime) == [regimes.ONE, regimes.SEVERAL, regimes.BESIDE, regimes.CHAOS]
    assert list(found.best_share_low) == pytest.approx([1.0, 0.3, 0.2, 1.0])
    assert list(found.best_share_high) == pytest.approx([1.0, 0.34, 0.2, 1.0])
    assert list(found.velocity_low) == [0.01, 0.01, 0.05, 0.05]
    assert list(found.states) == ["first", "first, second", "chaos, second", "chaos"]
    assert regimes.summarize_amplitudes(refined).stderr.max() == pytest.approx(math.sqrt(0.34 * 0.66 / 100))
    # The amplitudes of the config are 5 m/s² apart; closer ones were added where the answer changes.
    assert list(found.step[:2]) == [5.0, 5.0]
    page = page_of(refined, advised())
    assert "- One velocity, whatever the initial condition: 20.0 to 31.2 m/s² (riding, 1 cm/s)\n" in page
    assert (
        "- Several velocities side by side, without chaos: 31.4 to 50.0 m/s². The fastest motion there has 6 cm/s"
        in page
    )
    assert "30 to 34 % of the initial conditions reach it." in page
    assert "This share is largest (34.0 ± 4.7 %) at 40 m/s², with 6 cm/s\n" in page
    assert "- Chaos only: 56.1 to 60.0 m/s²\n" in page
    assert "The lowest amplitude with chaos is 50.2 m/s²." in page
    assert "from heights of 0 to 0.5 mm above" in page
    assert "at 95 % confidence, fewer than 3 % of all initial conditions in\nthese ranges lead to" in page
    assert "is not known." not in page


@pytest.mark.parametrize(
    ("states", "velocities", "regime"),
    [
        (["first"], [0.01], regimes.ONE),
        (["second", "second"], [0.1, 0.09802], regimes.ONE),
        (["second", "second"], [0.1, 0.0975], regimes.SEVERAL),
        (["first", "first"], [0.01, -0.01], regimes.SEVERAL),
        (["chaos", "chaos"], [0.1, 0.1], regimes.CHAOS),
        (["chaos", "second"], [0.1, 0.1], regimes.BESIDE),
        (["second", "undecided"], [0.1, 0.1], regimes.UNKNOWN),
        (["second", "first"], [0.1, np.nan], regimes.UNKNOWN),
    ],
)
def test_regime_of_an_amplitude(states, velocities, regime):
    assert regimes.regime_of(np.array(states), np.array(velocities)) == regime


def test_the_fastest_motion_is_not_known_where_a_velocity_is_not(refined):
    one = refined[refined.acceleration == 20.0]
    missing = pd.concat([one, one.assign(state="undecided", mean_velocity=np.nan)], ignore_index=True)
    (row,) = intervals_of(missing).to_dict("records")
    assert row["regime"] == regimes.UNKNOWN
    assert np.isnan([row[name] for name in ("velocity_low", "best_low", "best_high", "best_share_low")]).all()


def test_an_amplitude_as_even_as_the_fast_one_is_no_advice_of_its_own():
    """The ranges of both contain the amplitude with the largest spread."""
    table = made_up_transit([0.10, 0.11, 0.10], [0.3, 0.2, 0.1])

    def around(place):
        return table

    assert advice.choose(table, around, alone) == {"fast": 1, "even": 1}


def test_a_table_without_known_amplitudes_gives_no_advice(refined):
    """The table has a single amplitude, whose regime is not known."""
    alone = refined[refined.acceleration == 20.0].assign(state="undecided", mean_velocity=np.nan)
    rows, advice_rows, changes = advised()
    advice_rows = advice_rows.iloc[:0]
    advice_rows.attrs = {"margin": 0.01, "changes": {}}
    unknown = rows.assign(velocity_95=np.nan)
    page = page_of(alone, [unknown, advice_rows, changes.iloc[:0]])
    assert "No part could be followed at any amplitude, so there is no advice." in page
    assert "No initial condition is known to end in chaos." in page
    assert "- A state or a velocity is not known: 20.0 m/s².\n" in page
    assert "| 20.0 | 0.426 | 0.405 | unknown | undecided | not known | not known | not known |" in page


def test_conveyors_with_equal_groups_have_equal_motions_over_the_throw_number():
    """The example is the config's conveyor in other units of length and time, on a climbing track."""
    gravity, frequency = math.cos(0.4), 2.0
    paper, unit = Conveyor(), math.cos(0.4) / 4.0
    example = {
        "inclination": 0.4,
        "frequency": frequency * paper.frequency,
        "damping": frequency * paper.damping,
        "stiffness": gravity / unit**paper.exponent * paper.stiffness,
    }
    settings = {**BOX, "throw_number": {"start": 0.5, "stop": 1.1, "num": 3}, "starts": 32}
    settings["model"] = {name: getattr(paper, name) for name in ("frequency", "gravity", "inclination", "angle")}
    found = throws.make({"other": example}, settings)
    one, other = (found[found.conveyor == name].sort_values(["vertical", "starts"]) for name in ("paper", "other"))
    assert one.vertical.unique() == pytest.approx([0.5, 0.8, 1.1])
    assert other.vertical.tolist() == pytest.approx(one.vertical.tolist())
    for name in ("state", "period", "starts"):
        assert one[name].tolist() == other[name].tolist()
    assert ((one.textbook > 0.0) == (one.vertical > 1.0)).all()


def test_differences_of_parts_that_no_overlay_states_are_assumed():
    config = si_config()
    assert settings.assumed_parts(config, {}) == ["friction", "damping", "stiffness", "mass", "acceleration"]
    stated = {"prefix": "mine", "parts": {"friction": 0.15, "mass": 0.0}}
    assert settings.assumed_parts(config, stated) == ["damping", "stiffness", "acceleration"]


def test_the_chart_names_the_parameters_that_are_the_papers_because_the_config_states_none(refined):
    stated = {"model": {"frequency": 100.0, "angle": 0.3, "friction": 0.3}}
    assumed = settings.assumed_model(stated, ["damping"])
    assert assumed == ["mass", "stiffness"]
    told = "so that they are the paper's: mass (0.001 kg) and stiffness (500000 N/m^1.5). If yours differ"
    assert told in page_of(refined, advised(), (), assumed)
    assert "the paper's" not in page_of(refined, advised())


def test_the_chart_says_what_the_supply_does_and_how_exactly_a_controller_must_hold_the_amplitude(refined):
    rows, advice_rows, changes = advised()
    assert "What the supply does" not in page_of(refined, [rows, advice_rows, changes])
    own = {"voltage": 0.05, "frequency": 0.5, "resonance": 52.0, "damping_ratio": 0.02, "force": "voltage²"}
    advice_rows.attrs |= {"range": [0.74, 1.38], "supply": own}
    held = {"lowest": 22.9, "highest": 42.8, "worst": 38.0, "held_low": 30.0, "held_high": 32.5}
    advice_rows = advice_rows.assign(**held)
    page = " ".join(page_of(refined, [rows, advice_rows, changes]).split())
    assert (
        "its resonance at 52 Hz (damping ratio 0.02). At 50 Hz, a force drives it that grows with the square of" in page
    )
    assert (
        "The voltage may differ by 5 % and the frequency by 0.5 Hz, so that the amplitude is 0.74 to 1.38 times" in page
    )
    assert "Set to 31 m/s² (fast), the plate has 22.9 to 42.8 m/s². At worst, at 38 m/s², the slowest 5 %" in page
    assert "have 1 cm/s instead of 2 cm/s. To keep 90 % of these, a controller must hold the amplitude between" in page
    assert "between 30 and 32.5 m/s² (-3.2 % to +4.8 %)" in page
    assert "% too large or too small" not in page
    assert "as far off as the supply makes it (-26 % to +38 %)" in page
    page = page_of(refined, [rows[rows.acceleration == 31.0], advice_rows, changes])
    assert "have 1 cm/s instead of 2 cm/s.\n" in page and "a controller must hold" not in page


def test_the_chart_names_a_recording_that_it_does_not_use(refined):
    assert "recording" not in page_of(refined, advised())
    assert "Name `results/a/measured_drive.yaml` behind your config" in page_of(
        refined, advised(), measured_drive="results/a/measured_drive.yaml"
    )
    config = {"excitation": {"measured": "mine.csv"}}
    measured = {"model": {"acceleration": 40.0, "frequency": 50.0, "harmonics": [], "angle": 0.2, "phase_shift": 0.1}}
    assert settings.uses_recording({"excitation": {}}, {})
    assert settings.uses_recording(config, measured)
    assert not settings.uses_recording(config, {"model": {"mass": 1e-3}})


def test_a_drive_that_feeds_backwards_is_named(refined):
    page = page_of(refined, advised(velocity_worst=-0.02, velocity_50=-0.01))
    assert "Most parts move backwards there" in page and "may be better" not in page.split("##")[0]


def test_parts_beyond_the_range_of_the_model_are_an_error_with_the_key():
    config = si_config()
    own = settings.transit_settings({**config, "model": config["model"] | {"friction": 9.0}})
    with pytest.raises(JobError, match=r"parts.friction = 0.15 makes parts with friction from .* outside \[0, 10\]"):
        parts.population(np.array([40.0]), own)
