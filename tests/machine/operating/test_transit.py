"""Transit of populations of parts: exact cases, quantiles, brute force by RK4, drift and track lengths."""

import math

import numpy as np
import pandas as pd
import pytest
from project import si_config

from conveyor import Columns, Conveyor, Start, conveyor_and_start, ensemble, parameter_table, plate_motion, simulate
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.config.tables import TABLES
from conveyor_pipeline.machine.operating import drift, parts, populations, regimes, transit

SETTINGS = TABLES["operating/transit"](si_config()) | {"starts": 24, "longest": 5.0}
EQUAL = dict.fromkeys(populations.COLUMNS, 0.0) | {"seed": 2}


def test_factors_have_the_given_relative_standard_deviations():
    spread = dict(zip(populations.COLUMNS, (0.3, 0.1, 0.0, 0.05, 0.01), strict=True)) | {"seed": 3}
    found = parts.factors(spread, 200_000)
    assert found.std(axis=0) / found.mean(axis=0) == pytest.approx([0.3, 0.1, 0.0, 0.05, 0.01], rel=0.01)
    assert np.median(found, axis=0) == pytest.approx(np.ones(5), abs=3e-3)
    assert abs(np.corrcoef(np.log(found[:, [0, 1, 3, 4]]).T) - np.eye(4)).max() < 0.01


def test_parts_are_the_same_at_all_amplitudes():
    """Equal factors, heights above the plate, velocities and phases; static friction keeps its ratio to friction."""
    model = SETTINGS["model"] | {"static_friction": 0.2}
    low, high = parts.population(np.array([30.0, 60.0]), {**SETTINGS, "model": model}).reshape(2, 24)
    for name in ("friction", "damping", "psi0", "vz0"):
        assert (low[name] == high[name]).all()
    assert low["static_friction"] / low["friction"] == pytest.approx(np.full(24, 0.2 / 0.15))
    heights = []
    for rows in (low, high):
        found = [conveyor_and_start(row) for row in rows]
        heights.append([start.z - plate_motion(conveyor, np.zeros(1))["z"][0] for conveyor, start in found])
    assert heights[0] == pytest.approx(heights[1], abs=1e-15)
    assert min(heights[0]) >= 0.0


def test_parts_without_differences_are_identical():
    rows = [parts.population(np.array([40.0]), SETTINGS | {"spread": EQUAL}, kind) for kind in populations.POPULATIONS]
    np.testing.assert_array_equal(*rows)
    table = transit.measure(np.array([40.0]), {**SETTINGS, "spread": EQUAL})
    one, other = (table[table.population == kind].drop(columns="population") for kind in populations.POPULATIONS)
    np.testing.assert_array_equal(one, other)


def test_arrivals_agree_with_the_position_over_time():
    """A sliding, a jumping and a chaotic part, with densely sampled positions."""
    rows = np.stack(
        [parameter_table(Conveyor(acceleration=a), Start(z)) for a, z in ((30.0, 0.0), (40.0, 3e-4), (80.0, 0.0))]
    )
    lengths, longest = np.array([0.01, 0.05]), np.array([2.0, 3.0])
    found = ensemble.transits(rows, lengths, longest, begin=np.array(0.1))
    times = np.linspace(0.0, 3.0, 300_001)
    for row, arrival, velocity in zip(rows, found["arrival"], found["velocity"], strict=True):
        conveyor, start = conveyor_and_start(row)
        x = simulate(conveyor, start, duration=3.0).sample(times)["x"]
        for place, (length, limit) in enumerate(zip(lengths, longest, strict=True)):
            until = np.searchsorted(times, limit)
            if (x[:until] >= length).any():
                expected = times[np.argmax(x >= length)]
                assert arrival[place] == pytest.approx(expected, rel=1e-3)
                assert velocity[place] == pytest.approx(length / expected, rel=1e-3)
            else:
                assert math.isnan(arrival[place])
                assert velocity[place] == pytest.approx(x[until] / limit, abs=1e-6)
    assert np.isnan(found["arrival"]).sum() == 1


