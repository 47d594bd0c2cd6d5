"""Intervals and open ends of known densities. Smoothing carries an interval to a bound, or beyond, if it is open."""

import numpy as np
import pytest
from scipy.stats import norm

from conveyor_pipeline.machine.calibration.credible_intervals import open_ends, summarize

BOUNDS = (-5.0, 5.0)
VALUES = np.linspace(*BOUNDS, 2001)


def weights(logs):
    density = np.exp(logs - logs.max())
    return density / density.sum()


@pytest.mark.parametrize(
    ("logs", "ends", "is_open"),
    [
        (-0.5 * VALUES**2, norm.interval(0.95), (False, False)),
        (2.0 * VALUES, (5.0 + 0.5 * np.log(0.025), 5.0), (False, True)),
        (0.0 * VALUES, (-5.0, 5.0), (True, True)),
    ],
)
def test_a_normal_an_exponential_and_an_even_density(logs, ends, is_open):
    of_density = weights(logs)
    median, *found = summarize([VALUES], of_density)[0]
    assert found == pytest.approx(ends, abs=0.2)
    assert of_density[median > VALUES].sum() == pytest.approx(0.5, abs=0.1)
    assert open_ends(VALUES, of_density, BOUNDS) == is_open


def test_equal_values_have_an_interval():
    assert summarize([np.full(10, 0.3)], np.full(10, 0.1)) == pytest.approx(0.3)
