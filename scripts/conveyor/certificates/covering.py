"""Chaos: covering relations of the stroboscopic map on small parallelograms along a homoclinic orbit.

A parallelogram N = c + M [-1, 1]² has an unstable first axis x and a stable second one y. N covers N' under the map P,
written N ⇒ N', if in the coordinates of N' the image of N lies between the stable sides, |y| < 1, and the images of
the edges x = -1 and x = +1 of N lie beyond opposite unstable sides, one at x < -1, the other at x > 1. Then, for every
endless path N ⇒ N' ⇒ N'' ⇒ … of such relations, a point's iterates pass through these sets in this order, and for
every closed path a periodic one's (Zgliczyński and Gidea 2004).

If N0 covers itself and also, by N0 ⇒ N1 ⇒ … ⇒ Nm ⇒ N0, sets that are disjoint from it, every sequence of stays of one
cycle and excursions of m + 1 cycles is taken by an orbit: the topological entropy of P is at least log z per cycle with
z^(m+1) = z^m + 1. For of paths of n cycles from N0 to N0 there are as many as z^n grows.
"""

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from ..analysis.bifurcations.periodic_orbits import ReturnMap
from .balls import Refused, between, middle
from .law import Law
from .motion import Accuracy, follow
from .newton import exact

UNIT = arb(0, 1)
# Where excursions begin that are looked for, and how near to the fixed point they must return, in the scaled unknowns;
# how many are tried, and corrections of the one that is found.
LEAVING, RETURNED = 1e-4, 0.2
STARTS, CORRECTIONS = 1000, 6
# Where on the axes of the first set an excursion begins and, at most, ends.
BEGINNING = 0.6
BISECTIONS = 60


class Parallelogram(NamedTuple):
    """centre + axes [-1, 1]²: exact, shapes (2, 1) and (2, 2); the first column is the unstable axis."""

    centre: arb_mat
    axes: arb_mat


class Horseshoe(NamedTuple):
    """A proved set of covering relations."""

    sets: list[Parallelogram]  # N0 … Nm
    entropy: arb  # a lower bound, per excitation cycle


def carried(
    law: Law, accuracy: Accuracy, gamma: arb, nodes: int, centre: arb_mat, deviation: arb_mat
) -> tuple[arb_mat, arb_mat]:
    """Image of a centre after one cycle, and the derivative over centre + deviation.

    At each of the nodes the set is enclosed anew by the mean value theorem, image of the centre + derivative times
    deviation: a box that is carried through the whole cycle would grow by the contact's ringing.
    """
    turn = 2 * arb.pi() / nodes
    point, box, matrix = centre, centre + deviation, arb_mat([[1, 0], [0, 1]])
    for node in range(nodes):
        begin = law.phase + turn * node
        here = follow(law, accuracy, gamma, begin, begin + turn, *point.entries())
        wide = follow(law, accuracy, gamma, begin, begin + turn, *box.entries(), columns=2)
        matrix = wide.matrix * matrix
        point = arb_mat([[here.delta], [here.y]])
        mean = (point + matrix * deviation).entries()
        box = arb_mat([[a.intersection(b)] for a, b in zip((wide.delta, wide.y), mean, strict=True)])
    return point, matrix


def check_covering(image: tuple[arb_mat, arb_mat], source: Parallelogram, target: Parallelogram) -> None:
    """Prove that one parallelogram covers another.

    image : of the centre of `source`, and the derivative over all of it, as from `carried`

    Raises
    ------
    Refused
        says which side is missed
    """
    point, matrix = image
    centre = target.axes.inv() * (point - target.centre)
    # One matrix for both changes of coordinates: the image of a box would lose the directions.
    linear = target.axes.inv() * matrix * source.axes

    def of(x: arb) -> list[arb]:
        return (centre + linear * arb_mat([[x], [UNIT]])).entries()

    if not abs(of(UNIT)[1]) < 1:
        raise Refused("an image leaves between the stable sides of a set")
    left, right = of(arb(-1))[0], of(arb(1))[0]
    if not ((left < -1 and right > 1) or (left > 1 and right < -1)):
        raise Refused("an image does not reach beyond both unstable sides of a set")


