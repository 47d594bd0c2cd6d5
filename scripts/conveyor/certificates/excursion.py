"""Where a horseshoe may lie: a homoclinic excursion of a saddle of the stroboscopic map, in floating point.

Nothing is proved here. The parallelograms around the saddle and along the excursion go to `covering`, which proves that
they cover one another. All points are (δ, Y) in units of the law, the library's scaled unknowns.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .. import linear_algebra
from ..analysis.bifurcations.newton import newton
from ..analysis.bifurcations.periodic_orbits import ReturnMap
from .balls import Refused

# Distance from the fixed point at which trial excursions begin, and the distance within which they must return, in
# scaled unknowns.
LEAVING, RETURNED = 1e-4, 0.2
# Trial excursions on each side; bisections of an excursion's beginning.
EXCURSIONS, BISECTIONS = 1000, 60
CONVERGED, CORRECTIONS = 1e-10, 12  # of Newton's iteration: its last correction, and the number of corrections
# Share of the half axes of the first set at which an excursion begins, and within which it ends.
BEGINNING = 0.6


class Saddle(NamedTuple):
    """A fixed point of the map of one cycle with one multiplier outside and one inside the unit circle."""

    parameters: np.ndarray  # packed conveyor
    point: np.ndarray  # (δ, Y)
    amplitude: float  # m/s²
    multipliers: np.ndarray  # the unstable one, the stable one
    axes: np.ndarray  # their directions in columns


def iterate(parameters: np.ndarray, amplitude: float, point: np.ndarray, cycles: int) -> np.ndarray:
    """The images of a point after 0 … cycles cycles, shape (cycles + 1, 2)."""
    return np.vstack([point, ReturnMap(parameters, cycles).strobes(np.append(point, amplitude))[:, :2]])


def differentiate(parameters: np.ndarray, amplitude: float, point: np.ndarray) -> np.ndarray:
    """Derivative of the map of one cycle, shape (2, 2)."""
    return ReturnMap(parameters, 1).residual(np.append(point, amplitude))[1] + np.eye(2)


def find_saddle(parameters: np.ndarray, amplitude: float, point: np.ndarray) -> Saddle:
    """Multipliers and directions of a fixed point.

    Refused if the fixed point is no saddle.
    """
    matrix = differentiate(parameters, amplitude, point)
    multipliers = linear_algebra.eigenvalues(matrix)
    if multipliers[0].imag != 0.0 or not abs(multipliers[0]) > 1.0 > abs(multipliers[1]):
        raise Refused("the fixed point is no saddle")
    multipliers = np.real(multipliers)
    axes = np.column_stack([linear_algebra.eigenvector(matrix, multiplier) for multiplier in multipliers])
    return Saddle(parameters, point, amplitude, multipliers, axes)


def project(saddle: Saddle, points: np.ndarray) -> np.ndarray:
    """Coordinates of points along the unstable and the stable direction, shape (n, 2)."""
    return linear_algebra.solve(saddle.axes, (points - saddle.point).T).T


def leave(saddle: Saddle, distance: float, cycles: int) -> np.ndarray:
    """The iterates of a point at a distance along the unstable direction, shape (cycles + 1, 2)."""
    return iterate(saddle.parameters, saddle.amplitude, saddle.point + distance * saddle.axes[:, 0], cycles)


def crossings(saddle: Saddle, longest: int) -> Iterator[tuple[int, float, float]]:
    """Excursions that cross the stable direction, the shortest first.

    Each has its number of cycles, and two neighbouring initial distances between which it begins.
    """
    distances = LEAVING * np.geomspace(1.0 / abs(saddle.multipliers[0]), 1.0, EXCURSIONS)
    sides = distances, -distances
    across = [np.array([project(saddle, leave(saddle, one, longest))[:, 0] for one in side]) for side in sides]
    for cycles in range(2, longest + 1):
        for side, of_side in zip(sides, across, strict=True):
            for k in np.flatnonzero(of_side[1:, cycles] * of_side[:-1, cycles] < 0.0):
                yield cycles, side[k], side[k + 1]


def find_excursions(saddle: Saddle, longest: int) -> Iterator[np.ndarray]:
    """Excursions that leave along the unstable and return along the stable direction, each of the shape (n, 2).

    The shortest come first. Refused after the last one, of up to `longest` cycles.
    """
    for cycles, low, high in crossings(saddle, longest):
        sign = project(saddle, leave(saddle, low, longest))[cycles, 0]
        for _ in range(BISECTIONS):
            centre = 0.5 * (low + high)
            same = project(saddle, leave(saddle, centre, longest))[cycles, 0] * sign > 0.0
            low, high = (centre, high) if same else (low, centre)
        path = leave(saddle, low, longest)[: cycles + 1]
        if np.abs(project(saddle, path[-1:])).max() < RETURNED:
            yield path
    raise Refused(f"no further excursion of up to {longest} cycles returns to the fixed point")


def correct_path(saddle: Saddle, path: np.ndarray) -> np.ndarray | None:
    """The orbit near a path whose ends lie on the straight unstable and stable directions, shape (n, 2), or None.

    All of its points are unknowns of Newton's iteration.
    """
    count, across = len(path), linear_algebra.inverse(saddle.axes)

    def system(unknown):
        points = unknown.reshape(count, 2)
        slope, value = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
        slope[0, :2], value[0] = across[1], project(saddle, points[:1])[0, 1]
        slope[-1, -2:], value[-1] = across[0], project(saddle, points[-1:])[0, 0]
        for k in range(count - 1):
            rows = slice(2 * k + 1, 2 * k + 3)
            slope[rows, 2 * k : 2 * k + 2] = differentiate(saddle.parameters, saddle.amplitude, points[k])
            slope[rows, 2 * k + 2 : 2 * k + 4] = -np.eye(2)
            value[rows] = iterate(saddle.parameters, saddle.amplitude, points[k], 1)[1] - points[k + 1]
        return value, slope

    corrected = newton(system, path.ravel(), converged=CONVERGED, iterations=CORRECTIONS)
    return None if corrected is None else corrected.reshape(count, 2)


def carry_directions(matrices: list[np.ndarray], axes: np.ndarray) -> list[np.ndarray]:
    """Axes at all points of a path: the unstable direction is carried forwards, the stable direction backwards."""
    unstable, stable = [axes[:, 0]], [axes[:, 1]]
    for matrix in matrices[:-1]:
        ahead = linear_algebra.product(matrix, unstable[-1])
        unstable.append(ahead / linear_algebra.length(ahead))
    for matrix in matrices[-2::-1]:
        back = linear_algebra.solve(matrix, stable[-1])
        stable.append(back / linear_algebra.length(back))
    return [np.column_stack(pair) for pair in zip(unstable, reversed(stable), strict=True)]


def plan_sets(
    parameters: np.ndarray, fixed: np.ndarray, size: float, ratio: float, longest: int
) -> Iterator[tuple[np.ndarray, list[np.ndarray]]]:
    """Centres and axes of parallelograms around a fixed point and along an excursion from it, for each excursion.

    Refused if the point is no saddle, and after the longest excursion.

    Parameters
    ----------
    parameters : packed conveyor
    fixed : a saddle (δ, Y, â) of the map of one cycle
    size : largest half axis in the unstable direction
    ratio : of the half axes of the first set, unstable to stable
    longest : cycles of the longest excursion to search for

    Yields
    ------
    centres, axes : shape (n, 2), and n matrices of shape (2, 2); the first ones belong to the fixed point
    """
    saddle = find_saddle(parameters, fixed[2], fixed[:2])
    for path in find_excursions(saddle, longest):
        sets = sets_along(saddle, path, size, ratio)
        if sets is not None:
            yield sets


def sets_along(
    saddle: Saddle, path: np.ndarray, size: float, ratio: float
) -> tuple[np.ndarray, list[np.ndarray]] | None:
    """Centres and axes of the parallelograms along one excursion; arguments and results as in `plan_sets`.

    None if no orbit is found near the path.
    """
    out, back = project(saddle, path[[0, -1]])[[0, 1], [0, 1]]
    # Iterates along the straight directions extend the path until both ends lie within the first set.
    before, behind = [], []
    while abs(out) > BEGINNING * size:
        out /= saddle.multipliers[0]
        before.insert(0, saddle.point + out * saddle.axes[:, 0])
    size = abs(out) / BEGINNING
    while abs(back) > BEGINNING * size / ratio:
        back *= saddle.multipliers[1]
        behind.append(saddle.point + back * saddle.axes[:, 1])
    path = correct_path(saddle, np.array([*before, *path, *behind]))
    if path is None:
        return None
    axes = carry_directions([differentiate(saddle.parameters, saddle.amplitude, point) for point in path], saddle.axes)
    first = saddle.axes / np.array([1.0, BEGINNING * size / abs(back)])
    # Both ends of the excursion lie within the set of the fixed point and need no sets of their own.
    return np.vstack([saddle.point, path[1:-1]]), [size * part for part in (first, *axes[1:-1])]
