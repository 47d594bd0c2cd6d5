"""Zeros of equations: an approximate one by Newton's iteration, then a box with exactly one by Krawczyk's operator."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_mat

from .balls import Refused, middle

# Corrections of an approximate zero, and enlargements of a box that is too small.
CORRECTIONS, INFLATIONS = 8, 4
# A correction of this size leads somewhere else.
FARTHEST = 1.0

# f(x) and f'(x), None where it is not wanted, over a ball of unknowns, and whatever else was found on the way.
Equations = Callable[[arb_mat, bool], tuple[arb_mat, arb_mat | None, Any]]


class Approximation(NamedTuple):
    """Near a zero."""

    centre: arb_mat  # exact, shape (n, 1)
    value: arb_mat  # f there
    inverse: arb_mat  # of f' there, about, exact


class Zero(NamedTuple):
    """Exactly one zero in a box, shape (n, 1)."""

    enclosure: arb_mat  # that holds it
    box: arb_mat  # in which there is no other
    evidence: Any  # what the equations found on the way, over the box


def floats(matrix: arb_mat) -> np.ndarray:
    """The centres of a matrix of balls."""
    return np.array([[float(value) for value in row] for row in matrix.tolist()])


def exact(values: np.ndarray) -> arb_mat:
    """A matrix of floats, exact."""
    return arb_mat([[arb(float(value)) for value in row] for row in values])


def inverse_of(slope: np.ndarray) -> np.ndarray:
    """An approximate inverse of a matrix: a preconditioner need not be right.

    Raises
    ------
    Refused
        if the matrix is singular in floating point
    """
    try:
        inverse = np.linalg.inv(slope)
    except np.linalg.LinAlgError:
        raise Refused("the linearisation is singular") from None
    if not np.isfinite(inverse).all():
        raise Refused("the linearisation is singular")
    return inverse


def corrected(equations: Equations, start: np.ndarray, slope: np.ndarray, least: float) -> Approximation:
    """An approximate zero; nothing is proved here.

    It is corrected until what remains of a correction is less than its own width and `least`.

    Parameters
    ----------
    equations, least : the equations, and the least radius of a box around the zero
    start, slope : a point near it, and the derivative there, in floating point, shapes (n,) and (n, n)

    Raises
    ------
    Refused
        if there is none nearby
    """
    centre, inverse, last = exact(start[:, None]), exact(inverse_of(slope)), math.inf
    for _ in range(CORRECTIONS):
        found = Approximation(centre, equations(centre, False)[0], inverse)
        step = (inverse * found.value).entries()
        size = max(float(abs(middle(entry))) for entry in step)
        if not size < FARTHEST:
            break
        if not size < 0.5 * last or all(abs(middle(entry)) <= entry.rad() + least for entry in step):
            return found
        last = size
        centre = arb_mat([[middle(entry - change)] for entry, change in zip(centre.entries(), step, strict=True)])
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


def prove(equations: Equations, near: Approximation, least: float, what: str, radius: float | None = None) -> Zero:
    """Exactly one zero in a box around the centre of an approximation.

    The box is twice as wide as Newton's correction, whose width a parameter with a wide ball makes, and at least as
    wide as `least`; a box that proves nothing is enlarged where its image sticks out. With a `radius` this box alone
    is tried.

    Raises
    ------
    Refused
        with the reason
    """
    centre, value, inverse = near
    radii = [2 * abs(step).upper() + least if radius is None else arb(radius) for step in (inverse * value).entries()]
    for _ in range(INFLATIONS if radius is None else 1):
        deviation = arb_mat([[arb(0, size)] for size in radii])
        box = centre + deviation
        _, slope, evidence = equations(box, True)
        image = krawczyk(value, slope, inverse, deviation)
        pairs = list(zip(deviation.entries(), image.entries(), strict=True))
        if all(wide.contains_interior(narrow) for wide, narrow in pairs):
            return Zero(centre + image, box, evidence)
        if any(not wide.overlaps(narrow) for wide, narrow in pairs):
            raise Refused(f"there is no {what} in the box")
        radii = [size.max(2 * abs(narrow).upper()) for size, (_, narrow) in zip(radii, pairs, strict=True)]
    raise Refused(f"no {what} is proved: Newton's image of the box does not lie inside it")
