"""Shares of initial conditions: the box, its motions and their velocities, and the chart in words."""

import math

import numpy as np
import pandas as pd
import pytest
import yaml
from project import ROOT, read_config

from conveyor import Start, ensemble, simulate
from conveyor.analysis.attractors.labels import Labels, classify
from conveyor.solver.model import PSI0, VZ0, Z0, Conveyor, conveyor_motion, pack
from operating import advice, chart, parts, regimes, shares, throws
from pipeline.motions import motions
from pipeline.templates import format_range
from workflow.config.tables import TABLES

TEMPLATE = (ROOT / "workflow/templates/operating_chart.md").read_text()
BOX = {
    **read_config("operating")["operating"],
    "starts": 64,
    "settling": 2000,
    "followed": 2,
    "model": {},
}


def test_heights_are_above_the_plate_at_the_initial_phase():
    starts = np.array([[1e-4, 0.1, 0.0], [0.0, -0.2, 1.0], [3e-4, 0.0, 4.0]])
    rows = parts.parameters_of(np.array([30.0, 50.0]), starts, {"angle": 0.3})
    assert rows.shape == (6, 16)
    for row, acceleration, (height, velocity, phase) in zip(
        rows, np.repeat([30.0, 50.0], 3), np.tile(starts, (2, 1)), strict=True
    ):
        plate = conveyor_motion(Conveyor(acceleration=acceleration, angle=0.3, psi0=phase), np.zeros(1))["z"][0]
        assert row[Z0] - plate == pytest.approx(height, abs=1e-15)
        assert (row[VZ0], row[PSI0]) == (velocity, phase)


def test_initial_conditions_fill_the_box_and_depend_on_the_seed():
    starts = parts.starts_of_box({**BOX, "starts": 1000})
    for column, name in zip(starts.T, ("height", "vz0", "psi0"), strict=True):
        low, high = BOX[name]
        assert low <= column.min() < low + 0.02 * (high - low)
        assert high - 0.02 * (high - low) < column.max() <= high
    assert (starts == parts.starts_of_box({**BOX, "starts": 1000})).all()
    assert (starts != parts.starts_of_box({**BOX, "starts": 1000, "seed": 2})).all()


