"""Shares of starts: the box, its motions and their velocities, and what is said of them."""

import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT, read_config

from conveyor import Start, ensemble, simulate
from conveyor.analysis.attractors.labels import Labels, classify
from conveyor.solver.model import Conveyor, conveyor_motion, pack
from operating import chart, regimes, shares
from pipeline.motions import motions

BOX = {
    **read_config("operating")["operating"],
    "starts": 64,
    "settling": 2000,
    "followed": 2,
    "model": {},
}


def test_heights_are_above_the_plate_at_the_phase_of_the_start():
    starts = np.array([[1e-4, 0.1, 0.0], [0.0, -0.2, 1.0], [3e-4, 0.0, 4.0]])
    rows = shares.parameters_of(np.array([30.0, 50.0]), starts, {"angle": 0.3})
    assert rows.shape == (6, 16)
    for row, acceleration, (height, velocity, phase) in zip(
        rows, np.repeat([30.0, 50.0], 3), np.tile(starts, (2, 1)), strict=True
    ):
        plate = conveyor_motion(Conveyor(acceleration=acceleration, angle=0.3, psi0=phase), np.zeros(1))["z"][0]
        assert row[11] - plate == pytest.approx(height, abs=1e-15)
        assert (row[12], row[3]) == (velocity, phase)


def test_starts_fill_the_box_and_follow_the_seed():
    starts = shares.starts_of_box({**BOX, "starts": 1000})
    for column, name in zip(starts.T, ("height", "vz0", "psi0"), strict=True):
        low, high = BOX[name]
        assert low <= column.min() < low + 0.02 * (high - low)
        assert high - 0.02 * (high - low) < column.max() <= high
    assert (starts == shares.starts_of_box({**BOX, "starts": 1000})).all()
    assert (starts != shares.starts_of_box({**BOX, "starts": 1000, "seed": 2})).all()


def test_motions_are_told_apart_by_state_period_and_flight():
    found = Labels(
        state=np.array(["second", "first", "second", "chaos", "second", "second", "chaos"]),
        period=np.array([1, 1, 2, 0, 1, 1, 0]),
        longest_flight=np.array([0.92, 0.0, 0.92, np.nan, 1.9, 0.9201, np.nan]),
        cycles=np.zeros(7, dtype=np.int64),
    )
    number = shares.groups(found)
    assert number[0] == number[5]
    assert number[3] == number[6]
    assert len(set(number)) == 5


@pytest.fixture(scope="module")
def table():
    """Shares at two amplitudes with one and with two motions."""
    return pd.DataFrame(shares.motions_at(np.array([22.0, 40.0]), BOX))


def test_labels_are_those_of_sweeps(table):
    """The same starts as rows of a sweep, whose chaotic sets are not shared."""
    parameters = shares.parameters_of(np.array([40.0]), shares.starts_of_box(BOX), {})
    found = motions(parameters, {**BOX, "axes": {"acceleration": [40.0]}})
    own = table[table.acceleration == 40.0].set_index("state").starts
    assert own.to_dict() == pd.Series(found.state).value_counts().to_dict()
    assert own.sum() == BOX["starts"]


def test_velocities_are_means_over_whole_cycles(table):
    """Those of one long run by itself, over fifty cycles behind its first hundred."""
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
    """The mean velocity of one start that has settled vertically after twenty cycles, and its status."""
    (found,), _, (status,) = shares.velocities(
        pack(conveyor, start)[None], np.array([period]), np.array([20]), {**BOX, **settings}
    )
    return found, status


def test_velocities_wait_for_a_slow_horizontal_motion():
    """With little friction the part gains speed for thousands of cycles, long after it has settled vertically."""
    conveyor = Conveyor(friction=1e-3)
    found, status = velocity(conveyor, Start(3e-4), 1, cycles=20)
    x = simulate(conveyor, Start(3e-4), duration=100.0).sample(np.array([99.0, 100.0]))["x"]
    assert status == "ok"
    plate = 40.0 * math.cos(conveyor.angle) / (100.0 * math.pi)
    assert found == pytest.approx(x[1] - x[0], abs=2.0 * shares.SETTLED * plate)
    # With less still it is not known within six doublings.
    found, status = velocity(Conveyor(friction=1e-5), Start(3e-4), 1, cycles=20)
    assert np.isnan(found)
    assert status == "mean velocity not settled"


