"""Lyapunov exponents of any map or flow from the stretching of its tangent vectors (Benettin et al. 1980)."""

import math

import numpy as np

from ..solver.jit import kernel


@kernel
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
