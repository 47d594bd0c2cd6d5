"""The posterior of the parameters from quantities with a known likelihood."""

import numpy as np
import pandas as pd
import pytest
from project import read_config
from scipy.stats import chi2, norm

from calibration import paper_posterior as posterior
from calibration.paper_findings import misfit
from calibration.paper_numbers import PARAMETERS, searched
from calibration.search_space import bounds_of, values_at
from scripts.calibration.settings import IDENTIFIED

CONFIG = read_config()
MODEL, OWN = CONFIG["model"], {**CONFIG["identification"], "ranges": IDENTIFIED}
NUMBERS = {
    "state": {"low": -1.0, "high": 1.0},
    "other": {"low": -1.0, "high": 1.0},
    "velocity": {"low": -1.0, "high": 1.0},
}
SETTINGS = OWN | {
    "model": MODEL,
    "numbers": NUMBERS,
}
BOUNDS = bounds_of(SETTINGS, PARAMETERS)
CENTRE, REACH = BOUNDS.mean(axis=0), np.ptp(BOUNDS, axis=0)
WIDTH = 0.05  # standard deviation of the first two parameters over their ranges
ALL = {"without": [], "shifted": False}


def quantities(x, tension, velocities):
    """The loss and the friction, scaled; a contact that does not pull misses one number by two half intervals."""
    y = (x - CENTRE) / REACH
    found = {"state": y[:, 1] / WIDTH, "other": np.full(len(x), 2.0 if tension == "clip" else 0.0)}
    return found | ({"velocity": y[:, 0] / WIDTH} if velocities else {})


@pytest.fixture(scope="module")
def inferred():
    return posterior.infer(ALL, {}, quantities, SETTINGS | {"effort": 0.5})


def test_the_posterior_of_normal_errors(inferred):
    samples, fits = inferred
    y = (np.log(samples[["friction", "angle"]]) - CENTRE[[0, 3]]) / REACH[[0, 3]]
    mean = samples.weight @ y
    assert mean.friction == pytest.approx(0.0, abs=0.01)
    assert samples.weight @ (y.friction - mean.friction) ** 2 == pytest.approx(WIDTH**2, rel=0.15)
    assert samples.weight @ (y.angle - mean.angle) ** 2 == pytest.approx(1.0 / 12.0, rel=0.15)
    odds = 1.0 + np.exp(-2.0)
    assert fits.set_index("tension").share.to_dict() == pytest.approx(
        {"allow": 1.0 / odds, "clip": 1.0 - 1.0 / odds}, abs=0.03
    )
    assert fits.total.tolist() == pytest.approx([0.0, 4.0], abs=1e-3)
    at_printed = quantities(searched(SETTINGS), "allow", True)
    assert fits.printed_total[0] == pytest.approx(
        sum(misfit(at_printed[name][0], one) ** 2 for name, one in NUMBERS.items())
    )
    assert fits["size"].min() > 100.0


def test_errors_grow_if_the_best_parameters_miss_by_more():
    """All numbers miss by three half intervals at best, and there is one degree of freedom more than parameters."""
    names = list("abcde")
    settings = SETTINGS | {"effort": 0.5, "numbers": dict.fromkeys(names, NUMBERS["state"])}

    def missed(x, tension, velocities):
        return dict.fromkeys(names, 3.0 + np.abs(x[:, 1] - CENTRE[1]) / REACH[1])

    samples, fits = posterior.infer(ALL, {}, missed, settings)
    assert fits.scale.tolist() == pytest.approx([45.0, 45.0], rel=1e-3)
    assert fits.region.iloc[0] == pytest.approx(45.0 * chi2.ppf(0.95, 4), rel=1e-3)
    # The likelihood exp(-5 (3 + d)²/90) is flat: it falls by a sixth from d = 0 to d = 1/2.
    inner = np.abs(np.log(values_to_loss(samples)) - CENTRE[1]) / REACH[1] < 0.25
    assert samples.weight[inner].sum() == pytest.approx(0.52, abs=0.03)


def values_to_loss(samples):
    x = [searched(SETTINGS, **row) for row in samples[list(PARAMETERS)].to_dict("records")]
    return np.exp(np.vstack(x)[:, 1])


def test_numbers_are_left_out_and_shifted():
    left_out = {"without": ["other"], "shifted": True}
    samples, fits = posterior.infer(left_out, {"velocity": 2.0}, quantities, SETTINGS | {"effort": 0.5})
    assert fits.numbers.tolist() == [2, 2]
    assert fits.share.tolist() == pytest.approx([0.5, 0.5], abs=0.03)
    y = (np.log(samples.friction) - CENTRE[0]) / REACH[0]
    assert samples.weight @ y == pytest.approx(-2.0 * WIDTH, abs=0.01)


def test_intervals_and_the_share_of_the_range_that_they_cover(inferred):
    samples, _ = inferred
    found = posterior.interval_rows(samples, SETTINGS).set_index("parameter")
    expected = CENTRE[0] + REACH[0] * WIDTH * np.array(norm.interval(0.95))
    assert np.log(found.loc["friction", ["low", "high"]].astype(float)).tolist() == pytest.approx(expected, abs=0.03)
    assert found.covered["friction"] == pytest.approx(0.196, abs=0.015)
    assert not found.open_low["friction"] and not found.open_high["friction"]
    assert found.open_low["angle"] and found.open_high["angle"]
    # Of an angle that nothing limits, the interval covers 95 % of the range, and more where it is smoothed.
    assert 0.93 < found.covered["angle"] <= 1.0
    few = posterior.interval_rows(samples.head(50), SETTINGS)
    assert few.low.isna().all() and few.covered.isna().all()


def test_the_error_of_the_best_value_is_its_deviation_from_seed_to_seed():
    settings, bests, errors = SETTINGS | {"effort": 0.25}, [], []
    for seed in range(3):
        samples, _ = posterior.infer(ALL, {}, quantities, settings, seed)
        friction = posterior.interval_rows(samples, settings).set_index("parameter").loc["friction"]
        bests.append(np.log(friction.best))
        errors.append(friction.best_error / friction.best)
    assert 0.2 < np.std(bests, ddof=1) / np.mean(errors) < 5.0
    assert np.mean(bests) == pytest.approx(CENTRE[0], abs=0.1 * WIDTH * REACH[0])


def test_samples_lie_within_the_bounds(inferred):
    samples, _ = inferred
    low, high = (values_at(bound[None], SETTINGS, PARAMETERS) for bound in BOUNDS)
    for name in PARAMETERS:
        assert samples[name].between(low[name][0], high[name][0]).all()
    assert samples.weight.sum() == pytest.approx(1.0)


def test_number_rows_have_the_misfits_of_the_accepted_intervals():
    found = {"state": np.array([0.5]), "other": np.array([-3.0]), "velocity": np.array([1.0])}
    rows = posterior.number_rows("printed", found, NUMBERS)
    expected = {"set": "printed", "number": list(NUMBERS), "value": [0.5, -3.0, 1.0], "misfit": [0.5, -3.0, 1.0]}
    pd.testing.assert_frame_equal(rows, pd.DataFrame(expected))
