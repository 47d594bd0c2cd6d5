"""Chaos: covering relations of the stroboscopic map on small parallelograms along a homoclinic orbit.

The first axis x of a parallelogram N = c + M [-1, 1]² is unstable, the second axis y is stable. N covers N' under the
map P, written N ⇒ N', if two conditions hold in the coordinates of N':

- the image of N lies between the stable sides, |y| < 1;
- the images of the edges x = -1 and x = +1 of N lie beyond opposite unstable sides, one at x < -1, the other at x > 1.

For every infinite path N ⇒ N' ⇒ N'' ⇒ … there is then a point whose iterates pass through these sets in this order. If
the path is closed, there is such a point that is periodic (Zgliczyński and Gidea 2004).

Let N0 cover itself, and let N0 ⇒ N1 ⇒ … ⇒ Nm ⇒ N0 with N1 … Nm disjoint from N0. Then for every sequence of stays (one
cycle) and excursions (m + 1 cycles) there is an orbit that follows it. The number of paths of n cycles from N0 to N0
grows as zⁿ with z^(m+1) = z^m + 1, so that the topological entropy of P is at least log z per cycle.
"""

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from .balls import Refused
from .law import System
from .newton import exact
from .shooting import NODES, follow_to_next_node

UNIT = arb(0, 1)
BISECTIONS = 60


class Parallelogram(NamedTuple):
    """centre + axes [-1, 1]²: exact, shapes (2, 1) and (2, 2); the first column is the unstable axis."""

    centre: arb_mat
    axes: arb_mat


class Horseshoe(NamedTuple):
    """A proved set of covering relations."""

    sets: list[Parallelogram]  # N0 … Nm
    entropy: arb  # a lower bound, per excitation cycle


def carry_set(system: System, centre: arb_mat, deviation: arb_mat) -> tuple[arb_mat, arb_mat]:
    """Image of a centre after one cycle, and the derivative over centre + deviation.

    At each node the mean value theorem gives a new enclosure of the set: image of the centre + derivative × deviation.
    A box that is carried through the whole cycle would grow with each oscillation of the contact.
    """
    point, box, matrix = centre, centre + deviation, arb_mat([[1, 0], [0, 1]])
    for node in range(NODES):
        image = follow_to_next_node(system, node, *point.entries(), columns=0)
        wide = follow_to_next_node(system, node, *box.entries(), columns=2)
        matrix = wide.matrix * matrix
        point = arb_mat([[image.delta], [image.y]])
        mean = (point + matrix * deviation).entries()
        box = arb_mat([[a.intersection(b)] for a, b in zip((wide.delta, wide.y), mean, strict=True)])
    return point, matrix


def check_covering(image: tuple[arb_mat, arb_mat], source: Parallelogram, target: Parallelogram) -> None:
    """Prove that one parallelogram covers another.

    Refused, with the side that is missed, if the proof fails.

    image : of the centre of `source`, and the derivative over all of it, as from `carry_set`
    """
    point, matrix = image
    centre = target.axes.inv() * (point - target.centre)
    # The product of all three matrices keeps the directions, which a box in the original coordinates would lose.
    linear = target.axes.inv() * matrix * source.axes

    def image_of_edge(x: arb) -> list[arb]:
        return (centre + linear * arb_mat([[x], [UNIT]])).entries()

    if not abs(image_of_edge(UNIT)[1]) < 1:
        raise Refused("an image leaves between the stable sides of a set")
    left, right = image_of_edge(arb(-1))[0], image_of_edge(arb(1))[0]
    if not ((left < -1 and right > 1) or (left > 1 and right < -1)):
        raise Refused("an image does not reach beyond both unstable sides of a set")


def check_apart(one: Parallelogram, other: Parallelogram) -> None:
    """Prove that two parallelograms are disjoint.

    Refused if they may have a point in common.
    """
    inverse = one.axes.inv()
    seen = inverse * (other.centre - one.centre) + inverse * other.axes * arb_mat([[UNIT], [UNIT]])
    if all(value.overlaps(UNIT) for value in seen.entries()):
        raise Refused("two sets are not proved to be disjoint")


def bound_entropy(excursion: int) -> arb:
    """A lower bound of log z, z > 1, with zⁿ = zⁿ⁻¹ + 1 for excursions of n cycles."""
    low, high = arb(1), arb(2)
    for _ in range(BISECTIONS):
        centre = low.union(high).mid()
        # zⁿ - zⁿ⁻¹ - 1 is -1 at z = 1 and rises from there.
        if centre**excursion - centre ** (excursion - 1) < 1:
            low = centre
        else:
            high = centre
    return low.log()


def prove_horseshoe(system: System, points: np.ndarray, axes: list[np.ndarray]) -> Horseshoe:
    """N0 ⇒ N0 and N0 ⇒ N1 ⇒ … ⇒ Nm ⇒ N0 with N1 … Nm disjoint from N0.

    Parameters
    ----------
    system : the motion at an amplitude, and the accuracy of its steps
    points, axes : centres and axes of N0 … Nm in units of the law, one of `excursion.plan_sets`
    """
    sets = [Parallelogram(exact(point[:, None]), exact(frame)) for point, frame in zip(points, axes, strict=True)]
    for part in sets[1:]:
        check_apart(sets[0], part)
    for k, part in enumerate(sets):
        image = carry_set(system, part.centre, part.axes * arb_mat([[UNIT], [UNIT]]))
        if k == 0:
            check_covering(image, part, part)
        check_covering(image, part, sets[(k + 1) % len(sets)])
    return Horseshoe(sets, bound_entropy(len(sets)))