def test_motions_differ_by_conveyor_state_period_and_flight():
    found = Labels(
        state=np.array(["second", "first", "second", "chaos", "second", "second", "chaos"]),
        period=np.array([1, 1, 2, 0, 1, 1, 0]),
        longest_flight=np.array([0.92, 0.0, 0.92, np.nan, 1.9, 0.9201, np.nan]),
        cycles=np.zeros(7, dtype=np.int64),
        delta=np.zeros(7),
        v=np.zeros(7),
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
    return shares.motions_at(np.array([22.0, 40.0]), BOX)


def test_labels_agree_with_sweeps(table):
    """The same initial conditions as rows of a sweep, without shared chaotic sets."""
    parameters = parts.parameters_of(np.array([40.0]), parts.starts_of_box(BOX), {})
    found = motions(parameters, {**BOX, "axes": {"acceleration": [40.0]}})
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


def velocity(conveyor: Conveyor, start: Start, period: int, **settings) -> tuple[float, str]:
    """The mean velocity of one initial condition that has settled vertically after twenty cycles, and its status."""
    labels = Labels(np.array(["second"]), np.array([period]), np.zeros(1), np.array([20]), np.zeros(1), np.zeros(1))
    (found,), _, (status,) = shares.velocities(pack(conveyor, start)[None], labels, {**BOX, **settings})
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


def test_velocities_are_means_over_whole_periods():
    """A motion with a period of four cycles, over a number of cycles that is not a multiple of four."""
    conveyor = Conveyor(acceleration=61.8)
    assert classify(pack(conveyor, Start(3e-4))[None]).period.tolist() == [4]
    found, status = velocity(conveyor, Start(3e-4), 4, cycles=251)
    x = simulate(conveyor, Start(3e-4), duration=40.0).sample(np.array([32.0, 40.0]))["x"]
    assert status == "ok"
    assert found == pytest.approx((x[1] - x[0]) / 8.0, rel=1e-7)


def test_runs_with_the_same_beginning_are_followed_once():
    """The means over the beginning of a run and over the whole run equal the means of two runs."""
    rows = np.array([pack(Conveyor(acceleration=a), Start(z0)) for a in (40.0, 80.0) for z0 in (0.0, 3e-4)])
    durations = np.array([[0.4, 0.6], [0.4, 0.8], [0.2, 0.8], [0.4, 0.9]])
    means, peaks, status = shares.last_quarters(rows, durations, 1e-9, 1)
    for k, (mean, duration) in enumerate(zip(means.T, durations.T, strict=True)):
        alone = ensemble.run(rows, duration=duration, tolerance=1e-9)
        assert mean.tolist() == alone["mean_velocity"].tolist()
        if k == 1:  # peaks of the longest run
            np.testing.assert_array_equal(peaks, np.column_stack([alone["impact_speed"], alone["peak_force"]]))
    assert (status == "ok").all()


def test_samples_of_both_first_runs_ascend(monkeypatch):
    """Also if a mean covers less than a period."""
    wanted = []

    def last_quarters(parameters, durations, *_):
        wanted.append(durations)
        return np.ones_like(durations), np.ones((len(durations), 2)), np.full(len(durations), "ok")

    monkeypatch.setattr(shares, "last_quarters", last_quarters)
    for period in (0, 1, 100, 400):
        velocity(Conveyor(), Start(0.0), period, cycles=1)
    assert all((0.75 * durations[:, 1:] >= durations[:, :-1]).all() for durations in wanted)


def test_brief_runs_take_means_over_whole_periods():
    """A motion with a period of four cycles, whose velocity differs from cycle to cycle."""
    rows = pack(Conveyor(acceleration=61.8), Start(3e-4))[None]
    options, labels = {**BOX, "cycles": 250}, classify(rows)
    assert labels.period.tolist() == [4]
    found, peaks, status = shares.brief_velocities(rows, labels, options)
    long, long_peaks, _ = shares.velocities(rows, labels, options)
    assert status.tolist() == ["ok"]
    assert found == pytest.approx(long, rel=1e-3)
    assert peaks == pytest.approx(long_peaks, rel=1e-5)
    assert (shares.brief_durations(rows, np.array([4]), 250) * 50.0).tolist() == pytest.approx([256.0])


def test_brief_runs_are_as_long_as_friction_needs():
    """On a track steeper than friction holds, no length helps."""
    rows = np.array([pack(Conveyor(inclination=alpha), Start()) for alpha in (0.0, -0.147, 0.14888, 0.2)])
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
        return Labels(np.full(n, states), np.ones(n, np.int64), np.zeros(n), np.arange(n), np.zeros(n), np.zeros(n))

    monkeypatch.setattr(shares, "motions_of_starts", motions_found)
    velocities = np.array([1.0, 3.0]), np.array([[0.1, 2.0], [0.2, 1.0]]), np.array(statuses, dtype=object)
    monkeypatch.setattr(shares, "velocities", lambda *_, **__: velocities)
    row = shares.motions_at(np.array([40.0]), BOX).iloc[0]
    assert (row.mean_velocity, row.velocity_stderr, row.status) == pytest.approx(wanted, nan_ok=True)
    assert row.starts == BOX["starts"]
    peaks = (0.2, 2.0) if row.status == "ok" else (np.nan, np.nan)
    assert (row.impact_speed, row.peak_force) == pytest.approx(peaks, nan_ok=True)


def test_the_standard_error_agrees_with_repeated_draws():
    drawn = [
        shares.motions_at(np.array([40.0]), {**BOX, "seed": seed}).set_index("state").loc["first"] for seed in range(30)
    ]
    share = np.array([row.share for row in drawn])
    # A standard deviation from thirty draws is known to an eighth.
    assert share.std(ddof=1) == pytest.approx(np.mean([row.stderr for row in drawn]), rel=0.4)


def test_machines_with_equal_dimensionless_groups_have_equal_shares(table):
    """Lengths in g/ω², velocities in g/ω: another frequency, gravity and mass, with matching damping and stiffness."""
    paper = Conveyor()
    frequency, gravity, mass = 3.0, 1.7, 5.0
    length, velocity = gravity / frequency**2, gravity / frequency
    model = {
        "frequency": frequency * paper.frequency,
        "gravity": gravity * paper.gravity,
        "mass": mass * paper.mass,
        "damping": mass * frequency * paper.damping,
        "stiffness": mass * gravity / length**paper.exponent * paper.stiffness,
    }
    box = {"height": [length * end for end in BOX["height"]], "vz0": [velocity * end for end in BOX["vz0"]]}
    other = shares.motions_at(gravity * np.array([22.0, 40.0]), {**BOX, **box, "model": model})
    for name in ("state", "period", "starts", "share", "stderr", "motion"):
        assert (other[name] == table[name]).all(), name
    assert np.allclose(other.vertical, table.vertical, rtol=1e-12)
    assert np.allclose(other.mean_velocity, velocity * table.mean_velocity, rtol=1e-6)


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


SETTINGS = {**BOX, "acceleration": {"start": 20.0, "stop": 60.0, "num": 9}, "resolution": 0.2, "starts": 100}


@pytest.fixture
def refined(monkeypatch) -> pd.DataFrame:
    monkeypatch.setattr(shares, "motions_at", made_up)
    found = shares.make(SETTINGS)["shares"]
    found.attrs = SETTINGS | {"model": {"friction": 0.15, "angle": 0.21, "mass": 1e-3, "gravity": 10.0}}
    return found


def test_amplitudes_are_halved_where_the_answer_changes(refined):
    places = refined.acceleration.unique()
    assert (np.diff(places) > 0.0).all()
    for change in (31.4, 50.0):
        below, above = places[places <= change].max(), places[places > change].min()
        assert above - below <= SETTINGS["resolution"]
    assert len(places) < 30


@pytest.mark.parametrize(
    ("ends", "words"),
    [((0.0648, 0.141), "0.0648 to 0.141"), ((0.1, 0.10001), "0.1"), ((np.nan, np.nan), "not known")],
)
def test_numbers_in_words(ends, words):
    assert format_range(ends) == words


def test_chaos_begins_at_its_lowest_amplitude():
    """Also if motion is regular at a higher amplitude."""
    found = pd.DataFrame(
        {
            "regime": [regimes.ONE, regimes.BESIDE, regimes.ONE, regimes.CHAOS],
            "states": ["first", "chaos, first", "second", "chaos"],
            "begin": [20.0, 30.0, 40.0, 50.0],
            "end": [29.0, 39.0, 49.0, 60.0],
        }
    )
    parts = chart.summarize_regimes(found)
    assert [row["begin"] for row in parts["chaos"]] == [30.0]
    assert [(row["begin"], row["end"]) for row in parts["only_chaos"]] == [(50.0, 60.0)]
    assert parts["unknown"] == []


def advised() -> tuple[pd.DataFrame, pd.DataFrame]:
    """Made-up tables of advice and changes for one aim."""
    row = {
        **{"aim": "certain", "acceleration": 31.0, "throw_number": 0.66, "state": "first", "period": 1},
        **{"mean_velocity": 0.01, "share": 1.0, "stderr": 0.0, "knock": 0.05, "largest_kick": 0.2},
        **{"impact_speed": 0.1, "peak_force": 0.5, "textbook": 0.0},
    }
    changes = {"aim": "certain", "regime": "one velocity", "mean_velocity": 0.012}
    changes = [
        {**changes, "parameter": "friction", "value": 0.17, "gain": 0.2},
        {**changes, "parameter": "angle", "value": 0.2, "gain": -0.2},
        {**changes, "parameter": "angle", "value": 0.24, "gain": 0.1},
        {**changes, "parameter": "mass", "value": 1.0, "gain": 0.5, "regime": regimes.CHAOS},
    ]
    tables = pd.DataFrame([row]), pd.DataFrame(changes)
    tables[0].attrs = {"margin": 0.01, "part_length": 0.02}
    return tables


def intervals_of(table: pd.DataFrame) -> pd.DataFrame:
    return regimes.intervals_of(regimes.summarize_amplitudes(table, SETTINGS["same_velocity"]), table)


def test_the_page_begins_with_the_advice(refined):
    page = chart.make(TEMPLATE, refined, intervals_of(refined), *advised())
    assert page.startswith("# Operating chart\n\n## Recommended amplitudes\n")
    assert (
        "- **Amplitude 31 m/s²** (peak acceleration along the direction of vibration), throw number Γ = 0.66\n" in page
    )
    assert "- At most 30 parts of 20 mm per minute, one behind the other\n" in page
    assert "all 100 random initial conditions reach this velocity. At 95 % confidence, fewer than 3 % of all" in page
    assert "A sudden change of the part's velocity by 0.05 m/s normal to the track can end this motion" in page
    assert "- Impact speed 0.1 m/s, peak force 0.5 N (50 times the weight of the part)\n" in page
    assert "  - friction of 0.17 (now 0.15): +20 %, one velocity\n" in page
    assert "  - angle of 13.8° (now 12°): +10 %, one velocity\n" in page
    assert page.count("(now ") == 2
    assert "mass of" not in page
    assert "Faster on average" not in page


def test_advice_must_hold_within_the_margin(refined):
    """One velocity up to 31.4 m/s², and the largest product of velocity and share above 40 m/s²."""
    found = advice.recommended(refined, 0.01)
    assert 20.0 <= found["certain"] <= 31.4 / 1.01
    assert 40.0 <= found["fast"] <= 50.0 / 1.01
    # Up to twice their amplitude there are two velocities everywhere, and chaos from 50 m/s² on.
    wide = advice.recommended(refined, 0.99)
    assert wide.keys() == {"fast"}
    assert wide["fast"] <= 50.0 / 1.99


def test_worst_of_neighbours():
    places, scores = np.array([1.0, 1.05, 1.5, 2.0]), np.array([3.0, 1.0, 5.0, 4.0])
    assert advice.worst_within(places, scores, 0.1).tolist() == [1.0, 1.0, 5.0, 4.0]


def test_a_settled_motion_goes_on_and_a_large_kick_ends_it(table):
    """At 40 m/s² one of the kicks tried is the smallest that ends the first state; smaller kicks do not end it."""
    motion = table[(table.acceleration == 40.0) & (table.state == "first")].iloc[0]
    rows = advice.settled(motion, BOX, 4)
    assert advice.is_motion(classify(rows), motion).all()
    sizes = np.geomspace(1e-4, 0.4, 30)
    knock = advice.smallest_knock(rows, motion, sizes, BOX)
    assert 1e-4 < knock < 0.4
    assert np.isnan(advice.smallest_knock(rows, motion, sizes[sizes < knock], BOX))
    # The label of a single kicked part, at the phase at which the kick has the largest effect.
    at_knock = np.repeat(rows, 2, axis=0)
    at_knock[:, VZ0] += np.tile([-knock, knock], len(rows))
    assert (classify(at_knock).state == "second").any()


def test_advice_has_the_numbers_of_its_motion_and_of_changed_conveyors():
    settings = TABLES["operating/shares"](read_config()) | {"starts": 32, "followed": 2, "cycles": 50, "settling": 2000}
    table = shares.motions_at(np.array([22.0, 23.0]), settings)
    table.attrs = settings
    options = {"margin": 0.01, "phases": 2, "kicks": 5, "smallest_kick": 0.01}
    found = advice.make(table, {**options, "changes": {"phase_shift": 0.175, "friction": 0.02}})
    told, changes = pd.DataFrame(found["advice"]), pd.DataFrame(found["changes"])
    motion = table[table.acceleration == 23.0].iloc[0]
    assert told.aim.tolist() == ["certain", "fast"]
    for name in ("acceleration", "state", "period", "mean_velocity", "impact_speed", "peak_force"):
        assert (told[name] == motion[name]).all(), name
    assert (told.throw_number == motion.vertical).all()
    assert (told.textbook == 0.0).all()
    assert (told.share == 1.0).all()
    certain = changes[changes.aim == "certain"].reset_index(drop=True)
    friction = settings["model"]["friction"]
    assert certain.parameter.tolist() == ["phase_shift", "phase_shift", "friction", "friction"]
    assert certain.value.tolist() == pytest.approx([-0.175, 0.175, friction - 0.02, friction + 0.02])
    changed = {**settings, "model": settings["model"] | {"phase_shift": 0.175}}
    alone = shares.motions_at(np.array([23.0]), changed).mean_velocity[0]
    assert certain.mean_velocity[1] == pytest.approx(alone, rel=1e-9)
    assert certain.gain[1] == pytest.approx(alone / motion.mean_velocity - 1.0)
    assert (certain.regime == regimes.ONE).all()


def test_the_share_of_the_advice_covers_all_motions_with_its_velocity(refined, monkeypatch):
    """Above 40 m/s² two motions have the same velocity: 24 and 10 of 100 initial conditions reach them."""
    monkeypatch.setattr(advice, "settled", lambda *_, **__: None)
    monkeypatch.setattr(advice, "smallest_knock", lambda *_, **__: np.nan)
    monkeypatch.setattr(advice, "changes_at", lambda *_, **__: [])
    refined = refined.assign(impact_speed=0.1, peak_force=1.0)
    refined.attrs["model"] |= {"frequency": 50.0}
    options = {"margin": 0.01, "phases": 2, "kicks": 5, "smallest_kick": 0.01, "changes": {}}
    told = pd.DataFrame(advice.make(refined, options)["advice"]).set_index("aim")
    assert told.share.to_dict() == pytest.approx({"certain": 1.0, "fast": 0.34})
    assert told.stderr["fast"] == pytest.approx(math.sqrt(0.34 * 0.66 / 100))
    assert told.mean_velocity.to_dict() == {"certain": 0.01, "fast": 0.06}


def test_changes_of_a_parameter_keep_the_static_friction_above_the_friction():
    model = {"friction": 0.15, "static_friction": 0.16, "angle": 0.2}
    assert advice.with_parameter(model, "friction", 0.2)["static_friction"] == 0.2
    assert advice.with_parameter(model, "friction", 0.1)["static_friction"] == 0.16
    assert advice.with_parameter({"friction": 0.15}, "friction", 0.2) == {"friction": 0.2}


def test_regimes_and_their_words(refined):
    found = intervals_of(refined)
    assert list(found.regime) == [regimes.ONE, regimes.SEVERAL, regimes.BESIDE, regimes.CHAOS]
    assert list(found.best_share_low) == pytest.approx([1.0, 0.3, 0.2, 1.0])
    assert list(found.best_share_high) == pytest.approx([1.0, 0.34, 0.2, 1.0])
    assert list(found.velocity_low) == [0.01, 0.01, 0.05, 0.05]
    assert list(found.states) == ["first", "first, second", "chaos, second", "chaos"]
    assert found.best_share_stderr[1] == pytest.approx(math.sqrt(0.34 * 0.66 / 100))
    # The amplitudes of the config are 5 m/s² apart; closer ones were added where the answer changes.
    assert list(found.step[:2]) == [5.0, 5.0]
    page = chart.make(TEMPLATE, refined, found, *advised())
    assert "All initial conditions reach one velocity at 20.0 to 31.2 m/s² (first state, 0.01 m/s)." in page
    assert "Several velocities exist side by side, without chaos, at 31.4 to 50.0 m/s²" in page
    assert "\n30 to 34 % of the initial conditions reach it." in page
    assert "This share is largest (34.0 ± 4.7 %) at 40 m/s², with 0.06 m/s." in page
    assert "Chaos begins at 50.2 m/s². All initial conditions end in chaos at 56.1 to 60.0 m/s²." in page
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
    assert regimes.regime_of(np.array(states), np.array(velocities), 0.02) == regime


def test_a_table_without_known_amplitudes_gives_no_advice(refined):
    """The table has a single amplitude, whose regime is not known."""
    alone = refined[refined.acceleration == 20.0].assign(state="undecided", mean_velocity=np.nan)
    page = chart.make(TEMPLATE, alone, intervals_of(alone), *(table.iloc[:0] for table in advised()))
    assert "There is no amplitude at which every part reaches the same velocity with an amplitude error of 1 %." in page
    assert "At no amplitude do all initial conditions reach one velocity" in page
    assert "No initial condition ends in chaos" in page
    assert "At 20.0 m/s², the state or the velocity of a motion is not known." in page
    assert "| 20.0 | 0.426 | unknown | undecided | not known | not known | not known |" in page


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
    found = throws.make([yaml.safe_dump({"prefix": "other", "model": example})], settings)
    one, other = (found[found.conveyor == name].sort_values(["vertical", "starts"]) for name in ("paper", "other"))
    assert one.vertical.unique() == pytest.approx([0.5, 0.8, 1.1])
    assert other.vertical.tolist() == pytest.approx(one.vertical.tolist())
    for name in ("state", "period", "starts"):
        assert one[name].tolist() == other[name].tolist()
    assert ((one.textbook > 0.0) == (one.vertical > 1.0)).all()