def test_velocities_are_means_over_whole_periods():
    """Of a motion of four cycles, behind the second doubling, asked for over a number of cycles that is no multiple."""
    conveyor = Conveyor(acceleration=61.8)
    assert classify(pack(conveyor, Start(3e-4))[None]).period.tolist() == [4]
    found, status = velocity(conveyor, Start(3e-4), 4, cycles=251)
    x = simulate(conveyor, Start(3e-4), duration=40.0).sample(np.array([32.0, 40.0]))["x"]
    assert status == "ok"
    assert found == pytest.approx((x[1] - x[0]) / 8.0, rel=1e-7)


def test_runs_that_begin_alike_are_followed_once():
    """The means of a run's beginning and of all of it are those of two runs."""
    rows = np.array([pack(Conveyor(acceleration=a), Start(z0)) for a in (40.0, 80.0) for z0 in (0.0, 3e-4)])
    durations = np.array([[0.4, 0.6], [0.4, 0.8], [0.2, 0.8], [0.4, 0.9]])
    means, peaks, status = shares.last_quarters(rows, durations, 1e-9, 1)
    for k, (mean, duration) in enumerate(zip(means.T, durations.T, strict=True)):
        alone = ensemble.run(rows, duration=duration, tolerance=1e-9)
        assert mean.tolist() == alone["mean_velocity"].tolist()
        if k == 1:  # peaks are those of the longest run
            np.testing.assert_array_equal(peaks, np.column_stack([alone["impact_speed"], alone["peak_force"]]))
    assert (status == "ok").all()


def test_samples_of_both_first_runs_ascend(monkeypatch):
    """Also where a mean is asked for over less than a period."""
    wanted = []

    def last_quarters(parameters, durations, *_):
        wanted.append(durations)
        return np.ones_like(durations), np.ones((len(durations), 2)), np.full(len(durations), "ok")

    monkeypatch.setattr(shares, "last_quarters", last_quarters)
    for period in (0, 1, 100, 400):
        velocity(Conveyor(), Start(0.0), period, cycles=1)
    assert all((0.75 * durations[:, 1:] >= durations[:, :-1]).all() for durations in wanted)


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
def test_velocities_of_a_motion_are_put_together(monkeypatch, states, statuses, wanted):
    def motions_found(parameters, *_, **__):
        n = len(parameters)
        return Labels(np.full(n, states), np.ones(n, np.int64), np.zeros(n), np.arange(n))

    monkeypatch.setattr(shares, "motions_of_starts", motions_found)
    velocities = np.array([1.0, 3.0]), np.array([[0.1, 2.0], [0.2, 1.0]]), np.array(statuses, dtype=object)
    monkeypatch.setattr(shares, "velocities", lambda *_, **__: velocities)
    row = pd.DataFrame(shares.motions_at(np.array([40.0]), BOX)).iloc[0]
    assert (row.mean_velocity, row.velocity_stderr, row.status) == pytest.approx(wanted, nan_ok=True)
    assert row.starts == BOX["starts"]
    peaks = (0.2, 2.0) if row.status == "ok" else (np.nan, np.nan)
    assert (row.impact_speed, row.peak_force) == pytest.approx(peaks, nan_ok=True)


def test_the_standard_error_is_that_of_repeated_draws():
    drawn = [
        pd.DataFrame(shares.motions_at(np.array([40.0]), {**BOX, "seed": seed})).set_index("state").loc["first"]
        for seed in range(30)
    ]
    share = np.array([row.share for row in drawn])
    # A standard deviation of thirty is known to an eighth.
    assert share.std(ddof=1) == pytest.approx(np.mean([row.stderr for row in drawn]), rel=0.4)