def test_repeated_motions_are_skipped_without_a_trace():
    """Sliding, jumping and sliding back, each with and without an arrival after hundreds of cycles."""
    rows = np.array(
        [
            parameter_table(Conveyor(acceleration=a, inclination=inclination), Start(z))
            for a, z, inclination in ((30.0, 0.0, 0.0), (40.0, 3e-4, 0.0), (30.0, 0.0, 0.12))
        ]
    )
    length, longest = 0.1004, 20.0
    found = ensemble.transits(rows, np.array([length]), np.array([longest]), begin=np.array(1.0))
    arrived = np.where(np.isnan(found["arrival"][:, 0]), longest, found["arrival"][:, 0])
    followed = ensemble.sweep(rows, duration=arrived)
    assert np.isnan(found["arrival"]).sum() == 1
    np.testing.assert_allclose(found["velocity"][:, 0], followed["x_end"] / arrived, rtol=1e-5)
    late = arrived == longest
    np.testing.assert_allclose(found["velocity"][late, 0], followed["x_end"][late] / longest, rtol=1e-8)
    np.testing.assert_allclose(found["peak_force"], followed["peak_force"], rtol=1e-6)


def test_transits_do_not_depend_on_threads_and_longer_tracks():
    rows = parts.population(np.array([40.0, 80.0]), SETTINGS)
    alone = ensemble.transits(rows, np.array([0.1]), np.array([2.0]), begin=np.full(len(rows), 0.4))
    shared = ensemble.transits(rows, np.array([0.1, 0.2]), np.array([2.0, 4.0]), begin=np.array(0.4), threads=2)
    np.testing.assert_array_equal(alone["velocity"][:, 0], shared["velocity"][:, 0])
    again = ensemble.transits(rows, np.array([0.1]), np.array([2.0]), begin=np.array(0.4), threads=2)
    np.testing.assert_array_equal(alone["impact_speed"], again["impact_speed"])


def test_peaks_count_from_the_given_time_however_many_tracks():
    """A part that jumps periodically hits the plate and presses on it alike on each track.

    It reaches the end of the longer track, after 3.2 s, before the longest time of the shorter one.
    """
    row = parameter_table(Conveyor(acceleration=40.0), z0=[3e-4])
    alone = ensemble.transits(row, np.array([0.1]), np.array([4.0]), begin=np.array(0.5))
    both = ensemble.transits(row, np.array([0.1, 0.2]), np.array([4.0, 8.0]), begin=np.array(0.5))
    assert both["arrival"][0, 1] < 4.0
    assert both["impact_speed"] == pytest.approx(alone["impact_speed"], rel=1e-6)
    assert both["peak_force"] == pytest.approx(alone["peak_force"], rel=1e-6)
    assert alone["impact_speed"][0] > 0.1


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"lengths": np.array([0.2, 0.1])}, "lengths must ascend"),
        ({"lengths": np.array([0.0, 0.1])}, "lengths = 0.0 is outside"),
        ({"longest": np.array([1.0])}, "longest has the shape"),
        ({"begin": np.array(2.0)}, "begin = 2.0 is outside"),
    ],
)
def test_arguments_of_transits_are_checked(changed, words):
    arguments = {"lengths": np.array([0.1, 0.2]), "longest": np.array([1.0, 2.0]), "begin": np.array(0.1)} | changed
    with pytest.raises(ValueError, match=words):
        ensemble.transits(parameter_table(Conveyor(), Start())[None], **arguments)


def test_quantiles_and_their_errors():
    """The scatter of the quantiles of many samples of a normal distribution is their standard error."""
    samples = np.random.default_rng(1).standard_normal((300, 256))
    found, errors = (np.array(of) for of in zip(*map(transit.quantiles, samples), strict=True))
    assert errors.mean(axis=0) == pytest.approx(found.std(axis=0), rel=0.15)
    found, errors = transit.quantiles(np.full(100, 0.1))
    assert found.tolist() == [0.1] * 5
    assert errors.tolist() == [0.0] * 5


