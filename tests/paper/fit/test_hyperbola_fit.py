"""Fits of Eq. 13 to data from Eq. 13."""

import numpy as np
import pytest

from conveyor_pipeline.paper.fit.hyperbola_fit import (
    Hyperbola,
    critical_height,
    fit_hyperbola,
    fit_hyperbola_by_pymoo,
    hyperbola_profile,
    mean_squared_error,
)

ACCELERATION = np.linspace(29.0, 47.0, 25)
PAPER = Hyperbola(0.004116, -19.54145, -0.0001354)
TRIPLES = [PAPER, Hyperbola(0.02, 5.0, -4e-4), Hyperbola(-0.01, 30.0, 3e-4), Hyperbola(0.001, -26.0, 0.0)]
BOUNDS = {"A": (-0.05, 0.1), "B": (-28.5, 60.0), "C": (-2e-3, 1e-3)}
SCATTER = 1e-6 * np.random.default_rng(0).standard_normal(25)


@pytest.mark.parametrize("triple", TRIPLES)
def test_least_squares_recovers_the_triple(triple):
    fit = fit_hyperbola(ACCELERATION, critical_height(ACCELERATION, triple), BOUNDS["B"])
    assert fit == pytest.approx(triple, rel=1e-7, abs=1e-12)


def test_least_squares_has_no_gradient_left():
    """An independent check: no change of a parameter, alone or along the valley, lowers the error."""
    height = critical_height(ACCELERATION, PAPER) + SCATTER
    fit = fit_hyperbola(ACCELERATION, height, BOUNDS["B"])
    error = mean_squared_error(ACCELERATION, height, fit)
    steps = np.vstack([np.diag(np.abs(fit)), -np.diag(np.abs(fit))]) * 1e-4
    assert (mean_squared_error(ACCELERATION, height, fit + steps) > error).all()
    _, valley = hyperbola_profile(ACCELERATION, height, np.linspace(*BOUNDS["B"], 2001))
    assert error <= valley.min() < 1.001 * error


def test_profile_is_the_best_for_each_b():
    height = critical_height(ACCELERATION, PAPER) + SCATTER
    b = np.array([-25.0, -19.0, 0.0, 40.0])
    parameters, error = hyperbola_profile(ACCELERATION, height, b)
    for i in range(len(b)):
        design = np.column_stack([1.0 / (b[i] + ACCELERATION), np.ones(25)])
        (a, c), residual, *_ = np.linalg.lstsq(design, height, rcond=None)
        assert parameters[i] == pytest.approx([a, b[i], c], rel=1e-8)
        assert error[i] == pytest.approx(residual[0] / 25, rel=1e-8)


@pytest.mark.parametrize("triple", TRIPLES)
def test_pymoo_reaches_the_least_squares_error(triple):
    height = critical_height(ACCELERATION, triple) + SCATTER
    fit = fit_hyperbola_by_pymoo(ACCELERATION, height, BOUNDS, 0, 5000)
    best = mean_squared_error(ACCELERATION, height, fit_hyperbola(ACCELERATION, height, BOUNDS["B"]))
    assert best * (1 - 1e-9) <= mean_squared_error(ACCELERATION, height, fit) <= 1.01 * best
    for name, value in fit._asdict().items():
        assert BOUNDS[name][0] <= value <= BOUNDS[name][1]


def test_same_seed_same_result():
    height = critical_height(ACCELERATION, PAPER) + SCATTER
    first, second = (fit_hyperbola_by_pymoo(ACCELERATION, height, BOUNDS, 0, 600) for _ in range(2))
    assert first == second
    assert fit_hyperbola_by_pymoo(ACCELERATION, height, BOUNDS, 1, 600) != first
