"""Switching on and off: half cycles against one run and against SciPy, where the motion changes, and the page."""

import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT, si_config
from scipy.integrate import solve_ivp

from conveyor import Conveyor, sample_runs
from conveyor_pipeline.config.tables import TABLES
from conveyor_pipeline.machine.operating import start, start_page
from conveyor_pipeline.machine.operating.parts import population
from conveyor_pipeline.machine.operating.populations import IDENTICAL
from conveyor_pipeline.machine.operating.ramps import ramp_ends

SETTINGS = {**TABLES["operating/start"](si_config()), "starts": 1}
HALF = 0.01  # s, of a cycle of 50 Hz
TEMPLATE = (ROOT / "workflow/rules/machine/start.md").read_text()


def rows_of(**model: float) -> tuple[np.ndarray, dict]:
    """The table of one part at an amplitude of 1 m/s², and its settings."""
    settings = {**SETTINGS, "model": SETTINGS["model"] | model}
    return population(np.ones(1), settings, IDENTICAL), settings


def test_a_part_on_a_plate_at_rest_stays_there():
    rows, settings = rows_of()
    motion = start.at_rest(rows)
    assert motion.gap[0] == pytest.approx(-((0.7e-3 * 9.81 / 5.0e5) ** (2.0 / 3.0)), rel=1e-12)
    path, after = start.follow(rows, np.zeros(6), motion, settings)
    assert np.abs(path.travelled).max() < 1e-12 and not path.flight.any()
    assert after.gap[0] == pytest.approx(motion.gap[0], rel=1e-6)


@pytest.mark.parametrize("shift", [0.0, 0.9])
def test_a_part_without_friction_keeps_its_velocity_while_the_amplitude_changes(shift):
    """In the frame of a plate with a phase shift it has this velocity on average over a cycle."""
    rows, settings = rows_of(friction=0.0, phase_shift=shift)
    amplitudes = 20.0 + np.arange(8.0)
    motion = start.at_rest(rows)
    plate = start.plate_at_ends(settings["model"])
    motion = motion._replace(slip=0.1 - amplitudes[0] * plate["vx"][:1])
    path, after = start.follow(rows, amplitudes, motion, settings)
    drift = np.concatenate([[0.0], np.cumsum(np.diff(amplitudes) * plate["vx"][[1, 0, 1, 0, 1, 0, 1]])])
    assert path.travelled[:, 0] == pytest.approx((0.1 + drift) * HALF, abs=1e-9)
    assert np.abs(drift).max() <= (0.0 if shift == 0.0 else plate["vx"][0]) + 1e-9
    assert after.slip[0] == pytest.approx(0.1 + drift[-1] - amplitudes[-1] * plate["vx"][0], abs=1e-9)


def test_half_cycles_of_one_amplitude_are_one_run():
    """Also with a phase shift and harmonics of the plate."""
    harmonics = [{"order": 2, "along": 0.1, "along_phase": 0.3, "normal": 0.1, "normal_phase": 1.0}]
    rows, settings = rows_of(phase_shift=0.5, harmonics=harmonics)
    motion = start.at_rest(rows)._replace(rate=np.array([0.3]))
    path, _ = start.follow(rows, np.full(40, 40.0), motion, settings)
    plate = start.plate_at_ends(settings["model"])
    whole = rows.copy()
    whole["acceleration"], whole["psi0"] = 40.0, 0.0
    whole["z0"], whole["vz0"] = 40.0 * plate["z"][0] + motion.gap, 40.0 * plate["vz"][0] + motion.rate
    times = HALF * np.arange(41.0)[None]
    run = sample_runs(whole, times, columns=["x"], vx0=40.0 * plate["vx"][:1], tolerance=settings["tolerance"])
    assert np.cumsum(path.travelled[:, 0]) == pytest.approx(run.x[0, 1:], abs=1e-7)


