"""Small calibrations of synthetic measurements."""

import math
import re
from functools import partial

import numpy as np
import pandas as pd
import pytest
from project import ROOT, si_config
from synthetic import csv_text, measure

from conveyor_pipeline.common import csv_table
from conveyor_pipeline.config.tables import settings_of
from conveyor_pipeline.machine.calibration import model_check, page, prediction
from conveyor_pipeline.machine.calibration.calibrate import calibrate, make
from conveyor_pipeline.machine.calibration.importance_sampling import Sample
from conveyor_pipeline.machine.calibration.inference import (
    DETERMINED,
    NOT_CONVERGED,
    NOT_DETERMINED,
    OPEN,
    agree,
    data_of,
    search,
    summarize_parameters,
)
from conveyor_pipeline.machine.calibration.measurements import HEADER_UNITS, parse, wanted
from conveyor_pipeline.machine.calibration.model_check import compare_alternatives
from conveyor_pipeline.machine.calibration.search_space import bounds_of

MODEL = {"frequency": 40.0, "angle": 0.3, "mass": 1e-3, "gravity": 9.81, "exponent": 1.5, "inclination": 0.0}
MODEL |= {"phase_shift": 0.0}
CONTACT = {"friction": 0.25, "damping": 0.3, "stiffness": 3e5}
SETTINGS = {
    "parameters": ["friction", "damping", "stiffness"],
    "alternatives": {},
    "ranges": {"friction": [0.05, 1.0], "damping": [0.03, 2.5], "stiffness": [2.0, 2000.0]},
    "height": [0.0, 5e-4],
    "vz0": [-0.2, 0.2],
    "psi0": [0.0, 2.0 * math.pi],
    "model": MODEL,
    "static_friction": 0.0,
    "measurements": "mine.csv",
    "noise": 0.02,
    "parts": 8,
    "rough_parts": 8,
    "first": 100,
    "points": 50,
    "rough_rounds": 12,
    "rounds": 12,
    "enough": 60.0,
    "samples": 40,
    "checked": 6,
    "checked_parts": 16,
    "replicates": 1000,
    "amplitudes": 4,
    "predicted": 20,
    "predicted_parts": 8,
    "seed": 1,
}
AMPLITUDES = np.repeat([20.0, 26.0, 32.0, 38.0, 50.0], 2)


def measured(factor=1.0, **undeclared):
    """Measurements over 0.3 s; `factor` multiplies every second velocity."""
    rows = measure(MODEL | CONTACT | undeclared, AMPLITUDES, SETTINGS, 0.02, np.random.default_rng(4), duration=0.3)
    rows = [(one, velocity * (factor if place % 2 else 1.0)) for place, (one, velocity) in enumerate(rows)]
    text = csv_text(rows, "synthetic", duration=0.3, before=0.3)
    return parse(csv_table.parse(text, "mine.csv", wanted, HEADER_UNITS, ""), SETTINGS)


