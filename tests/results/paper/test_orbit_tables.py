"""Orbits and exponents of the results: identities in every row."""

import numpy as np
import pytest


@pytest.fixture
def decay(result):
    """d_c/m of a table's settings, 1/s."""

    def of(table):
        return table.attrs["model"]["damping"] / table.attrs["model"]["mass"]

    return of


@pytest.mark.parametrize("name", ["branches", "folds_and_doublings", "cascade"])
def test_product_of_multipliers(result, decay, name):
    table = result(f"orbits/{name}")
    assert np.abs(table.determinant - np.exp(-decay(table) * table.contact_time)).max() < 1e-8


def test_sum_of_exponents(result, decay):
    table = result("lyapunov/spectrum")
    assert (table.status == "ok").all()
    assert np.abs(table.lambda_1 + table.lambda_2 + decay(table) * table.contact_fraction).max() < 1e-8


def test_multipliers_at_bifurcations(result):
    table = result("orbits/folds_and_doublings")
    for kind, value in (("fold", 1.0), ("period_doubling", -1.0)):
        assert np.abs(table[table.kind == kind].multiplier - value).max() < 1e-3
