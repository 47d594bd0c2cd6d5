"""Roots of polynomials with known roots."""

import math

import numba
import numpy as np
import pytest

from conveyor.solver import polynomial

ROW = polynomial.FIRST_ROW


@numba.njit
def root_of_crossing(series, row, low, high):
    return polynomial.root_of_crossing(series, row, low, high)


def series_of(roots):
    """Rows as in the solver: the coefficients of Π (1 - s/r), positive at 0."""
    coefficients = np.ones(1)
    for root in roots:
        coefficients = np.convolve(coefficients, [1.0, -1.0 / root])
    series = np.zeros(polynomial.SIZE)
    series[ROW : ROW + len(coefficients)] = coefficients.real
    return series


@pytest.mark.parametrize("distance", [0.3, 1e-2, 1e-4])
def test_no_pair_of_roots_is_missed(distance):
    """Between two roots a polynomial is below zero, and above it at both ends of the search."""
    for first in np.linspace(0.05, 0.65, 25):
        for others in ((), (1.2,), (-0.5, -0.7), (3.0, -2.0)):
            found = polynomial.first_root(
                series_of([first, first + distance, *others]), ROW, 0.0, 1.0, polynomial.LEAVE
            )
            # If the first step ends on the root, it counts as a start on it, which two smallest steps leave.
            assert found == pytest.approx(first, abs=3.0 * polynomial.LEAVE)


def test_first_root_is_the_least_of_all():
    generator = np.random.default_rng(1)
    inside = 0
    for _ in range(400):
        roots = generator.uniform(0.0, 1.5, 6) * generator.choice([-1.0, 1.0], 6)
        pair = generator.uniform(-1.0, 1.0) + 1j * generator.uniform(0.1, 1.0)
        ahead = roots[(roots > 0.0) & (roots <= 1.0)]
        found = polynomial.first_root(series_of([*roots, pair, np.conj(pair)]), ROW, 0.0, 1.0, polynomial.LEAVE)
        if len(ahead):
            assert found == pytest.approx(ahead.min(), rel=1e-6)
            inside += 1
        else:
            assert found == math.inf
    assert 200 < inside < 400


@pytest.mark.parametrize("exponent", [-60, -50, -40, -30, -20])
def test_a_root_next_to_zero_is_found_relative_to_itself(exponent):
    """A separation from a tiny penetration, in steps of usual lengths."""
    generator = np.random.default_rng(1)
    for _ in range(50):
        root, length = 10.0 ** generator.uniform(exponent, exponent + 1), generator.uniform(0.01, 1.0)
        series = series_of([root])
        series[ROW:] *= root  # as √penetration: small, with a speed of usual size
        series[ROW + 3] = -30.0
        assert root_of_crossing(series, ROW, 0.0, length) == pytest.approx(root, rel=1e-9, abs=0.0)
