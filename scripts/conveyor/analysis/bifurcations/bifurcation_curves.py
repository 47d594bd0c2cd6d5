"""Folds and period doublings followed in two parameters: Γ and one that moves D and K along a power law.

The curve of a bifurcation is followed by pseudo-arclength (Keller 1977) in (x, y, log Γ, λ), where the parameter is
e^λ times its first value. On it lie points of codimension two:

cusp
    on a fold, where l·D²Pⁿ(r, r) = 0: two folds meet
generalised doubling
    on a doubling, where the coefficient of its normal form is 0: the doubled orbit's branch turns from one side to the
    other, and the curve of its folds begins there
grazing
    where an impact of the orbit begins or ceases to exist

l and r are the left and right eigenvectors of the multiplier. The product of the multipliers is below 1, where there is
damping, and positive: no orbit has two multipliers +1, two -1, or one of each, and there are no other generic ones.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from scipy.optimize import root

from ..dimensionless_groups import Groups
from .bifurcation_points import GRAZING, SIGNS, Point, derivatives, find_bifurcation, system, touch
from .newton import follow_curve, newton, solve

CONVERGED, ITERATIONS = 1e-10, 12
FARTHEST = 1.0  # distance over which a correction may move a point
RESOLUTION = 1e-8  # of a point of codimension two along its curve
FIRST_STEP, SMALLEST_STEP = 1e-2, 1e-6
STRAIGHT = 0.9  # cosine of the largest turn within one step
MOST_EVALUATIONS = 60  # of the functions of a grazing in the search for it
TOUCHES = 1e-8  # of the functions of a grazing
NEARBY = 1e-2  # a grazing within this distance of the end of a curve, in log Γ and λ, is the one that ends it
SMALL = 1e-3  # of its neighbours' tests: that of a cusp or generalised doubling
SIDESTEP = 1e-4  # of the differences of second derivatives along r

# Why a curve ends.
LIMIT, STEP, LENGTH, CLOSED, LOST, HALVED = "limit", "step", "length", "closed", "lost", "period halving"


class Path(NamedTuple):
    """How a parameter moves the groups: D ∝ e^(damping λ), K ∝ e^(stiffness λ)."""

    damping: float
    stiffness: float


class CodimensionTwoPoint(NamedTuple):
    """A point of codimension two on a curve."""

    kind: str  # cusp, generalised doubling or grazing
    point: Point
    part: float  # λ
    status: str  # ok, or why the point is only a neighbour of it


class Curve(NamedTuple):
    """A curve of one bifurcation in the order of its arclength, its points of codimension two, and why it ends."""

    points: list[Point]
    parts: np.ndarray  # λ of each point
    normal_forms: np.ndarray  # of each point: the test of cusps and of generalised doublings
    impacts: np.ndarray  # of each point, per period
    meetings: list[CodimensionTwoPoint]
    ends: tuple[str, str]


class Following:
    """A kind of bifurcation of one period on a path through the groups: unknowns u = (x, y, log Γ, λ)."""

    def __init__(self, point: Point, path: Path):
        self.kind, self.period, self.origin, self.path = point.kind, point.period, point.groups, path

    def groups(self, unknown: np.ndarray) -> Groups:
        """The groups at unknowns."""
        return self.origin._replace(
            amplitude=float(np.exp(unknown[2])),
            damping=float(self.origin.damping * np.exp(self.path.damping * unknown[3])),
            stiffness=float(self.origin.stiffness * np.exp(self.path.stiffness * unknown[3])),
        )

    def point(self, unknown: np.ndarray) -> Point:
        """The bifurcation at unknowns."""
        groups = self.groups(unknown)
        return Point(self.kind, self.period, np.append(unknown[:2], groups.amplitude), groups)

    def system(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """The three functions and their derivatives by the unknowns, shape (3, 4)."""
        groups = self.groups(unknown)
        found = system(self.kind, self.period, np.append(unknown[:2], groups.amplitude), groups)
        if found is None:
            return None
        by_path = (
            found[1][:, 3] * self.path.damping * groups.damping
            + found[1][:, 4] * self.path.stiffness * groups.stiffness
        )
        jacobian = np.column_stack([found[1][:, :2], found[1][:, 2] * groups.amplitude, by_path])
        # Only the function of the multipliers grows with them.
        scale = np.append(np.ones(2), max(1.0, np.linalg.norm(jacobian[2])))
        return found[0] / scale, jacobian / scale[:, None]

    def tangent(self, unknown: np.ndarray, previous: np.ndarray) -> np.ndarray | None:
        """Unit vector along the curve, pointing on from `previous`; None where the motion is lost."""
        found = self.system(unknown)
        if found is None or not np.isfinite(found[1]).all():
            return None
        vector = np.linalg.svd(found[1])[2][-1]
        return vector if vector @ previous >= 0.0 else -vector

    def correct(self, guess: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """The point of the curve in the plane through `guess` normal to `direction`, or None."""

        def step_at(unknown):
            found = self.system(unknown)
            if found is None:
                return None
            return solve(np.vstack([found[1], direction]), -np.append(found[0], direction @ (unknown - guess)))

        return newton(step_at, guess, converged=CONVERGED, iterations=ITERATIONS, farthest=FARTHEST)

    def halving(self, unknown: np.ndarray) -> np.ndarray:
        """(x, y) half a period later, less (x, y): it passes zero where the orbit's period halves."""
        found = derivatives(self.groups(unknown), unknown[:2], self.period)
        return found.states[self.period // 2 - 1] - unknown[:2]


def eigenvectors(matrix: np.ndarray, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Right and left eigenvectors of the multiplier ±1, r of length 1 and l·r = 1."""
    singular = matrix - sign * np.eye(2)
    right = np.linalg.svd(singular)[2][-1]
    left = np.linalg.svd(singular.T)[2][-1]
    return right, left / (left @ right)


def normal_form(point: Point, along: np.ndarray) -> tuple[float, np.ndarray]:
    """The coefficient whose zero is a cusp or a generalised doubling (Kuznetsov 2004, Sect. 5.4).

    For a fold it is l·D²Pⁿ(r, r)/2, with the sign of r along `along`. For a doubling it is the cubic coefficient, which
    is positive in the supercritical case: the doubled orbit is then stable if the single orbit was.

    Returns
    -------
    coefficient, r
    """
    state = point.unknown[:2]
    found = derivatives(point.groups, state, point.period)
    matrix = found.first[:, :2]
    right, left = eigenvectors(matrix, SIGNS[point.kind])
    if right @ along < 0.0:
        right, left = -right, -left
    bent = found.second[:, :, :2] @ right @ right
    if point.kind == "fold":
        return float(0.5 * left @ bent), right
    aside = [derivatives(point.groups, state + part * SIDESTEP * right, point.period) for part in (1.0, -1.0)]
    if any(one is None for one in aside):
        return float("nan"), right
    third = (aside[0].second - aside[1].second)[:, :, :2] @ right @ right / (2.0 * SIDESTEP)
    follow = np.linalg.solve(np.eye(2) - matrix, bent)
    return float(left @ (third / 6.0 + 0.5 * found.second[:, :, :2] @ follow @ right)), right


def impacts_of(point: Point) -> int:
    """Impacts of the orbit per period."""
    return derivatives(point.groups, point.unknown[:2], point.period).impacts


def follow(
    point: Point,
    path: Path,
    amplitude: tuple[float, float],
    reach: tuple[float, float],
    *,
    longest_step: float,
    most: int,
) -> Curve:
    """Follow the curve of a bifurcation to both sides.

    Parameters
    ----------
    point : a fold or a period doubling, at λ = 0
    path : of the groups
    amplitude : lowest and highest Γ
    reach : lowest and highest λ
    longest_step : largest arclength of a step, in (x, y, log Γ, λ)
    most : points of a side after which it ends with "length"
    """
    following = Following(point, path)
    begin = np.append(point.unknown[:2], [np.log(point.groups.amplitude), 0.0])
    limits = (*np.log(amplitude), *reach)
    onwards, last = _side(following, begin, np.array([0.0, 0.0, 0.0, 1.0]), limits, longest_step, most)
    before, first = [], last
    if last != CLOSED:
        before, first = _side(following, begin, np.array([0.0, 0.0, 0.0, -1.0]), limits, longest_step, most)
    unknowns = [*before[:0:-1], *onwards]
    points = [following.point(unknown) for unknown in unknowns]
    forms, rights = [], [np.array([1.0, 0.0])]
    for one in points:
        form, right = normal_form(one, rights[-1])
        forms.append(form)
        rights.append(right)
    impacts = np.array([impacts_of(one) for one in points])
    meetings = list(_meetings(following, unknowns, forms, rights[1:], impacts, (first, last)))
    return Curve(
        points, np.array([unknown[3] for unknown in unknowns]), np.array(forms), impacts, meetings, (first, last)
    )


def follow_grazing(
    point: Point, path: Path, amplitude: tuple[float, float], reach: tuple[float, float], *, step: float
) -> Curve:
    """Follow the amplitude at which an orbit touches the plate (a grazing) to both sides, in equal steps of λ.

    It ends where Newton's iteration finds no touch near the last one ("lost"). The other parameters are those of
    `follow`; such a curve has no points of codimension two of its own.
    """
    found, ends = [], []
    for direction, end in ((-1.0, reach[0]), (1.0, reach[1])):
        here, part, side, reason = point, 0.0, [], LIMIT
        while abs(part) < abs(end):
            part = direction * min(abs(part) + step, abs(end))
            groups = Following(point, path).groups(np.append(np.zeros(2), [np.log(here.groups.amplitude), part]))
            there = find_bifurcation(GRAZING, point.period, here.unknown, groups)
            if there is None or np.abs(there.unknown - here.unknown).max() > 3.0 * step:
                reason = LOST
                break
            here = there
            side.append((here, part))
            if not amplitude[0] <= here.groups.amplitude <= amplitude[1]:
                break
        found = [*side[::-1], (point, 0.0)] if direction < 0.0 else [*found, *side]
        ends.append(reason)
    points, parts = [one for one, _ in found], np.array([part for _, part in found])
    impacts = np.zeros(len(points), dtype=np.int64)
    return Curve(points, parts, np.full(len(points), np.nan), impacts, [], tuple(ends))


def _side(following, begin, direction, limits, longest_step, most):
    """Unknowns in the order in which they are met, and the reason of the end."""
    unknowns = [begin]
    lengths = {"first": min(FIRST_STEP, longest_step), "smallest": SMALLEST_STEP, "largest": longest_step}
    steps = follow_curve(following.correct, following.tangent, begin, direction, **lengths, straight=STRAIGHT)
    for here, there, _, onwards, length in steps:
        if following.period % 2 == 0 and following.halving(here) @ following.halving(there) < 0.0:
            return unknowns, HALVED
        unknowns.append(there)
        if not (limits[0] <= there[2] <= limits[1] and limits[2] <= there[3] <= limits[3]):
            return unknowns, LIMIT
        if len(unknowns) > 3 and np.linalg.norm(there - begin) < length and onwards @ (begin - there) > 0.0:
            return [*unknowns, begin], CLOSED
        if len(unknowns) > most:
            return unknowns, LENGTH
    return unknowns, LOST if following.tangent(begin, direction) is None else STEP


def _meetings(following, unknowns, forms, rights, impacts, ends) -> Iterable[CodimensionTwoPoint]:
    """Points of codimension two on a curve, and grazings at its ends."""
    if ends[0] == STEP:
        yield from _grazings(following, *unknowns[1::-1], "the curve ends here")
    for n in range(len(unknowns) - 1):
        begin, end = unknowns[n], unknowns[n + 1]
        if impacts[n] != impacts[n + 1]:
            found = list(_grazings(following, begin, end, "ok"))
            yield from found or [CodimensionTwoPoint(GRAZING, following.point(end), float(end[3]), "not located")]
        if np.sign(forms[n]) * np.sign(forms[n + 1]) < 0.0:
            yield _degenerate(following, begin, end, lambda one, along=rights[n]: normal_form(one, along)[0])
    if ends[1] == STEP:
        yield from _grazings(following, *unknowns[-2:], "the curve ends here")


def _degenerate(following, begin, end, test):
    """A cusp or a generalised doubling: where a test of the points between two unknowns is zero, by bisection."""
    kind = "cusp" if following.kind == "fold" else "generalised doubling"
    first, last = test(following.point(begin)), test(following.point(end))
    largest, status = max(abs(first), abs(last)), "ok"
    while status == "ok" and np.linalg.norm(end - begin) > RESOLUTION:
        chord = end - begin
        middle = following.correct(0.5 * (begin + end), chord / np.linalg.norm(chord))
        if middle is None:
            status = "not located"
            break
        value = test(following.point(middle))
        if value * first > 0.0:
            begin, first = middle, value
        else:
            end, last = middle, value
    if status == "ok" and max(abs(first), abs(last)) > SMALL * largest:
        status = "changes sign by a jump"  # at a grazing
    return CodimensionTwoPoint(kind, following.point(end), float(end[3]), status)


def _grazings(following, begin, end, status):
    """The orbit between two unknowns, or a little beyond the second one, that touches the plate with no speed, if any.

    The functions of the bifurcation have no second derivatives close to it. The grazing therefore is a zero of other
    functions, of the phase ψ of the touch, log Γ and λ.
    """

    def functions(guess):
        groups = following.groups(np.append(np.zeros(2), guess[1:]))
        found = derivatives(groups, np.zeros(2), following.period, guess[0])
        if found is None:
            return np.full(3, np.nan)
        matrix, sign = found.first[:, :2], SIGNS[following.kind]
        return np.append(found.image, 1.0 - sign * np.trace(matrix) + np.linalg.det(matrix))

    for near in (end, begin):
        phase = touch(following.groups(near), near[:2], following.period)
        if phase is None:
            continue
        solution = root(functions, np.append(phase[0], near[2:]), tol=CONVERGED, options={"maxfev": MOST_EVALUATIONS})
        if np.abs(solution.fun).max() < TOUCHES and np.abs(solution.x[1:] - near[2:]).max() < 2.0 * max(
            np.abs(end - begin).max(), NEARBY
        ):
            groups = following.groups(np.append(np.zeros(2), solution.x[1:]))
            point = Point(GRAZING, following.period, np.array([solution.x[0], groups.amplitude]), groups)
            yield CodimensionTwoPoint(GRAZING, point, float(solution.x[2]), status)
            return
