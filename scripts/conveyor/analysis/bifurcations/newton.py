"""Newton's iteration, and curves of zeros, followed by pseudo-arclength (Keller 1977)."""

import math
from collections.abc import Callable, Iterator

import numpy as np

from ...linear_algebra import dot, length, solve

# A step that lengthens more may have jumped to another curve.
LONGER = 1.2
GROWTH = 1.3  # of the step after a success


def difference_quotients(functions: Callable[[np.ndarray], np.ndarray], point: np.ndarray, step: float) -> np.ndarray:
    """Derivatives of k functions by n unknowns, by central differences of a step, shape (k, n).

    Their error slows Newton's iteration a little; the zero that it converges to stays the same.
    """

    def quotient(place):
        forward, backward = point.copy(), point.copy()
        forward[place] += step
        backward[place] -= step
        return (functions(forward) - functions(backward)) / (forward[place] - backward[place])

    return np.column_stack([quotient(place) for place in range(len(point))])


def newton(
    system: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray] | None],
    guess: np.ndarray,
    direction: np.ndarray | None = None,
    *,
    converged: float,
    iterations: int,
    largest: float = math.inf,
    farthest: float = math.inf,
    stagnant: float = 0.0,
) -> np.ndarray | None:
    """The zero that Newton's iteration finds from a guess, shape (k,), or None.

    Parameters
    ----------
    system : functions at a point, and their derivatives; None where there are none
    direction : of k - 1 functions, the zero in the plane through the guess that is normal to this unit vector
    converged : largest component of the last step
    iterations : after which the search gives up
    largest, farthest : the component of a step, and the distance from the guess, at which the search gives up
    stagnant : a step below this that no longer shrinks is rounding, and ends the search
    """
    point, size = np.array(guess, dtype=np.float64), math.inf
    for _ in range(iterations):
        evaluated = system(point)
        if evaluated is None:
            return None
        value, slope = evaluated
        if direction is not None:
            value, slope = np.append(value, dot(direction, point - guess)), np.vstack([slope, direction])
        step = solve(slope, -value)
        if step is None:
            return None
        point = point + step
        previous, size = size, np.abs(step).max()
        if not (size < largest and length(point - guess) < farthest):
            return None
        if size < converged or (previous < stagnant and size > 0.1 * previous):
            return point
    return None


def follow_curve(
    correct: Callable[[np.ndarray, np.ndarray], np.ndarray | None],
    tangent_at: Callable[[np.ndarray, np.ndarray], np.ndarray | None],
    point: np.ndarray,
    direction: np.ndarray,
    *,
    first: float,
    smallest: float,
    largest: float,
    straight: float,
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, float]]:
    """Steps along a curve from one of its points, until no step is possible.

    A step consists of its first and last point, the unit vectors along the curve at these points, and its length.

    Parameters
    ----------
    correct : the point of the curve in the plane through a guess that is normal to a unit vector, or None
    tangent_at : unit vector along the curve at a point, pointing on from a previous one; None where there is none
    first, smallest, largest : arclengths of steps
    straight : cosine of the largest turn within a step
    """
    tangent, step = tangent_at(point, direction), first
    while tangent is not None:
        next_point = correct(point + step * tangent, tangent)
        next_tangent = None if next_point is None else tangent_at(next_point, tangent)
        if (
            next_tangent is None
            or not dot(next_tangent, tangent) > straight
            or length(next_point - point) > LONGER * step
        ):
            step *= 0.5
            if step < smallest:
                return
            continue
        yield point, next_point, tangent, next_tangent, step
        point, tangent = next_point, next_tangent
        step = min(GROWTH * step, largest)
