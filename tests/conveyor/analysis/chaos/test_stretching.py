"""Lyapunov exponents of maps and a flow with known exponents."""

import math

import numpy as np
import pytest

from conveyor.analysis.chaos.stretching import exponents, log_multipliers, orthonormalise

BLOCKS = 20


def stretches_of(step, state, dimension, cycles, transient=100):
    """Logarithms of the stretches along an orbit; `step` returns the next state and the Jacobian matrix there."""
    tangent, found = np.eye(dimension), np.empty((transient + cycles, dimension))
    for stretches in found:
        state, jacobian = step(state)
        tangent = np.ascontiguousarray(tangent @ jacobian.T)
        orthonormalise(tangent, stretches)
    return found[transient:]


def logistic(r):
    return lambda x: (r * x * (1.0 - x), np.array([[r * (1.0 - 2.0 * x)]]))


def henon(state):
    x, y = state
    return (1.0 - 1.4 * x * x + y, 0.3 * x), np.array([[-2.8 * x, 1.0], [0.3, 0.0]])


def lorenz_with_tangent(state):
    """The Lorenz equations (σ 10, r 28, b 8/3) and their variational equation; state of shape (4, 3)."""
    x, y, z = state[0]
    jacobian = np.array([[-10.0, 10.0, 0.0], [28.0 - z, -1.0, -x], [y, x, -8.0 / 3.0]])
    flow = np.array([10.0 * (y - x), x * (28.0 - z) - y, x * y - 8.0 / 3.0 * z])
    return np.vstack([flow, state[1:] @ jacobian.T])


def lorenz(point, step=0.01, steps=10):
    """A tenth of the unit of time, by RK4."""
    state = np.vstack([point, np.eye(3)])
    for _ in range(steps):
        k1 = lorenz_with_tangent(state)
        k2 = lorenz_with_tangent(state + 0.5 * step * k1)
        k3 = lorenz_with_tangent(state + 0.5 * step * k2)
        k4 = lorenz_with_tangent(state + step * k3)
        state = state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return state[0], state[1:].T


def test_logistic_map_in_chaos():
    """ln 2 at r = 4."""
    (value,), (error,) = exponents(stretches_of(logistic(4.0), 0.3, 1, 20_000), BLOCKS)
    assert abs(value - math.log(2.0)) < 3.0 * error < 0.02


def test_logistic_map_on_its_fixed_point():
    """ln |2 - r| at 1 < r < 3: negative, and without an error."""
    (value,), (error,) = exponents(stretches_of(logistic(2.8), 0.3, 1, 200, transient=500), BLOCKS)
    assert value == pytest.approx(math.log(0.8), abs=1e-12)
    assert error < 1e-12


def test_henon_map():
    """λ1 = 0.4192 (Sprott, Chaos and Time-Series Analysis, 2003); the sum is the logarithm of the determinant 0.3."""
    values, errors = exponents(stretches_of(henon, (0.1, 0.1), 2, 20_000), BLOCKS)
    assert abs(values[0] - 0.4192) < 3.0 * errors[0] < 0.03
    assert values.sum() == pytest.approx(math.log(0.3), abs=1e-12)


def test_lorenz_equations():
    """0.9056, 0, -14.5723 (Sprott 2003); the sum is the divergence -(σ + 1 + b)."""
    values, errors = exponents(stretches_of(lorenz, np.ones(3), 3, 4_000) / 0.1, BLOCKS)
    assert abs(values[0] - 0.9056) < 3.0 * errors[0] < 0.1
    assert values[1] == pytest.approx(0.0, abs=0.01)
    assert values.sum() == pytest.approx(-(10.0 + 1.0 + 8.0 / 3.0), abs=1e-3)  # RK4 errs by 1e-4


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_linear_maps(turn):
    """Logarithms of the moduli of the eigenvalues, positive and negative, in a skew basis; equal ones for a spiral."""
    basis = np.array([[1.0, 0.4], [0.3, 1.0]])
    if turn:
        core = 0.5 * np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        truth = [math.log(0.5)] * 2
    else:
        core, truth = np.diag([0.25, 2.0]), [math.log(2.0), math.log(0.25)]
    matrix = basis @ core @ np.linalg.inv(basis)
    values, _ = exponents(stretches_of(lambda _: (0.0, matrix), 0.0, 2, 2_000), BLOCKS)
    assert values == pytest.approx(truth, abs=2e-3)
    assert values.sum() == pytest.approx(math.log(np.linalg.det(matrix)), abs=1e-12)


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e4])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_eigenvalues_of_a_product(size, turn):
    """Products from right to left, real and complex, also if the product is too small or large for a float."""
    basis = np.array([[1.0, 0.4], [0.3, 1.0]])
    core = np.diag([0.5, 1.0]) if not turn else np.array([[0.6, -math.sin(turn)], [math.sin(turn), 0.6]])
    one = size * basis @ core @ np.linalg.inv(basis)
    other = np.array([[1.0, 2.0], [-0.5, 1.0]])
    modulus = math.log(abs(np.linalg.eigvals(core)[0])) + math.log(size) if turn else None
    truth = [modulus, modulus] if turn else [math.log(size), math.log(0.5 * size)]
    many = np.array([other, *[one] * 200, np.linalg.inv(other)])
    known = np.full(len(many), math.nan)  # no determinant is lost
    assert log_multipliers(many, known) == pytest.approx(200.0 * np.array(truth), abs=1e-9)


def test_a_determinant_that_underflows_is_the_known_one():
    matrix = np.diag([1e-200, 1e-200])[None]
    assert log_multipliers(matrix, np.array([-921.0])) == pytest.approx((-460.5, -460.5), abs=0.1)


@pytest.mark.parametrize("lost", [0.0, 1e-12, -1e-12])
def test_a_determinant_that_rounding_hides_is_the_known_one(lost):
    matrix = np.array([[[1.0, 1.0], [1.0, 1.0 + lost]]])
    found = log_multipliers(matrix, np.array([-80.0]))
    assert found == pytest.approx((math.log(2.0), -80.0 - math.log(2.0)), abs=1e-9)


def test_standard_error_by_hand():
    """Blocks with the means 1 and 3: mean 2, sample standard deviation √2, standard error √2/√2."""
    stretches = np.array([0.0, 2.0, 2.0, 4.0]).reshape(1, 4, 1)
    values, errors = exponents(stretches, 2)
    assert values[0, 0] == pytest.approx(2.0)
    assert errors[0, 0] == pytest.approx(1.0)