def test_measures_of_made_up_runs():
    velocity = np.array([0.2, 0.1, 0.1, 0.1, -0.1, np.nan])
    run = Columns(
        {
            "velocity": velocity[:, None],
            "arrival": np.array([1.0, 2.0, 2.0, np.nan, np.nan, np.nan])[:, None],
            "impact_speed": np.array([0.3, 0.3, np.nan, 0.3, 0.3, np.nan]),
            "peak_force": np.full(6, np.nan),
            "status": np.array(["ok"] * 5 + ["too many events"], dtype=object),
        }
    )
    found = transit.summarize(run)
    assert found["velocity_50"] == 0.1
    assert found["mean_velocity"] == pytest.approx(0.08)
    assert (found["late"], found["back"], found["failed"]) == (0.4, 0.2, 1)
    assert found["spread"] == pytest.approx((0.18 - -0.06) / 0.1)
    assert found["impact_speed"] == 0.3
    assert math.isnan(found["peak_force"])
    each = transit.summarize_populations(run, 2)
    assert each.velocity_50.tolist() == pytest.approx([0.15, 0.1, -0.1])
    assert each.failed.tolist() == [0, 0, 1]
    failed = transit.summarize(run.select([5]))
    assert failed["failed"] == 1 and math.isnan(failed["velocity_05"])


def test_a_part_on_a_steep_track_moves_back():
    """Friction cannot hold it: it slides down with the mean acceleration g (sin α - μ cos α)."""
    model = SETTINGS["model"] | {"inclination": 0.3, "friction": 0.1}
    found = transit.measure(np.array([20.0]), {**SETTINGS, "model": model, "spread": EQUAL}).iloc[0]
    mean = 9.81 * (math.sin(0.3) - 0.1 * math.cos(0.3))
    assert found.back == found.late == 1.0
    assert found.velocity_50 == pytest.approx(-0.5 * mean * 5.0, rel=0.01)


@pytest.mark.parametrize("amplitude", [44.0, 80.0])
def test_quantiles_agree_with_a_fixed_step_method_and_other_random_numbers(amplitude):
    """Brute force: RK4 with 10 µs, sampled at each millisecond, other initial conditions and other parts."""
    settings = SETTINGS | {"starts": 128, "longest": 1.5, "length": 0.1}
    own = transit.measure(np.array([amplitude]), settings, (populations.VARIED,)).iloc[0]
    other = {**settings, "seed": 77, "spread": settings["spread"] | {"seed": 78}, "starts": 96}
    times, velocity = np.arange(1, 1501) / 1000.0, []
    for row in parts.population(np.array([amplitude]), other):
        x = simulate(*conveyor_and_start(row), duration=1.5, method="rk4", step=1e-5).sample(times)["x"]
        velocity.append(0.1 / times[np.argmax(x >= 0.1)] if (x >= 0.1).any() else x[-1] / 1.5)
    found, errors = transit.quantiles(np.array(velocity))
    for place, name in enumerate(populations.QUANTILES):
        error = math.hypot(errors[place], own[f"{name}_stderr"])
        assert found[place] == pytest.approx(own[name], abs=4.0 * error + 1e-3 * abs(own[name])), name


REGIMES = pd.DataFrame(
    {
        "regime": [regimes.ONE, regimes.SEVERAL, regimes.CHAOS, regimes.BESIDE, regimes.CHAOS],
        "begin": [20.0, 25.0, 77.0, 81.0, 84.0],
        "end": [24.0, 48.0, 80.0, 83.0, 90.0],
    }
)


def test_amplitudes_of_a_regime():
    settings = {"acceleration": {"start": 20.0, "stop": 90.0, "num": 15}}
    assert drift.amplitudes_in(regimes.CHAOS, REGIMES, settings).tolist() == [80.0, 85.0, 90.0]
    assert drift.amplitudes_in(regimes.SEVERAL, REGIMES, settings).tolist() == [25.0, 30.0, 35.0, 40.0, 45.0]
    assert drift.amplitudes_in(regimes.UNKNOWN, REGIMES, settings).tolist() == []
    assert drift.spaced(np.arange(10.0), 2).tolist() == [2.0, 7.0]
    assert drift.spaced(np.arange(2.0), 8).tolist() == [0.0, 1.0]
    assert drift.spaced(np.empty(0), 8).tolist() == []


