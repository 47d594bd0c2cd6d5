"""Fits, fronts and profiles of misfits with known minima."""

import numpy as np
import pandas as pd
import pytest
from project import read_config
from scipy.stats import chi2

from conveyor import parameters
from identification import findings, fronts, profiles
from identification.fits import fit
from identification.search_space import LOSS, PARAMETERS, SEARCHED, bounds_of, packed, searched, values_of
from pipeline import pareto

CONFIG = read_config()
MODEL = CONFIG["model"]
OWN = CONFIG["identification"]
BOUNDS = bounds_of(OWN)
CENTRE = BOUNDS.mean(axis=0)
SETTINGS = {**OWN["search"], "population": 40, "generations": 40}


def test_values_of_and_searched_are_inverse():
    values = np.array([[0.15, 0.3, 5e5, 0.2], [0.3, 0.2, 1e5, 0.25]])
    assert values_of(searched(values, MODEL), MODEL) == pytest.approx(values)
    named = ("angle", "stiffness", "damping", "friction", "tension")
    places = [parameters.PARAMETERS.index(name) for name in named]
    assert packed(values, "clip", MODEL)[0, places].tolist() == [0.2, 5e5, 0.3, 0.15, 2.0]


def test_least_squares_finds_the_bottom_and_stops_at_bounds():
    target = np.array([0.3, 2.0])
    bounds = np.array([[-1.0, -1.0], [1.0, 1.0]])

    def residuals(x):
        assert ((x >= bounds[0]) & (x <= bounds[1])).all()
        return (x - target) * [1.0, 10.0]

    found = fit(residuals, np.zeros((1, 2)), bounds)
    assert found.x == pytest.approx([0.3, 1.0], abs=1e-6)
    assert found.total == pytest.approx(100.0)
    assert found.settled


def test_least_squares_returns_the_lowest_result_and_says_if_it_gave_up(monkeypatch):
    """Two valleys, of which the right one is deeper, and a search that is stopped after one step."""

    def residuals(x):
        return np.hstack([3.0 * (x**2 - 1.0), x - 2.0])

    bounds = np.array([[-3.0], [3.0]])
    for starts in ([[-0.9], [0.9]], [[0.9], [-0.9]]):
        assert fit(residuals, np.array(starts), bounds).x[0] > 0.9
    monkeypatch.setattr("identification.fits.EVALUATIONS", 1)
    assert not fit(residuals, np.array([[-0.9]]), bounds).settled


def test_least_squares_computes_no_misfit_twice():
    seen = []

    def residuals(x):
        seen.extend(map(tuple, x))
        return np.hstack([3.0 * (x**2 - 1.0), x - 2.0])

    fit(residuals, np.array([[-0.9, 0.5]]), np.array([[-3.0, -3.0], [3.0, 3.0]]))
    assert len(set(seen)) == len(seen) > 10


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_the_values_of_a_profile_ascend_within_the_bounds(parameter):
    grid = profiles.grid_of(parameter, 9, BOUNDS, MODEL)
    assert (np.diff(grid) > 0.0).all()
    column = list(PARAMETERS).index(parameter)
    low, high = values_of(BOUNDS, MODEL)[:, column]
    assert low <= grid[0] * (1.0 + 1e-9) and grid[-1] <= high * (1.0 + 1e-9)
    assert np.log(grid[-1] / grid[0]) > 0.8 * np.log(high / low)
    for value in grid:
        left = profiles.hold_parameter(parameter, value, BOUNDS, MODEL).bounds
        assert (np.ptp(left, axis=0) > 0.0).all()


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_a_held_parameter_is_held(parameter):
    column = list(PARAMETERS).index(parameter)
    value = float(values_of(CENTRE[None], MODEL)[0, column])
    space = profiles.hold_parameter(parameter, value, BOUNDS, MODEL)
    corners = np.stack(np.meshgrid(*space.bounds.T), axis=-1).reshape(-1, 3)
    whole = space.whole(corners)
    assert values_of(whole, MODEL)[:, column] == pytest.approx(value)
    assert np.delete(whole, column, axis=1) == pytest.approx(corners)
    assert (whole[:, LOSS] > BOUNDS[0, LOSS] - 1e-9).all() and (whole[:, LOSS] < BOUNDS[1, LOSS] + 1e-9).all()


def test_the_profile_of_a_linear_problem_is_a_parabola():
    """Two misfits of the sum and one of the first parameter: if it is held, the other parameters cancel the rest."""
    column = SEARCHED.index("friction")

    def misfits(x):
        y = x - CENTRE
        return np.stack([y.sum(axis=1), 3.0 * y[:, column] - 1.0], axis=1)

    grid = np.exp(CENTRE[column] + np.array([-0.3, 0.0, 0.3, 0.6]))
    pool = profiles.Pool(CENTRE[None], misfits(CENTRE[None]))
    found = profiles.find_profile(misfits, "friction", grid, CENTRE, pool, BOUNDS, MODEL)
    assert [total for _, total, _ in found] == pytest.approx((3.0 * np.log(grid / grid[1]) - 1.0) ** 2, abs=1e-6)
    assert {status for *_, status in found} == {"ok"}