def test_machines_with_equal_dimensionless_groups_have_equal_shares(table):
    """Lengths in g/ω², velocities in g/ω: another frequency, gravity and mass with damping and stiffness that fit."""
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
    other = pd.DataFrame(shares.motions_at(gravity * np.array([22.0, 40.0]), {**BOX, **box, "model": model}))
    for name in ("state", "period", "starts", "share", "stderr", "motion"):
        assert (other[name] == table[name]).all(), name
    assert np.allclose(other.vertical, table.vertical, rtol=1e-12)
    assert np.allclose(other.mean_velocity, velocity * table.mean_velocity, rtol=1e-6)


def rows_at(acceleration: float) -> dict[str, list]:
    """Made-up motions: one velocity below 31.4 m/s², two up to 50, of one of which there are two kinds; chaos beside a
    jump beyond, and alone above 56.
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
    found = pd.DataFrame(shares.make(SETTINGS))
    found.attrs = SETTINGS
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
    assert chart.numbers(*ends) == words


def test_chaos_begins_where_it_is_first_seen():
    """Whatever is in between later on."""
    found = pd.DataFrame(
        {
            "regime": [regimes.ONE, regimes.BESIDE, regimes.ONE, regimes.CHAOS],
            "states": ["first", "chaos, first", "second", "chaos"],
            "begin": [20.0, 30.0, 40.0, 50.0],
            "end": [29.0, 39.0, 49.0, 60.0],
        }
    )
    assert chart.irregular(found, 0.2) == {"chaos": "30.0", "only": "50.0 to 60.0", "unknown": ""}


def test_regimes_and_their_words(refined):
    found = pd.DataFrame(regimes.make(refined))
    assert list(found.regime) == [regimes.ONE, regimes.SEVERAL, regimes.BESIDE, regimes.CHAOS]
    assert list(found.best_share_low) == pytest.approx([1.0, 0.3, 0.2, 1.0])
    assert list(found.best_share_high) == pytest.approx([1.0, 0.34, 0.2, 1.0])
    assert list(found.velocity_low) == [0.01, 0.01, 0.05, 0.05]
    assert list(found.states) == ["first", "first, second", "chaos, second", "chaos"]
    assert found.best_share_stderr[1] == pytest.approx(math.sqrt(0.34 * 0.66 / 100))
    # The config's own amplitudes lie 5 m/s² apart; nearer ones were looked at where the answer changes.
    assert list(found.step[:2]) == [5.0, 5.0]
    template = (ROOT / "workflow/templates/operating_chart.md").read_text()
    page = chart.make(template, refined, found)
    assert "Every start of the box ends in one velocity at 20.0 to 31.2 m/s² (first state, 0.01 m/s)." in page
    assert "Several velocities exist side by side, without chaos, at 31.4 to 50.0 m/s²" in page
    assert "30 to 34 % of the starts get, most of them (34.0 ± 4.7 %) at 40 m/s² with 0.06 m/s" in page
    assert "Chaos begins at 50.2 m/s²; it is all that the starts end in at 56.1 to 60.0 m/s²." in page
    assert "from the box of heights 0 to 0.5 mm above" in page
    assert "fewer than 3 % of the box do, at 95 %\nconfidence" in page
    assert "could not be decided" not in page


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


def test_nothing_is_said_that_is_not_there(refined):
    """A table of an unknown amplitude alone."""
    alone = refined[refined.acceleration == 20.0].assign(state="undecided", mean_velocity=np.nan)
    page = chart.make(
        (ROOT / "workflow/templates/operating_chart.md").read_text(), alone, pd.DataFrame(regimes.make(alone))
    )
    assert "At no amplitude does every start" in page
    assert "No start of the box ends in chaos" in page
    assert "At 20.0 m/s² a motion could not be decided" in page
    assert "| 20.0 | unknown | undecided | not known | not known | not known |" in page