def check_apart(one: Parallelogram, other: Parallelogram) -> None:
    """Prove that two parallelograms are disjoint.

    Raises
    ------
    Refused
        if they may have a point in common
    """
    inverse = one.axes.inv()
    seen = inverse * (other.centre - one.centre) + inverse * other.axes * arb_mat([[UNIT], [UNIT]])
    if all(value.overlaps(UNIT) for value in seen.entries()):
        raise Refused("two sets are not proved to be disjoint")


def entropy_of(excursion: int) -> arb:
    """A lower bound of log z, z > 1, with zⁿ = zⁿ⁻¹ + 1 for excursions of n cycles."""
    low, high = arb(1), arb(2)
    for _ in range(BISECTIONS):
        centre = middle(between(low, high))
        # zⁿ - zⁿ⁻¹ - 1 is -1 at z = 1 and rises from there.
        if centre**excursion - centre ** (excursion - 1) < 1:
            low = centre
        else:
            high = centre
    return low.log()


def plan(
    returns: ReturnMap, fixed: np.ndarray, size: float, ratio: float, longest: int
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Centres and axes of sets around a fixed point of the map and along an excursion from it; nothing is proved.

    Parameters
    ----------
    returns : the map of one cycle
    fixed : its fixed point (δ, Y, â), in the library's scaled unknowns, a saddle
    size, ratio : the largest half unstable axis, and that over half the stable axis of the first set
    longest : cycles of the longest excursion that is looked for, from near the fixed point on

    Returns
    -------
    centres, axes : shape (n, 2), and n matrices of shape (2, 2); the first ones are those of the fixed point

    Raises
    ------
    Refused
        if the point is no saddle, or no excursion is found
    """
    saddle = _Saddle(returns, fixed)
    path = saddle.homoclinic(longest)
    ratio_out, ratio_in = saddle.values
    ends = saddle.offsets(path[[0, -1]])
    before, behind = [], []
    while abs(ends[0, 0]) > BEGINNING * size:
        ends[0] /= ratio_out
        before.insert(0, fixed[:2] + ends[0, 0] * saddle.axes[:, 0])
    size = abs(ends[0, 0]) / BEGINNING
    while abs(ends[1, 1]) > BEGINNING * size / ratio:
        ends[1] *= ratio_in
        behind.append(fixed[:2] + ends[1, 1] * saddle.axes[:, 1])
    ratio = BEGINNING * size / abs(ends[1, 1])
    path = saddle.corrected(np.array([*before, *path, *behind]))
    matrices = [saddle.derivative(point) for point in path]
    unstable, stable = [saddle.axes[:, 0]], [saddle.axes[:, 1]]
    # Unstable directions are carried forwards, stable ones backwards.
    for matrix in matrices[:-1]:
        ahead = matrix @ unstable[-1]
        unstable.append(ahead / np.linalg.norm(ahead))
    for matrix in matrices[-2::-1]:
        back = np.linalg.solve(matrix, stable[-1])
        stable.append(back / np.linalg.norm(back))
    axes = [size * np.column_stack(pair) for pair in zip(unstable, reversed(stable), strict=True)]
    # The excursion begins and ends within the set of the fixed point.
    first = size * saddle.axes / np.array([1.0, ratio])
    return np.vstack([fixed[:2], path[1:-1]]), [first, *axes[1:-1]]


class _Saddle:
    """A saddle of the map of one cycle, in the library's scaled unknowns."""

    def __init__(self, returns: ReturnMap, fixed: np.ndarray):
        self.returns, self.fixed = returns, fixed
        values, vectors = np.linalg.eig(self.derivative(fixed[:2]))
        if np.iscomplexobj(values) or not np.abs(values).max() > 1.0 > np.abs(values).min():
            raise Refused("the fixed point is no saddle")
        order = np.argsort(-np.abs(values))
        self.values, self.axes = values[order], vectors[:, order]

    def derivative(self, point: np.ndarray) -> np.ndarray:
        return self.returns.residual(np.array([*point, self.fixed[2]]))[1] + np.eye(2)

    def followed(self, start: np.ndarray, cycles: int) -> np.ndarray:
        """The images of a point after 0 … cycles cycles, shape (cycles + 1, 2)."""
        several = ReturnMap(self.returns.parameters, cycles)
        return np.vstack([start, several.strobes(np.array([*start, self.fixed[2]]))[:, :2]])

    def offsets(self, points: np.ndarray) -> np.ndarray:
        """Coordinates of points along the unstable and the stable direction, shape (n, 2)."""
        return np.linalg.solve(self.axes, (points - self.fixed[:2]).T).T

    def homoclinic(self, longest: int) -> np.ndarray:
        """The shortest excursion that leaves along the unstable direction and returns along the stable one."""

        def from_start(start: float) -> np.ndarray:
            return self.followed(self.fixed[:2] + start * self.axes[:, 0], longest)

        starts = LEAVING * np.geomspace(1.0 / abs(self.values[0]), 1.0, STARTS)
        for sign in (1.0, -1.0):
            ends = np.array([self.offsets(from_start(sign * start)) for start in starts])
            for cycles in range(2, longest + 1):
                across = ends[:, cycles, 0]
                for k in np.flatnonzero(across[1:] * across[:-1] < 0.0):
                    low, high = sign * starts[k], sign * starts[k + 1]
                    for _ in range(BISECTIONS):
                        centre = 0.5 * (low + high)
                        same = self.offsets(from_start(centre))[cycles, 0] * across[k] > 0.0
                        low, high = (centre, high) if same else (low, centre)
                    path = from_start(low)[: cycles + 1]
                    if np.abs(self.offsets(path[-1:])).max() < RETURNED:
                        return path
        raise Refused(f"no excursion of up to {longest} cycles returns to the fixed point")

    def corrected(self, path: np.ndarray) -> np.ndarray:
        """An orbit that leaves and returns along the straight directions, by Newton's iteration on all its points."""
        count = len(path)
        for _ in range(CORRECTIONS):
            slope, value = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
            across = np.linalg.inv(self.axes)
            slope[0, :2], value[0] = across[1], self.offsets(path[:1])[0, 1]
            slope[-1, -2:], value[-1] = across[0], self.offsets(path[-1:])[0, 0]
            for k in range(count - 1):
                rows = slice(2 * k + 1, 2 * k + 3)
                slope[rows, 2 * k : 2 * k + 2] = self.derivative(path[k])
                slope[rows, 2 * k + 2 : 2 * k + 4] = -np.eye(2)
                value[rows] = self.followed(path[k], 1)[1] - path[k + 1]
            path = path - np.linalg.solve(slope, value).reshape(count, 2)
        return path


def prove_horseshoe(
    law: Law, accuracy: Accuracy, gamma: arb, nodes: int, points: np.ndarray, axes: list[np.ndarray]
) -> Horseshoe:
    """N0 ⇒ N0 and N0 ⇒ N1 ⇒ … ⇒ Nm ⇒ N0 with N1 … Nm disjoint from N0.

    points, axes : centres and axes of N0 … Nm in units of the law, as from `plan`

    Raises
    ------
    Refused
        with the reason
    """
    sets = [Parallelogram(exact(point[:, None]), exact(frame)) for point, frame in zip(points, axes, strict=True)]
    for part in sets[1:]:
        check_apart(sets[0], part)
    for k, part in enumerate(sets):
        image = carried(law, accuracy, gamma, nodes, part.centre, part.axes * arb_mat([[UNIT], [UNIT]]))
        if k == 0:
            check_covering(image, part, part)
        check_covering(image, part, sets[(k + 1) % len(sets)])
    return Horseshoe(sets, entropy_of(len(sets)))
