"""Random points of sets whose dimension is known."""

import math

import numpy as np


def cantor(rng: np.random.Generator, n: int) -> np.ndarray:
    """n points of the Cantor set, shape (n, 2), the second coordinate zero."""
    x = (2 * rng.integers(0, 2, (n, 32)) / 3.0 ** np.arange(1, 33)).sum(axis=1)
    return np.column_stack([x, np.zeros(n)])


def sierpinski(rng: np.random.Generator, n: int) -> np.ndarray:
    """n points of Sierpinski's triangle, shape (n, 2)."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.75**0.5]])
    return np.einsum("nkd,k->nd", corners[rng.integers(0, 3, (n, 40))], 0.5 ** np.arange(1, 41))


def circle(rng: np.random.Generator, n: int) -> np.ndarray:
    """n points of a circle, shape (n, 2)."""
    angle = rng.uniform(0.0, 2 * np.pi, n)
    return np.column_stack([np.cos(angle), np.sin(angle)])


def square(rng: np.random.Generator, n: int) -> np.ndarray:
    """n points of a filled square, shape (n, 2)."""
    return rng.random((n, 2))


REFERENCE_DIMENSIONS = {
    cantor: math.log(2.0) / math.log(3.0),
    sierpinski: math.log(3.0) / math.log(2.0),
    circle: 1.0,
    square: 2.0,
}
