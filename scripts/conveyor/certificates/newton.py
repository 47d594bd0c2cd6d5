"""Zeros of equations: approximations by Newton's iteration, boxes with exactly one zero by Krawczyk's operator."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_mat

from .. import linear_algebra
from .balls import Refused

# Corrections of an approximate zero, and enlargements of a box that is too small.
CORRECTIONS, INFLATIONS = 8, 4
# After a correction of this size the zero, if any, is not near the approximation.
FARTHEST = 1.0

# A function of a box of unknowns x and a flag. It returns f(x), f'(x) (None without the flag) and intermediate results.
Equations = Callable[[arb_mat, bool], tuple[arb_mat, arb_mat | None, Any]]


class Approximation(NamedTuple):
    """A point near a zero of f."""

    centre: arb_mat  # exact, shape (n, 1)
    value: arb_mat  # f there
    inverse: arb_mat  # of f' there or nearby, approximate, exact numbers


class Zero(NamedTuple):
    """Exactly one zero in a box, shape (n, 1)."""

    enclosure: arb_mat  # contains the zero
    box: arb_mat  # contains no other zero
    evidence: Any  # intermediate results of the equations over the box


def midpoints(matrix: arb_mat) -> np.ndarray:
    """The midpoints of a matrix of balls, rounded to floats."""
    return np.array([[float(value) for value in row] for row in matrix.tolist()])


def exact(values: np.ndarray) -> arb_mat:
    """A matrix of floats, exact."""
    return arb_mat([[arb(float(value)) for value in row] for row in values])


def approximate_inverse(slope: arb_mat) -> arb_mat:
    """The inverse of a matrix in floating point; a preconditioner need not be exact.

    Refused if the matrix is singular in floating point.
    """
    inverse = linear_algebra.inverse(midpoints(slope))
    if inverse is None or not np.isfinite(inverse).all():
        raise Refused("the linearisation is singular")
    return exact(inverse)


def correct(equations: Equations, near: Approximation, least: float) -> Approximation:
    """Improve an approximation until Newton's correction is within its own radius and `least`; nothing is proved here.

    Refused if there is no zero nearby.
    """
    last = math.inf
    for _ in range(CORRECTIONS):
        step = (near.inverse * near.value).entries()
        size = max(float(abs(entry.mid())) for entry in step)
        if not size < FARTHEST:
            break
        if not size < 0.5 * last or all(abs(entry.mid()) <= entry.rad() + least for entry in step):
            return near
        last = size
        pairs = zip(near.centre.entries(), step, strict=True)
        centre = arb_mat([[(entry - change).mid()] for entry, change in pairs])
        near = near._replace(centre=centre, value=equations(centre, False)[0])
    raise Refused("Newton's iteration finds nothing nearby")


def krawczyk(value: arb_mat, slope: arb_mat, inverse: arb_mat, deviation: arb_mat) -> arb_mat:
    """Krawczyk's operator on a box around c, less c: K = -C f(c) + (I - C f'(X)) (X - c).

    Every zero of f in the box X lies in c + K. If K lies inside X - c, then x - C f(x) maps X into its interior and
    contracts (Krawczyk 1969, Rump 1983): C and every matrix in f'(X) are regular, and f has exactly one zero in X. If f
    depends on a parameter whose ball entered f(c) and f'(X), that holds for each of its values, and the zero is as
    smooth a function of it as f is, by the theorem on implicit functions.

    Parameters
    ----------
    value, slope : f at the centre c, shape (n, 1), and f' over the box, shape (n, n)
    inverse : C, shape (n, n)
    deviation : X - c, shape (n, 1)
    """
    count = deviation.nrows()
    identity = arb_mat(count, count, [int(i == j) for i in range(count) for j in range(count)])
    return (identity - inverse * slope) * deviation - inverse * value


def prove_zero(equations: Equations, near: Approximation, least: float) -> Zero:
    """Exactly one zero in a box around the centre of an approximation.

    The radii of the box are twice Newton's correction plus `least`. A parameter with a wide ball makes this correction
    wide. If the image of the box does not lie inside the box, the box is enlarged to contain the image. Refused if the
    box holds no zero, or no enlarged box contains its image.
    """
    centre, value, inverse = near
    radii = [2 * abs(step).upper() + least for step in (inverse * value).entries()]
    for _ in range(INFLATIONS):
        deviation = arb_mat([[arb(0, size)] for size in radii])
        box = centre + deviation
        _, slope, evidence = equations(box, True)
        image = krawczyk(value, slope, inverse, deviation)
        pairs = list(zip(deviation.entries(), image.entries(), strict=True))
        if all(wide.contains_interior(narrow) for wide, narrow in pairs):
            return Zero(centre + image, box, evidence)
        if any(not wide.overlaps(narrow) for wide, narrow in pairs):
            raise Refused("there is no zero in the box")
        radii = [size.max(2 * abs(narrow).upper()) for size, (_, narrow) in zip(radii, pairs, strict=True)]
    raise Refused("no zero is proved: Krawczyk's image of the box does not lie inside the box")