def test_drift_predicts_the_spread_and_tracks_with_coexisting_motions_keep_theirs(monkeypatch):
    for name, value in (("LENGTHS", (0.25, 1.0)), ("AMPLITUDES", 1), ("OF_EACH_REGIME", 1)):
        monkeypatch.setattr(drift, name, value)
    settings = TABLES["operating/drift"](si_config()) | {"starts": 64, "effort": 0.4}
    found = drift.make(REGIMES, settings | {"longest": 10.0})
    (row,) = found["drift"].to_dict("records")
    assert row["status"] == "ok"
    assert row["velocity"] == pytest.approx(0.5 * (row["velocity_1"] + row["velocity_2"]), rel=1e-9)
    lengths = found["track_lengths"]
    chaos = lengths[lengths.regime == regimes.CHAOS]
    assert chaos.spread.to_numpy() == pytest.approx(chaos.predicted.to_numpy(), rel=0.5)
    assert (chaos.spread / chaos.predicted).mean() == pytest.approx(1.0, abs=0.25)
    assert chaos.predicted.iloc[0] / chaos.predicted.iloc[1] == pytest.approx(2.0)
    several = lengths[lengths.regime == regimes.SEVERAL]
    assert several.predicted.isna().all()
    for _, of in several.groupby("acceleration"):
        assert of.spread.iloc[1] > 0.8 * of.spread.iloc[0]


def test_without_chaos_and_coexisting_motions_both_tables_are_empty():
    settings = TABLES["operating/drift"](si_config())
    found = drift.make(REGIMES[REGIMES.regime == regimes.ONE], settings)
    for name, table in found.items():
        assert len(table) == 0
        assert set(table) == {column.name for column in drift.TABLES[name]}


def test_a_failed_run_leaves_no_drift():
    x = np.cumsum(np.random.default_rng(1).standard_normal((4, 100)), axis=1)
    x[2, 50:] = np.nan
    row = drift.drift_at(80.0, x, np.array([True, True, False, False]), 0.02)
    assert row["status"] == drift.RUN_FAILED
    assert math.isnan(row["diffusion"])


BEST = pd.DataFrame({"parameter": ["friction"], "best": [0.2000001]})


@pytest.mark.parametrize("friction", [0.2, 0.25])
def test_calibrated_parts_belong_to_the_model(friction):
    samples = pd.DataFrame({"friction": [0.1, 0.3]})
    settings = {"model": {"friction": friction}, "starts": 2, "spread": {"seed": 1}}
    assert parts.with_calibration(settings, None, None) == settings
    if friction == 0.2:
        found = parts.with_calibration(settings, samples, BEST)
        assert sorted(found["calibrated"][:, 0]) == pytest.approx([0.5, 1.5])
    else:
        with pytest.raises(JobError, match=r"model.friction = 0.25 is not 0.2, the calibrated value"):
            parts.with_calibration(settings, samples, BEST)


@pytest.mark.parametrize("static", [None, 0.3])
def test_calibrated_parts_keep_a_stated_static_friction(static):
    stated = {} if static is None else {"static_friction": static}
    samples = pd.DataFrame({"friction": [0.2, 0.25, 0.28]})
    model = SETTINGS["model"] | {"friction": 0.25} | stated
    settings = {**SETTINGS, "spread": EQUAL, "model": model, "starts": 3}
    settings["calibrated"] = parts.calibrated_factors(samples, settings)
    rows = parts.population(np.array([40.0]), settings)
    assert sorted(rows["friction"]) == pytest.approx([0.2, 0.25, 0.28])
    assert rows["static_friction"] == pytest.approx(rows["friction"] if static is None else np.full(3, static))


def test_calibrated_parts_have_the_parameters_of_the_samples():
    samples = pd.DataFrame({"friction": [0.1, 0.3], "damping": [0.3, 0.6], "stiffness": [5e5, 1e6]})
    settings = {"model": {"friction": 0.2, "damping": 0.3, "stiffness": 5e5}, "starts": 4, "spread": {"seed": 1}}
    factors = parts.calibrated_factors(samples, settings)
    assert sorted(factors[:, 0]) == pytest.approx([0.5, 0.5, 1.5, 1.5])
    for friction, damping, stiffness, *others in factors:
        assert (damping, stiffness) == ((1.0, 1.0) if friction < 1.0 else (2.0, 2.0))
        assert others == [1.0, 1.0]


def test_the_error_of_a_spread_comes_from_both_ends():
    found = np.array([[0.1, 0.0, 0.2, 0.3, 0.4], [-0.1, 0.0, 0.0, 0.3, 0.4]]).T
    errors = np.array([[0.03, 9.0, 9.0, 9.0, 0.04]] * 2).T
    np.testing.assert_allclose(transit.spread_stderr(found, errors), [0.25, np.nan])
