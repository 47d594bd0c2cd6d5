"""Linear algebra with fixed sums against NumPy's, and elementary functions against the C library's."""

import math

import numpy as np
import pytest

from conveyor import elementary, linear_algebra

RANDOM = np.random.default_rng(8)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 30])
def test_solutions_and_inverses(count):
    matrix, right = RANDOM.normal(size=(count, count)), RANDOM.normal(size=(count, 2))
    assert linear_algebra.solve(matrix, right) == pytest.approx(np.linalg.solve(matrix, right), rel=1e-9, abs=1e-9)
    assert linear_algebra.solve(matrix, right[:, 0]).shape == (count,)
    assert linear_algebra.inverse(matrix) == pytest.approx(np.linalg.inv(matrix), rel=1e-9, abs=1e-9)
    positive = matrix @ matrix.T + np.eye(count)
    stacked = np.array([positive, 2.0 * positive])
    assert linear_algebra.inverse_of_positive(stacked)[1] == pytest.approx(np.linalg.inv(2.0 * positive), abs=1e-9)
    assert linear_algebra.cholesky(positive) == pytest.approx(np.linalg.cholesky(positive), abs=1e-9)


def test_a_zero_on_the_diagonal_is_no_singular_matrix():
    matrix = np.array([[0.0, 2.0], [3.0, 0.0]])
    assert linear_algebra.solve(matrix, np.array([2.0, 3.0])).tolist() == [1.0, 1.0]
    assert linear_algebra.solve(np.array([[1.0, 2.0], [2.0, 4.0]]), np.ones(2)) is None
    with pytest.raises(ValueError, match="positive"):
        linear_algebra.cholesky(np.array([[1.0, 2.0], [2.0, 1.0]]))


def test_products_of_matrices_and_vectors():
    one, other, vector = RANDOM.normal(size=(5, 2, 3)), RANDOM.normal(size=(5, 3, 4)), RANDOM.normal(size=3)
    assert linear_algebra.product(one, other) == pytest.approx(one @ other)
    assert linear_algebra.product(one, vector) == pytest.approx(one @ vector)
    assert linear_algebra.product(vector, other[0]) == pytest.approx(vector @ other[0])
    assert linear_algebra.determinant(one[:, :, :2]) == pytest.approx(np.linalg.det(one[:, :, :2]))


@pytest.mark.parametrize("seed", range(20))
def test_eigenvalues_and_eigenvectors(seed):
    matrix = np.random.default_rng(seed).normal(size=(2, 2))
    values = linear_algebra.eigenvalues(matrix)
    assert abs(values[0]) >= abs(values[1]) - 1e-12
    ascending, expected = (
        sorted(map(complex, found), key=lambda value: (value.imag, value.real))
        for found in (values, np.linalg.eigvals(matrix))
    )
    assert ascending == pytest.approx(expected)
    for value in values:
        vector = linear_algebra.eigenvector(matrix, value)
        assert np.abs(matrix @ vector - value * vector).max() < 1e-12
        assert np.linalg.norm(vector) == pytest.approx(1.0) and vector[0].real <= 0.0


def test_the_null_vector_points_on():
    matrix, previous = RANDOM.normal(size=(3, 4)), RANDOM.normal(size=4)
    vector = linear_algebra.null_vector(matrix, previous)
    assert matrix @ vector == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.linalg.norm(vector) == pytest.approx(1.0) and vector @ previous > 0.0


def test_the_fitted_line_is_that_of_polyfit():
    x, y = RANDOM.normal(size=20), RANDOM.normal(size=20)
    coefficients, covariance = np.polyfit(x, y, 1, cov=True)
    slope, base, error = linear_algebra.fit_line(x, y)
    assert (slope, base, error) == pytest.approx((*coefficients, math.sqrt(covariance[0, 0])))


def test_elementary_functions_have_the_bits_of_the_c_library():
    values = np.concatenate([RANDOM.normal(scale=20.0, size=1000), [0.0, 1e-310]])
    for name in ("exp", "sin", "cos"):
        assert getattr(elementary, name)(values).tolist() == [getattr(math, name)(value) for value in values]
    assert elementary.log(abs(values[:-2])).tolist() == [math.log(abs(value)) for value in values[:-2]]
    assert elementary.power(abs(values), 1.5).tolist() == [math.pow(abs(value), 1.5) for value in values]
    assert elementary.log(np.array([0.0]))[0] == -math.inf