def test_a_profile_continues_a_better_valley_backwards():
    """Two valleys over the angle. The search begins in the shallow one; one guess lies in the deep one."""
    column, other = SEARCHED.index("friction"), SEARCHED.index("angle")
    reach = np.ptp(BOUNDS[:, other])

    def misfits(x):
        t = (x[:, other] - CENTRE[other]) / reach
        shallow, deep = 50.0 * (t + 0.3) ** 2 + 1.0, 50.0 * (t - 0.3) ** 2 + 0.1
        return np.sqrt(np.minimum(shallow, deep))[:, None]

    grid = np.exp(CENTRE[column] + np.array([-0.3, 0.0, 0.3, 0.6]))
    begin, seen = CENTRE.copy(), CENTRE.copy()
    begin[other] -= 0.3 * reach
    seen[other] += 0.25 * reach
    seen[column] += 0.6
    pool = profiles.Pool(seen[None], misfits(seen[None]))
    found = profiles.find_profile(misfits, "friction", grid, begin, pool, BOUNDS, MODEL)
    assert [total for _, total, _ in found] == pytest.approx([0.1] * 4, abs=1e-5)


def test_a_profile_uses_no_guess_twice(monkeypatch):
    """The totals rise on both sides of the optimum, and each value was fitted from its better neighbour before."""
    column, starts_of = SEARCHED.index("friction"), []

    def watched(residuals, starts, bounds):
        starts_of.extend(map(tuple, residuals(starts)))
        return fit(residuals, starts, bounds)

    monkeypatch.setattr(profiles, "fit", watched)
    grid = np.exp(CENTRE[column] + np.array([-0.3, 0.0, 0.3, 0.6]))
    pool = profiles.Pool(CENTRE[None] + 0.01, np.zeros((1, 1)))
    profiles.find_profile(lambda x: x - CENTRE, "friction", grid, CENTRE, pool, BOUNDS, MODEL)
    assert len(set(starts_of)) == len(starts_of) > len(grid)


def test_status_names_a_bound_and_a_search_that_gave_up():
    bounds = np.array([[0.0], [1.0]])
    assert profiles.fit_status(profiles.Fit(np.array([1.0]), 0.0, True), bounds) == "at a bound"
    assert profiles.fit_status(profiles.Fit(np.array([0.5]), 0.0, False), bounds) == "not settled"


def test_ends_of_an_interval():
    x = np.array([-3.0, -2.0, -1.0, 0.0, 1.0, 2.0])
    total = x**2
    free = np.zeros(6, dtype=bool)
    assert findings.find_ends(x, total, free, 2.5) == ((-1.5, False), (1.5, False))
    assert findings.find_ends(x, total, x > 1.5, 2.5) == ((-1.5, False), (1.5, True))
    assert findings.find_ends(x, total, free, 5.0) == ((pytest.approx(-2.2), False), None)
    with pytest.raises(ValueError, match="above the level"):
        findings.find_ends(x, total, free, -1.0)


def test_rises_grow_if_the_best_misfit_exceeds_the_errors():
    optima = pd.DataFrame(
        {"evidence": ["a", "a", "b"], "tension": ["allow", "clip", "allow"], "total": [18.0, 20.0, 3.0], "numbers": 10}
    )
    found = profiles.add_rises(optima, 0.95)
    assert found.scale.tolist() == [3.0, 3.0, 1.0]
    assert found.rise.tolist() == pytest.approx([3.0 * 3.8415, 3.0 * 3.8415, 3.8415], rel=1e-4)
    assert found.rise_of_all.iloc[2] == pytest.approx(chi2.ppf(0.95, 4))


def conflict(x):
    """Misfits that cannot all be zero: 0, y, y - 1 and z."""
    y = (x - CENTRE) / np.ptp(BOUNDS, axis=0)
    return np.stack([4.0 * y[:, 1], 4.0 * y[:, 0], 4.0 * y[:, 0] - 1.0, 4.0 * y[:, 2]], axis=1)


SIZES = [2, 1, 1]


def objectives(x):
    return fronts.objectives(conflict(x), SIZES)


def test_objectives_are_root_mean_squares_of_their_groups():
    found = fronts.objectives(np.array([[3.0, 4.0, -2.0, 0.5]]), SIZES)
    assert found[0].tolist() == pytest.approx([np.sqrt(12.5), 2.0, 0.5])


def test_the_front_of_two_parabolas():
    """Between their minima, the first objective is y/√2, the second is 1 - y, and the third can be zero."""
    drawn = np.random.default_rng(1).uniform(*BOUNDS, (50, 4))
    first = fronts.fit_compromises(conflict, SIZES, drawn, BOUNDS, SETTINGS)
    x, found, shares = fronts.search(objectives, first, BOUNDS, SETTINGS, 1)
    sums = found[:, 0] * np.sqrt(2.0) + found[:, 1]
    assert sums.min() > 1.0 - 1e-9
    y = np.linspace(0.0, 1.0, 21)
    true = np.stack([y / np.sqrt(2.0), 1.0 - y, np.zeros(21)], axis=1)
    assert np.abs(found[:, None] - true).max(axis=-1).min(axis=0).max() < 0.08
    # The cube of 4 x 4 x 4 without the prism below the front.
    assert shares[-1] == pytest.approx(1.0 - 0.5 / np.sqrt(2.0) * 4.0 / 4.0**3, abs=0.002)
    assert (np.diff(shares) >= 0.0).all()
    again, *_ = fronts.search(objectives, first, BOUNDS, SETTINGS, 1)
    assert np.array_equal(x, again)


def test_a_search_that_has_not_converged_says_so():
    front = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    still, grows = [0.5] * 20, [0.01 * n for n in range(1, 21)]

    def status(*found):
        return fronts.status([pareto.Front(front, *one) for one in found], OWN["search"])

    assert status((front, still), (front, still)) == "converged"
    assert "still grows" in status((front, grows), (front, grows))
    assert "hypervolumes differ" in status((front, still), (front, [0.6] * 20))
    assert "apart" in status((front, still), (front + 0.5, still))
    assert fronts.distance(front, front + 0.5) == pytest.approx(0.5)