@pytest.fixture(scope="module", autouse=True)
def two_searches():
    """Two searches, and further ones if they disagree: how many agree is tested with made-up samples."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("conveyor_pipeline.machine.calibration.calibrate.search", partial(search, searches=(2, 5)))
        yield


INCLINED = SETTINGS | {"alternatives": {"inclination": 0.2}}


@pytest.fixture(scope="module")
def found():
    return calibrate(measured(), INCLINED, threads=2)


@pytest.mark.long
def test_a_right_model_is_explained_and_its_friction_is_found(found):
    rows = {row["parameter"]: row for row in pd.DataFrame(found["parameters"]).to_dict("records")}
    friction = rows["friction"]
    # The interval leaves out the true value in one of 20 cases, but hardly ever by its own width.
    reach = friction["high"] - friction["low"]
    assert friction["low"] - reach <= CONTACT["friction"] <= friction["high"] + reach
    assert 0.0 < friction["best_error"] < 0.25 * reach
    assert all(row["low"] <= row["best"] <= row["high"] for row in rows.values())
    assert np.all(found["fit"]["explained"])


@pytest.mark.long
def test_a_single_parameter_can_be_searched():
    stated = {name: value for name, value in CONTACT.items() if name != "friction"}
    ranges = {"friction": SETTINGS["ranges"]["friction"]}
    settings = SETTINGS | {"ranges": ranges, "model": MODEL | stated}
    (low,), (high,) = (calibrate(measured(), settings, threads=2)["parameters"][name] for name in ("low", "high"))
    assert 0.95 * low <= CONTACT["friction"] <= 1.05 * high and high < 1.2 * low


def test_an_interval_that_only_the_range_limits_ends_there():
    low, high = bounds_of(SETTINGS)
    share = (0.5 + np.arange(400)) / 400
    # A friction that is large, a damping that is known, and a stiffness of which nothing is.
    other = np.random.default_rng(1).permutation(share)
    columns = [high[0] - 0.3 * (high - low)[0] * share, np.full(400, math.log(0.3)), low[2] + (high - low)[2] * other]
    points = np.column_stack(columns)
    sample = Sample(points, np.zeros(400), np.full(400, 1 / 400), 0.0, 400.0, np.arange(400) % 4)
    rows = {row["parameter"]: row for row in summarize_parameters(sample, SETTINGS)}
    assert (rows["friction"]["status"], rows["stiffness"]["status"]) == (OPEN, NOT_DETERMINED)
    assert rows["friction"]["low"] > rows["friction"]["range_low"]
    assert rows["friction"]["high"] == rows["friction"]["range_high"]
    assert [rows["stiffness"][end] for end in ("low", "high")] == [
        rows["stiffness"][end] for end in ("range_low", "range_high")
    ]


def test_searches_that_find_other_values_disagree():
    """Four searches, each narrow: at one place, they agree; the last one elsewhere, they do not."""
    low, high = bounds_of(SETTINGS)
    random = np.random.default_rng(3)
    points = 0.5 * (low + high) + 0.01 * (high - low) * random.standard_normal((400, 3))
    search = np.arange(400) % 4
    weights = np.full(400, 1 / 400)
    for shift, status in ((0.0, DETERMINED), (0.2, NOT_CONVERGED)):
        moved = points + np.where(search == 3, shift, 0.0)[:, None] * [high[0] - low[0], 0.0, 0.0]
        found = Sample(moved, np.zeros(400), weights, 0.0, 400.0, search)
        friction, *_ = summarize_parameters(found, SETTINGS)
        assert friction["status"] == status and agree(found, SETTINGS) == (status == DETERMINED)
        if status == DETERMINED:  # the interval of 95 % of a normal distribution
            width = math.log(friction["high"] / friction["low"])
            assert width == pytest.approx(2.0 * 1.96 * 0.01 * (high - low)[0], rel=0.15)


@pytest.mark.long
def test_velocities_that_no_parameters_give_are_not_explained():
    # How many measurements do not fit depends on the best parameters, which differ from search to search.
    wrong = calibrate(measured(factor=-1.0), SETTINGS, threads=2)["fit"]
    assert not np.any(wrong["explained"])
    assert not np.all(wrong["fits"])


@pytest.mark.long
def test_an_inclination_that_was_not_stated_rejects_the_model(found):
    """The search finds no inclination where there is none."""
    assert not np.any(found["alternatives"]["preferred"])
    inclined = calibrate(measured(inclination=0.16), INCLINED, threads=2)
    (value,), (preferred,) = (inclined["alternatives"][name] for name in ("value", "preferred"))
    assert preferred and value > 0.02
    assert not np.all(inclined["fit"]["explained"])


@pytest.mark.parametrize(
    ("gain", "size", "preferred"), [(-4.0, 50.0, False), (2.9, 50.0, False), (3.1, 50.0, True), (63.0, 5.0, False)]
)
def test_an_alternative_is_preferred_from_a_bayes_factor_of_twenty_on(gain, size, preferred, monkeypatch):
    """The logarithm of 20 is 3.0. A search that has not converged, of size 5, says nothing."""
    points = np.repeat(bounds_of(SETTINGS).mean(axis=0)[None], 5, axis=0)
    inclined = np.column_stack([points, np.full(5, 0.1)])
    found, other = (
        Sample(place, np.zeros(5), np.full(5, 0.2), evidence, size, np.zeros(5, int))
        for place, evidence in ((points, 7.0), (inclined, 7.0 + gain))
    )
    monkeypatch.setattr(model_check, "search", lambda *_, **__: other)
    (row,) = compare_alternatives(found, data_of(measured(), MODEL), INCLINED)
    assert row["preferred"] == preferred
    expected = (gain, 0.1) if size == 50.0 else (math.nan, math.nan)
    assert (row["log_bayes_factor"], row["value"]) == pytest.approx(expected, nan_ok=True)


def test_a_parameter_that_the_measurements_state_is_no_alternative():
    stated = [one._replace(changed={"inclination": 0.0}) for one in measured()]
    data = data_of(stated, MODEL)
    assert compare_alternatives(None, data, SETTINGS | {"alternatives": {"inclination": 0.2}}) == []


# A bowl feeder that rises by 3°, with vertical amplitudes of 0.6 to 1 g, where parts hardly leave the track.
BOWL = {"frequency": 100.0, "angle": math.radians(20.0), "inclination": math.radians(3.0), "mass": 8e-4}
BOWL_CONTACT = {"friction": 0.36, "damping": 1.0, "stiffness": 1.1e6}


@pytest.mark.long
def test_a_trial_of_twenty_velocities_of_the_model_itself_gives_no_verdict(capsys):
    """Its search has not converged, and says only that, in the tables and on the page."""
    settings = settings_of(si_config(), "calibration/parameters")
    settings |= {"model": settings["model"] | BOWL, "measurements": "mine.csv", "effort": 0.1}
    settings |= {"height": [0.0, 1.2e-4], "vz0": [-0.1, 0.1]}
    amplitudes = np.repeat(np.linspace(0.6, 1.0, 10) * 9.81 / math.sin(BOWL["angle"]), 2)
    random = np.random.default_rng(3)
    rows = measure(settings["model"] | BOWL_CONTACT, amplitudes, settings, 0.02, random, duration=0.1)
    text = csv_text(rows, "synthetic", duration=0.1, before=0.1)
    found = {name: pd.DataFrame(columns) for name, columns in make(text, settings, progress="search").items()}
    assert (found["parameters"].status == NOT_CONVERGED).all() and (found["parameters"].effective < 40.0).all()
    assert found["parameters"][["best", "best_error", "low", "high"]].isna().all(axis=None)
    assert found["fit"][["explained", "p_value", "fits", "median"]].isna().all(axis=None)
    assert found["samples"].empty and found["alternatives"].empty
    found["parameters"].attrs = settings
    predicted = prediction.make(found.pop("samples"), found["fit"], settings)
    template = (ROOT / "workflow/rules/machine/calibration.md").read_text(encoding="utf-8")
    tables = found | {name: pd.DataFrame(columns) for name, columns in predicted.items()}
    text = page.make(template, **tables, measurements=text, prefix="mine")
    assert "**This is a trial" in text and "**The search has not converged.**" in text
    assert "explain the" not in text and "±" not in text
    # One progress over all searches.
    progress = capsys.readouterr().err.splitlines()
    assert len(progress) <= 2
    assert all(re.match(r"search: \d+ of \d+ runs, .* left$", line) for line in progress)


def test_results_do_not_depend_on_the_threads():
    short = SETTINGS | {"first": 40, "points": 20, "rough_rounds": 2, "rounds": 2}
    data = data_of(measured(), MODEL)
    one, two = (search(data, short, searches=(1, 1), threads=threads) for threads in (1, 2))
    assert np.isfinite(one.weights).all() and len(one.points) > 40
    for first, second in zip(one, two, strict=True):
        np.testing.assert_array_equal(first, second)


@pytest.mark.long
def test_the_prediction_covers_the_measured_amplitudes_and_the_next_measurement_lies_near(found):
    samples, fit = (pd.DataFrame(found[name]) for name in ("samples", "fit"))
    tables = prediction.predict(samples, fit, SETTINGS, threads=2)
    band, candidates = (pd.DataFrame(tables[name]) for name in ("prediction", "next"))
    assert (band.acceleration.iloc[0], band.acceleration.iloc[-1]) == (20.0, 50.0)
    assert ((band.low <= band["median"]) & (band["median"] <= band.high)).all()
    assert candidates.acceleration.is_monotonic_increasing
    assert candidates.acceleration.min() >= 16.0 - 1e-9 and candidates.acceleration.max() <= 60.0 + 1e-9
    assert (candidates.narrowing < 1.0).all() and candidates.narrowing_angle.isna().all()


@pytest.mark.parametrize("highest", [44.0, 44.001, 60.0])
def test_nearly_equal_amplitudes_ask_for_few_predictions(highest, monkeypatch):
    followed = []

    def nothing(values, conditions, settings, *, parts, **options):
        followed.append(len(conditions.rows))
        return np.ones((len(values["friction"]), len(conditions.rows), parts))

    monkeypatch.setattr(prediction, "velocities", nothing)
    samples = pd.DataFrame({name: value * np.linspace(0.9, 1.1, 40) for name, value in CONTACT.items()})
    prediction.predict(samples, pd.DataFrame({"acceleration": [44.0, highest]}), SETTINGS)
    assert 3 <= followed[0] <= 3 * SETTINGS["amplitudes"]


def test_the_band_between_two_rows_contains_a_motion_that_begins_there(monkeypatch):
    def step(values, conditions, settings, *, parts, seed, **options):
        random = np.random.default_rng(seed)
        begun = conditions.rows["acceleration"] > 41.0
        return np.where(begun, 0.1, 0.02)[:, None] * random.normal(
            1.0, 0.01, (len(values["friction"]), len(begun), parts)
        )

    monkeypatch.setattr(prediction, "velocities", step)
    samples = pd.DataFrame({name: value * np.linspace(0.9, 1.1, 40) for name, value in CONTACT.items()})
    fit = pd.DataFrame({"acceleration": [20.0, 60.0]})
    band = pd.DataFrame(prediction.predict(samples, fit, SETTINGS | {"amplitudes": 9})["prediction"])
    for velocity in (0.02, 0.1):  # at 40.5 and at 41.5 m/s²
        low, high = (np.interp([40.5, 41.5], band.acceleration, band[name]) for name in ("low", "high"))
        assert (low < velocity).all() and (velocity < high).all()
    away = band[(band.acceleration - 42.5).abs() > 5.0]
    assert (away.high - away.low < 0.01).all()
