"""The paper's estimates: an exponent in closed form, a dimension that comes out too small, and box counts."""

import numpy as np
import pytest

from conveyor import Conveyor, parameter_table, replace_parameters
from conveyor.analysis.fractals.scaling_region import normalise
from conveyor_pipeline.paper.orbits.published_estimates import box_dimension_of_paper, finite_difference_exponent


@pytest.mark.parametrize("method", ["event", "rk4"])
def test_the_exponent_of_a_flight(method):
    """In flight, a perturbation ε of the velocity shifts the height by ε t: Eq. 23 gives 0 and log(t) / t."""
    here, times = parameter_table(Conveyor(acceleration=20.0), z0=[10.0]), np.linspace(0.75, 1.0, 501)
    pushed = replace_parameters(here, vz0=1e-3)
    for output, wanted in (("vz", 0.0), ("z", np.mean(np.log(times) / times))):
        found = finite_difference_exponent(here, pushed, 1e-3, output=output, method=method, step=5e-4)
        assert found == pytest.approx([wanted], abs=1e-9)


def test_neighbours_separate_in_chaos():
    here = parameter_table(Conveyor(), acceleration=[40.0, 80.0], z0=3e-4)
    exponents = finite_difference_exponent(here, replace_parameters(here, z0=3e-4 + 1e-9), 1e-9, output="z")
    assert (exponents > 0.0).tolist() == [False, True]


def test_box_counting_misses_the_dimension_of_a_square_by_more_than_its_error():
    """Its smallest boxes contain too few points, which the method does not notice."""
    points = np.random.default_rng(1).random((10_000, 2))
    found = box_dimension_of_paper(points)
    assert found.value + found.error < 1.9
    boxes = {tuple(box) for box in np.floor(normalise(points) * 64.0).astype(int)}
    assert found.counts[5] == len(boxes)