def reference(first: float, rate: float, begin: start.Motion, cycles: int) -> np.ndarray:
    """Positions x (m) at the end of each cycle by SciPy, for an amplitude that changes evenly, by `rate` (m/s³).

    The plate moves as z_s = -a(t)/ω² cos ωt, with all terms of its velocity. Friction is steep, but continuous.
    """
    c, omega = Conveyor(), 2.0 * math.pi * 50.0
    normal, along = math.sin(c.angle), math.cos(c.angle)

    def plate(t):
        a = first + rate * t
        position = -a / omega**2 * math.cos(omega * t)
        velocity = a / omega * math.sin(omega * t) - rate / omega**2 * math.cos(omega * t)
        return position, velocity

    def motion(t, state):
        _, vx, z, vz = state
        position, velocity = plate(t)
        gap, closing = z - normal * position, vz - normal * velocity
        force = (c.stiffness * max(-gap, 0.0) ** c.exponent - c.damping * closing) / c.mass if gap <= 0.0 else 0.0
        rub = c.friction * force * math.tanh((along * velocity - vx) / 2e-4)
        return vx, rub, vz, force - c.gravity

    position, velocity = plate(0.0)
    at = [along * velocity + begin.slip[0], normal * position + begin.gap[0], normal * velocity + begin.rate[0]]
    ends = np.arange(cycles + 1) / 50.0
    run = solve_ivp(motion, (0.0, ends[-1]), [0.0, *at], "LSODA", ends, rtol=1e-7, atol=1e-10, max_step=5e-4)
    return run.y[0]


def settled_jump(rows: np.ndarray, settings: dict) -> start.Motion:
    """The jumping motion at 40 m/s², to which a part that is released at a height of 0.3 mm settles."""
    released = start.at_rest(rows)._replace(gap=np.array([3.85e-4]))
    path, motion = start.follow(rows, np.full(120, 40.0), released, settings)
    assert path.flight[-2:].max() > 0.9
    return motion


@pytest.mark.parametrize(("first", "last", "jumps"), [(30.0, 44.0, False), (40.0, 30.0, True)])
def test_slow_ramps_are_those_of_an_amplitude_that_changes_evenly(first, last, jumps):
    """A part that rides on the way up, and one that jumps on the way down: velocities over ten cycles each."""
    rows, settings = rows_of()
    cycles = 40
    slope = (last - first) / (cycles / 50.0)
    amplitudes = first + slope * HALF * (np.arange(2 * cycles) + 0.5)
    motion = settled_jump(rows, settings) if jumps else start.at_rest(rows)
    path, _ = start.follow(rows, amplitudes, motion, settings)
    x = reference(first, slope, motion, cycles)
    travelled = path.travelled[:, 0].reshape(cycles, 2).sum(axis=1)
    assert (path.flight.max() >= 0.5) == jumps
    for begin in (0, 10, 20, 30):
        exact = (x[begin + 10] - x[begin]) / 0.2
        assert travelled[begin : begin + 10].sum() / 0.2 == pytest.approx(exact, rel=0.03, abs=2e-4)


def test_motions_of_the_papers_conveyor_live_to_their_folds():
    """On the way up, the riding motion ends in a fold at 59.32 m/s²; on the way down, the jumping one at 23.98."""
    rows, settings = rows_of()
    up, down = start.slow_amplitudes(54.0, 62.0), start.slow_amplitudes(21.0, 40.0)[::-1]
    rising, _ = start.follow(rows, up, start.at_rest(rows), settings)
    assert 59.32 < up[np.argmax(rising.flight[:, 0] >= 0.5)] < 60.2
    falling, _ = start.follow(rows, down, settled_jump(rows, settings), settings)
    assert 23.0 < down[np.flatnonzero(falling.flight[:, 0] >= 0.5)[-1]] < 23.98


def test_limits_are_quantiles_of_the_parts_that_differ():
    """Part 0 is that of the config. Part 3 never jumps on the way up, and down to the lowest amplitude."""
    up = np.array([20.0, 30.0, 40.0])
    rising = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.9, 0.0, 0.0], [0.9, 0.9, 0.9, 0.0]])
    falling = np.array([[0.9, 0.9, 0.9, 0.9], [0.0, 0.9, 0.0, 0.9], [0.0, 0.0, 0.0, 0.9]])
    paths = [start.Path(flight, flight, flight) for flight in (rising, falling)]
    found = pd.DataFrame(start.limits_of(up, up[::-1], tuple(paths)))
    assert found.acceleration.replace({np.nan: None}).tolist() == [40.0, 30.0, 40.0, None, 40.0, 40.0, 30.0, None]
    assert found.status.tolist() == ["ok", "ok", "ok", start.RIDE, "ok", "ok", "ok", start.JUMP_FIRST]


