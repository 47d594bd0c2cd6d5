"""Linear algebra of small matrices, with every sum in a fixed order.

NumPy hands `@` and `numpy.linalg` to kernels that round differently on different processors. Where a last digit decides
which step a continuation takes, or which points a search draws, these functions give the same bits everywhere. They are
fast enough for matrices of a few dozen rows.
"""

import cmath
from collections.abc import Iterable
from functools import reduce

import numpy as np


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Sum of the products along the last axis, shape (…), for arrays of shape (…, n)."""
    return np.sum(a * b, axis=-1)


def length(vector: np.ndarray) -> np.ndarray:
    """Euclidean length along the last axis, shape (…), for an array of shape (…, n)."""
    return np.sqrt(dot(vector, vector))


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Product of matrices of shapes (…, n, k) and (…, k, m), or of one and a vector, shape (k,), on either side."""
    if b.ndim == 1:
        return dot(a, b)
    if a.ndim == 1:
        return np.sum(a[:, None] * b, axis=-2)
    return np.sum(a[..., :, :, None] * b[..., None, :, :], axis=-2)


def chain(matrices: Iterable[np.ndarray]) -> np.ndarray:
    """The product of matrices in the order in which they act: the last one stands leftmost."""
    return reduce(lambda whole, following: product(following, whole), matrices)


def determinant(matrix: np.ndarray) -> np.ndarray:
    """Determinant of matrices of shape (…, 2, 2)."""
    return matrix[..., 0, 0] * matrix[..., 1, 1] - matrix[..., 0, 1] * matrix[..., 1, 0]


def solve(matrix: np.ndarray, right: np.ndarray) -> np.ndarray | None:
    """The solution of a linear system, of the shape of `right`, (n,) or (n, m); None for a singular matrix, (n, n).

    Gaussian elimination with partial pivoting.
    """
    count = len(matrix)
    rows = np.column_stack([matrix, right])
    for k in range(count):
        pivot = k + int(np.abs(rows[k:, k]).argmax())
        if rows[pivot, k] == 0.0:
            return None
        rows[[k, pivot]] = rows[[pivot, k]]
        rows[k + 1 :] -= rows[k + 1 :, k, None] / rows[k, k] * rows[k]
    for k in range(count - 1, -1, -1):
        rows[k] /= rows[k, k]
        rows[:k] -= rows[:k, k, None] * rows[k]
    return rows[:, count:].reshape(np.shape(right))


def inverse(matrix: np.ndarray) -> np.ndarray | None:
    """The inverse of a matrix, shape (n, n); None for a singular one."""
    return solve(matrix, np.eye(len(matrix)))


def inverse_of_positive(matrix: np.ndarray) -> np.ndarray:
    """Inverses of symmetric, positive definite matrices, shape (…, n, n): Gauss and Jordan, without pivoting."""
    count = matrix.shape[-1]
    rows = np.concatenate([matrix, np.broadcast_to(np.eye(count), matrix.shape)], axis=-1)
    for k in range(count):
        rows[..., k, :] /= rows[..., k, k, None]
        for other in range(count):
            if other != k:
                rows[..., other, :] -= rows[..., other, k, None] * rows[..., k, :]
    return rows[..., count:]


def fit_line(x: np.ndarray, y: np.ndarray) -> tuple[float, float, float]:
    """Least squares of y = base + slope x for data of shape (n,), n > 2: slope, base, standard error of the slope."""
    centred = x - np.mean(x)
    squares = dot(centred, centred)
    slope = dot(centred, y) / squares
    residuals = y - np.mean(y) - slope * centred
    error = np.sqrt(dot(residuals, residuals) / (len(x) - 2) / squares)
    return float(slope), float(np.mean(y) - slope * np.mean(x)), float(error)


def eigenvalues(matrix: np.ndarray) -> tuple[complex, complex]:
    """Both eigenvalues of a matrix, shape (2, 2), the one of larger modulus first."""
    half, product_of_both = 0.5 * complex(matrix[0, 0] + matrix[1, 1]), float(determinant(matrix))
    # The difference on the diagonal cancels less than the square of the trace minus the determinant.
    gap = 0.5 * (matrix[0, 0] - matrix[1, 1])
    root = cmath.sqrt(gap * gap + matrix[0, 1] * matrix[1, 0])
    first = max(half + root, half - root, key=abs)
    return first, product_of_both / first if first != 0.0 else 0.0j


def eigenvector(matrix: np.ndarray, eigenvalue: complex) -> np.ndarray:
    """Unit eigenvector of a matrix, shape (2, 2), for an eigenvalue that need not be exact; real for a real one.

    Of both directions, it is the one whose first component has a real part below zero.
    """
    # Each row of A - μ gives the direction normal to it; the longer row is the more accurate one.
    rows = matrix - eigenvalue * np.eye(2)
    row = rows[int(np.argmax(length(np.abs(rows))))]
    vector = np.array([-row[1], row[0]]) if np.real(row[1]) > 0.0 else np.array([row[1], -row[0]])
    size = length(np.abs(vector))
    return vector / size if size > 0.0 else np.array([-1.0, 0.0])


def cholesky(matrix: np.ndarray) -> np.ndarray:
    """The lower triangular L with L Lᵀ equal to a positive definite matrix, shape (n, n).

    ValueError for a matrix that is not positive definite.
    """
    lower = np.zeros_like(matrix)
    for k in range(len(matrix)):
        pivot = matrix[k, k] - dot(lower[k, :k], lower[k, :k])
        if not pivot > 0.0:
            raise ValueError("the matrix is not positive definite")
        lower[k, k] = np.sqrt(pivot)
        lower[k + 1 :, k] = (matrix[k + 1 :, k] - dot(lower[k + 1 :, :k], lower[k, :k])) / lower[k, k]
    return lower


def null_vector(matrix: np.ndarray, previous: np.ndarray) -> np.ndarray | None:
    """The unit vector, shape (n,), that a matrix of shape (n - 1, n) maps to 0, at an acute angle to `previous`.

    None if the rows and `previous` are linearly dependent.
    """
    right = np.zeros(len(previous))
    right[-1] = 1.0
    vector = solve(np.vstack([matrix, previous]), right)
    return None if vector is None else vector / length(vector)
