"""Drift and diffusion of random walks in closed form."""

import doctest
import sys

import numpy as np
import pytest

from conveyor_pipeline.machine.operating.random_walk import (
    CORRELATED,
    NO_FLUCTUATIONS,
    OK,
    random_walk,
    relative_spread,
)

PERIOD = 0.02


def autoregressive(memory: float, runs: int = 64, cycles: int = 4096) -> np.ndarray:
    """Displacements 1 + u with u_k = memory u_(k-1) + a normal number: C_0 = 1/(1 - memory²), C_k = C_0 memory^k."""
    noise = np.random.default_rng(5).standard_normal((runs, cycles + 1000))
    u = np.zeros((runs, cycles + 1000))
    for k in range(1, u.shape[1]):
        u[:, k] = memory * u[:, k - 1] + noise[:, k]
    return 1.0 + u[:, 1000:]


@pytest.mark.parametrize("memory", [-0.5, 0.0, 0.8])
def test_diffusion_of_autoregressive_displacements(memory):
    """C_0 + 2 Σ C_k is 1/(1 - memory)²."""
    found = random_walk(autoregressive(memory), PERIOD)
    exact = 0.5 / (1.0 - memory) ** 2 / PERIOD
    assert found.status == OK
    assert found.velocity == pytest.approx(1.0 / PERIOD, abs=4.0 * found.velocity_stderr)
    assert found.diffusion == pytest.approx(exact, abs=4.0 * found.diffusion_stderr + 0.03 * exact)


def test_standard_errors_are_the_scatter_of_repeated_estimates():
    displacements = autoregressive(0.3, runs=640, cycles=1024)
    found = [random_walk(rows, PERIOD) for rows in np.split(displacements, 20)]
    for name in ("velocity", "diffusion"):
        scatter = np.std([getattr(one, name) for one in found], ddof=1)
        assert np.mean([getattr(one, f"{name}_stderr") for one in found]) == pytest.approx(scatter, rel=0.5)


def test_displacements_that_alternate_do_not_diffuse_more():
    """A chaotic motion between two bands: displacements alternate by ±1 besides their random part."""
    displacements = autoregressive(0.0) + np.where(np.arange(4096) % 2, 1.0, -1.0)
    assert random_walk(displacements, PERIOD).diffusion == pytest.approx(0.5 / PERIOD, rel=0.05)


def test_a_search_for_uncorrelated_windows_that_fails_says_so():
    """Each run has a velocity of its own."""
    displacements = np.random.default_rng(1).standard_normal((8, 1)) * np.ones(1024)
    found = random_walk(displacements, PERIOD)
    assert found.status == CORRELATED
    assert np.isnan(found.diffusion)


def test_correlations_that_come_back_in_longer_windows_are_found():
    """The displacement is bounded, and neighbouring windows are hardly correlated while they are short."""
    position = autoregressive(0.98)
    found = random_walk(1e-3 + np.diff(position, axis=1), PERIOD)
    assert found.status == CORRELATED
    assert np.isnan(found.diffusion)


def test_a_regular_motion_has_no_fluctuations():
    found = random_walk(np.full((4, 512), 1e-3), PERIOD)
    assert found.status == NO_FLUCTUATIONS
    assert found.velocity == pytest.approx(0.05)


def test_relative_spread_of_random_walks():
    """First passages of simulated walks, between the quantiles at one standard deviation."""
    steps = 1e-3 + 3e-3 * np.random.default_rng(2).standard_normal((2000, 4000))
    arrival = np.argmax(np.cumsum(steps, axis=1) >= 1.0, axis=1) * PERIOD
    low, high = np.quantile(1.0 / arrival, [0.1587, 0.8413])
    expected = relative_spread(1e-3 / PERIOD, 0.5 * 9e-6 / PERIOD, 1.0, 1.0)
    assert (high - low) / np.median(1.0 / arrival) == pytest.approx(expected, rel=0.1)


def test_examples():
    assert not doctest.testmod(sys.modules[random_walk.__module__], extraglobs={"np": np}).failed
