"""Lyapunov exponents of any map or flow from the stretching of its tangent vectors (Benettin et al. 1980)."""

import math

import numpy as np

from ...solver.jit import compiled
from ..stroboscopic_map import hides_determinant


@compiled
def orthonormalise(tangent, stretches):
    """Make the rows of `tangent`, shape (d, d), orthonormal, from the first one on (Gram-Schmidt).

    stretches : float64, shape (d,), filled with the logarithms of the lengths that the rows had
    """
    dimension = tangent.shape[0]
    for i in range(dimension):
        for j in range(i):
            along = 0.0
            for k in range(dimension):
                along += tangent[i, k] * tangent[j, k]
            for k in range(dimension):
                tangent[i, k] -= along * tangent[j, k]
        square = 0.0
        for k in range(dimension):
            square += tangent[i, k] * tangent[i, k]
        length = math.sqrt(square)
        stretches[i] = math.log(length)
        for k in range(dimension):
            tangent[i, k] /= length


@compiled
def log_multipliers(matrices, log_determinants):
    """Logarithms of the moduli of both eigenvalues of a product, the larger first.

    matrices : float64, shape (n, 2, 2), of positive determinants; the last one stands leftmost
    log_determinants : float64, shape (n,), of the matrices whose own determinant is lost in rounding
    """
    a, b, c, d = 1.0, 0.0, 0.0, 1.0
    size = both = 0.0  # logarithms of the product's size and determinant, either of which may be too small for a float
    for k in range(matrices.shape[0]):
        m = matrices[k]
        a, b, c, d = (
            m[0, 0] * a + m[0, 1] * c,
            m[0, 0] * b + m[0, 1] * d,
            m[1, 0] * a + m[1, 1] * c,
            m[1, 0] * b + m[1, 1] * d,
        )
        largest = max(abs(a), abs(b), abs(c), abs(d))
        a, b, c, d = a / largest, b / largest, c / largest, d / largest
        size += math.log(largest)
        both += log_determinants[k] if hides_determinant(m) else math.log(m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0])
    half = 0.5 * (a + d)
    square = half * half - math.exp(both - 2.0 * size)
    larger = size + math.log(abs(half) + math.sqrt(square)) if square > 0.0 else 0.5 * both
    return larger, both - larger


def exponents(stretches: np.ndarray, blocks: int) -> tuple[np.ndarray, np.ndarray]:
    """All exponents, the largest first, and their standard errors.

    Parameters
    ----------
    stretches : float64, shape (…, blocks × cycles, d), from `orthonormalise` after each of the cycles
    blocks : ≥ 2, whose means are taken to be independent

    Returns
    -------
    values, errors : float64, shape (…, d), 1/cycle: the means, and the standard errors of the means of the blocks
    """
    *leading, steps, dimension = stretches.shape
    means = stretches.reshape(*leading, blocks, steps // blocks, dimension).mean(axis=-2)
    return means.mean(axis=-2), means.std(axis=-2, ddof=1) / math.sqrt(blocks)