@pytest.mark.parametrize(
    ("rising", "falling", "sentence", "row"),
    [
        ([0.9, 0.9], [0.9, 0.9], "Half of the parts jump already at 20 m/s²", "| below 20 | below 20 |"),
        ([0.0, 0.9], [0.9, 0.9], "half of the parts still jump at 20 m/s²", "| 40 | below 20 |"),
        ([0.0, 0.9], [0.9, 0.0], "half of the parts stop jumping at 40 m/s²", "| 40 | 40 |"),
        ([0.0, 0.0], [0.0, 0.0], "ride at all amplitudes up to 42 m/s²", "| above 42 | ride at all amplitudes |"),
    ],
)
def test_the_page_does_not_take_the_end_of_a_ramp_for_the_end_of_a_motion(made, rising, falling, sentence, row):
    advice, tables = made
    up, flights = np.array([20.0, 40.0]), [np.tile(np.array(way)[:, None], (1, 5)) for way in (rising, falling)]
    paths = tuple(start.Path(flight, flight, flight) for flight in flights)
    limits = pd.DataFrame(start.limits_of(up, up[::-1], paths))
    ramps = tables["start"].assign(acceleration=np.resize(up, len(tables["start"])))
    ramps.attrs = {**ramps.attrs, "acceleration": [0.0, 20.0, 40.0]}
    changed = tables | {"start": ramps, "start_limits": limits}
    page = start_page.make(TEMPLATE, advice, *(changed[name] for name in start.TABLES))
    assert sentence in page.splitlines()[2]
    assert f"| 50 % of the parts that differ {row}" in page


def test_slow_ramps_pass_all_amplitudes_above_zero_and_some_more():
    assert ramp_ends([0.0, 20.0, 60.0]) == (20.0, 63.0)
    assert ramp_ends([30.0]) == (15.0, 31.5)


def test_parts_that_slide_away_are_lost_and_end_nothing():
    """On a track that is too steep, a part is soon faster than any run may begin."""
    row, settings = rows_of(inclination=0.5, friction=0.3)
    rows = np.concatenate([row, row])
    moving = start.at_rest(rows)._replace(slip=np.array([-99.99, 0.0]))
    path, _ = start.follow(rows, np.full(4, 30.0), moving, settings)
    assert np.isnan(path.travelled[-1, 0]) and np.isfinite(path.travelled[-1, 1])


def test_the_page_says_that_it_does_not_follow_blocks(made):
    advice, tables = made
    page = start_page.make(TEMPLATE, advice, *(tables[name] for name in start.TABLES), has_body=True)
    assert "not the blocks of the section `body`" in page.splitlines()[2]


def test_where_fewer_than_half_of_the_parts_jump_no_amplitude_is_named_at_which_half_of_them_stop(made):
    advice, tables = made
    limits = tables["start_limits"].copy()
    limits.loc[(limits.way == "up") & (limits.share == 0.05), ["acceleration", "status"]] = [40.0, "ok"]
    page = start_page.make(TEMPLATE, advice, *((tables | {"start_limits": limits})[name] for name in start.TABLES))
    assert "at most half of the parts jump at any amplitude" in page.splitlines()[2]


def test_a_motion_repeats_itself_if_its_gaps_do():
    cycle = np.arange(40.0)
    gaps = np.column_stack([np.ones(40), cycle % 3.0, np.sin(cycle), cycle % 9.0])
    assert start.repeats(gaps, np.ones(4)).tolist() == [True, True, False, False]


def test_the_amplitude_rises_stays_and_falls():
    amplitudes, ways = start.switching(50.0, {**SETTINGS, "rise": 0.1})
    assert np.count_nonzero(ways == "up") == np.count_nonzero(ways == "down") == 10
    assert amplitudes[:2].tolist() == [2.5, 7.5] and amplitudes[-1] == 2.5
    assert set(amplitudes[ways == "stay"]) == {50.0}


