"""The 0-1 test on series that are known to be regular or chaotic."""

import numpy as np
import pytest

from conveyor.analysis.chaos.zero_one import mean_square_displacement, zero_one

N = 1000


def logistic(r):
    x, series = 0.3, np.empty(N + 1000)
    for i in range(len(series)):
        x = r * x * (1.0 - x)
        series[i] = x
    return series[1000:]


def henon():
    x, y, series = 0.1, 0.1, np.empty(N + 100)
    for i in range(len(series)):
        x, y = 1.0 - 1.4 * x * x + y, 0.3 * x
        series[i] = x
    return series[100:]


def quasi_periodic():
    n = np.arange(N)
    return np.cos(np.sqrt(5.0) * np.pi * n) + 0.3 * np.cos(2 * np.sqrt(2.0) * np.pi * n + 0.2)


# At r = 4 some initial values collapse in floating point, because the map is conjugate to the tent map; 0.3 does not.
@pytest.mark.parametrize("series", [logistic(4.0), logistic(3.97), henon()], ids=["r = 4", "r = 3.97", "Hénon"])
def test_chaos(series):
    assert zero_one(series, seed=1) > 0.98


@pytest.mark.parametrize(
    "series",
    [logistic(3.2), logistic(3.5), logistic(3.55), logistic(3.84), quasi_periodic()],
    ids=["period 2", "period 4", "period 8", "period 3", "quasi-periodic"],
)
def test_regular_motion(series):
    assert abs(zero_one(series, seed=1)) < 0.05


def test_rounding_noise_on_a_fixed_point_is_not_chaos():
    noise = 0.6 + 1e-13 * np.random.default_rng(0).standard_normal(N)
    assert zero_one(noise, seed=1) > 0.9
    assert zero_one(noise, seed=1, resolution=1e-11) == 0.0
    assert zero_one(np.full(N, 0.6), seed=1) == 0.0


def test_units_and_offset_do_not_matter():
    series = logistic(3.9)
    assert zero_one(1e-4 * series + 3.0, seed=2) == pytest.approx(zero_one(series, seed=2), abs=1e-9)


def test_same_seed_same_result():
    series = logistic(3.6)
    assert zero_one(series, seed=3) == zero_one(series, seed=3) != zero_one(series, seed=4)


def test_mean_square_displacement_agrees_with_its_definition():
    rng = np.random.default_rng(0)
    series, c = rng.standard_normal(200), np.array([0.7, 1.1, 2.4])
    path = np.cumsum(series * np.exp(1j * c[:, None] * np.arange(200)), axis=1)
    expected = [np.mean(np.abs(path[:, k : k + 180] - path[:, :180]) ** 2, axis=1) for k in range(1, 21)]
    assert mean_square_displacement(series, c, 20) == pytest.approx(np.array(expected).T, rel=1e-10)


@pytest.mark.parametrize("series", [np.zeros(99), np.zeros((2, 200)), np.full(200, np.nan)])
def test_series_is_checked(series):
    with pytest.raises(ValueError, match="series must be finite"):
        zero_one(series, seed=1)