@pytest.fixture(scope="module")
def made() -> tuple[pd.DataFrame, dict[str, pd.DataFrame]]:
    advice = pd.DataFrame({"aim": ["fast", "even"], "acceleration": [44.0, 40.0]})
    few = {**SETTINGS, "starts": 12, "acceleration": {"start": 38.0, "stop": 46.0, "num": 5}, "push": [0.3]}
    with pytest.MonkeyPatch.context() as patch:
        for name, value in (("HOLD", 30), ("PUSHED", 30), ("STEP", 1e-2)):
            patch.setattr(start, name, value)
        tables = {name: pd.DataFrame(columns) for name, columns in start.make(advice, few).items()}
    for table in tables.values():
        table.attrs = few
    return advice, tables


def test_the_page_says_whether_it_matters_how_the_drive_is_switched_on(made):
    """At these amplitudes, parts that lie on the plate ride, and some of the dropped parts jump."""
    advice, tables = made
    page = start_page.make(TEMPLATE, advice, *(tables[name] for name in start.TABLES))
    first = page.splitlines()[2]
    assert first.startswith(
        "**Switched on at 44 m/s² (Γ = 0.933, 0.892 mm peak to peak), the fast amplitude, all parts ride"
    )
    assert "depends on how you switch on" in first
    assert "ride at all amplitudes up to" in first
    assert page.count("| switched on with the parts on the plate | 0 % |") == 2
    assert "None" not in page and "nan" not in page


def test_pushes_that_change_nothing_have_a_sentence_in_place_of_a_table(made):
    advice, tables = made
    calm = tables["pushes"].assign(riding=0, made_jump=np.nan, jumping=12, made_ride=0.0)
    page = start_page.make(TEMPLATE, advice, *((tables | {"pushes": calm})[name] for name in start.TABLES))
    assert page.count("no push of up to 30 cm/s away from the plate makes one ride") == 2
    assert "| Push" not in page


def test_a_push_makes_riding_parts_jump(made):
    _, tables = made
    pushes = tables["pushes"][tables["pushes"].aim == "even"].set_index("speed")
    assert pushes.riding.tolist() == [12, 12]
    assert pushes.made_jump[0.0] == 0.0 < pushes.made_jump[0.3]


def test_velocities_that_differ_count_unless_parts_slide_away(made):
    """All parts jump, whatever the way, but those that fall onto the running plate are faster."""
    advice, tables = made
    calm, motions = tables["start"].assign(jumping=1.0, velocity_50=0.2), tables["start_motions"]
    velocities = np.where(motions.parts == start.FED, 0.27, 0.2)
    tables = tables | {"start": calm, "start_motions": motions.assign(jumping=1.0, velocity_50=velocities)}
    calm.attrs = tables["pushes"].attrs
    sentence = 'the median has 27 cm/s after "parts fall onto the running plate", 20 cm/s after "'
    page = start_page.make(TEMPLATE, advice, *(tables[name] for name in start.TABLES))
    assert sentence in page and "does not matter" not in page
    calm.attrs = calm.attrs | {"model": calm.attrs["model"] | {"inclination": -0.3, "friction": 0.2}}
    page = start_page.make(TEMPLATE, advice, *(tables[name] for name in start.TABLES))
    assert sentence not in page and "The track is too steep" in page


@pytest.mark.parametrize(("stderr", "counts"), [(0.012, False), (0.004, True)])
def test_medians_that_differ_by_less_than_two_standard_errors_do_not_count(stderr, counts):
    """In chaos, medians over a few cycles differ by chance, whatever the way."""
    ways = [{"jumping": 1.0, "velocity_50": median, "velocity_50_stderr": stderr} for median in (0.22, 0.25)]
    assert start_page.is_faster(start_page.extremes(ways)) == counts


def test_differences_within_the_sampling_error_do_not_count():
    ways = [{"jumping": 0.5}, {"jumping": 0.58}, {"jumping": None}]
    assert not start_page.depends(ways, 256)
    assert start_page.depends([{"jumping": 0.5}, {"jumping": 0.65}], 256)
