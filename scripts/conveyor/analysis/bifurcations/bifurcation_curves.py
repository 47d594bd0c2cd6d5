"""Curves of folds and period doublings in two parameters: Γ, and a parameter that moves D and K along a power law.

Pseudo-arclength continuation (Keller 1977) follows the curve of a bifurcation in (x, y, log Γ, λ), where the second
parameter is e^λ times its first value. Points of codimension two on such a curve are:

cusp
    on a curve of folds, where l·D²Pⁿ(r, r) = 0 and two folds meet
generalised doubling
    on a curve of period doublings, where the coefficient of the normal form is 0. The branch of the doubled orbit
    changes its direction there, and a curve of folds of that orbit begins
grazing
    where an impact of the orbit begins or ceases to exist

l and r are the left and right eigenvectors of the multiplier. With damping, the product of the multipliers is positive
and below 1. No orbit therefore has two multipliers +1, two -1, or one of each, and other points of codimension two are
not generic.
"""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from ... import linear_algebra
from ...arguments import check_choice, check_limits, check_type
from ...columns import Columns
from ...packing import replace_parameters
from ...progress import progress_bar
from .. import stroboscopic_map
from ..dimensionless_groups import Groups, amplitude_of, length_and_speed_units
from .bifurcation_points import (
    GRAZING,
    SIGNS,
    BifurcationPoint,
    bifurcation_near,
    conditions,
    find_bifurcation,
    find_touch,
    linearise,
    multiplier_test,
    touching_point,
)
from .continuation import Bifurcation
from .newton import difference_quotients, follow_curve, newton
from .periodic_orbits import Orbit

CONVERGED, ITERATIONS = 1e-10, 12  # last correction of Newton's iteration, and number of corrections
FARTHEST = 1.0  # distance over which a correction may move a point
RESOLUTION = 1e-8  # of a point of codimension two along its curve
FIRST_STEP, SMALLEST_STEP = 1e-2, 1e-6  # arclengths
STRAIGHT = 0.9  # cosine of the largest turn within one step
NEARBY = 1e-2  # a grazing within this distance of the end of a curve, in log Γ and λ, ends the curve
SMALL = 1e-3  # ratio of the test at a cusp or generalised doubling to the tests at the neighbouring points
# Step of difference quotients in the unknowns; small, because curves reach conveyors whose map bends strongly.
DIFFERENCE = 3e-8
BENDING = 3e-7  # of the difference quotient of M, in (x, y)
SIDESTEP = 1e-4  # of the second difference of M along r, in (x, y), where the map bends as much as its unit


class ParameterPath(NamedTuple):
    """How the second parameter moves the groups: D ∝ e^(damping λ), K ∝ e^(stiffness λ)."""

    damping: float
    stiffness: float


# How parameters move the groups, for an exponent p of the contact. The angle moves Γ alone.
PATHS = {
    "angle": lambda p: ParameterPath(0.0, 0.0),
    "damping": lambda p: ParameterPath(1.0, 0.0),
    "frequency": lambda p: ParameterPath(-1.0, -2.0 * p),
    "gravity": lambda p: ParameterPath(0.0, p - 1.0),
    "mass": lambda p: ParameterPath(-1.0, -1.0),
    "stiffness": lambda p: ParameterPath(0.0, 1.0),
}
# Of `continue_bifurcation`: the largest factor on Γ, arclength of the longest step, and points on each side.
FACTOR, LONGEST_STEP, MOST_POINTS = 10.0, 0.1, 1000


class CodimensionTwoPoint(NamedTuple):
    """A point of codimension two on a curve."""

    kind: str  # cusp, generalised doubling or grazing
    point: BifurcationPoint
    log_ratio: float  # λ
    status: str  # ok, or why this is only a point near it


class BifurcationCurve(NamedTuple):
    """A curve of one bifurcation in the order of its arclength, its points of codimension two, and why it ends."""

    points: list[BifurcationPoint]
    log_ratios: np.ndarray  # λ of each point, shape (n,)
    normal_forms: np.ndarray  # coefficient at each point, whose zero is a cusp or a generalised doubling, shape (n,)
    meetings: list[CodimensionTwoPoint]
    # At the first and last point: limit, step (none is small enough), length, closed, lost, period halving.
    ends: tuple[str, str]


class CurveEquations:
    """The equations of a curve of one kind of bifurcation and one period; the unknowns are (x, y, log Γ, λ)."""

    def __init__(self, point: BifurcationPoint, path: ParameterPath):
        self.kind, self.period, self.origin, self.path = point.kind, point.period, point.groups, path

    def groups(self, unknown: np.ndarray) -> Groups:
        """The groups at unknowns."""
        return self.origin._replace(
            amplitude=float(np.exp(unknown[2])),
            damping=float(self.origin.damping * np.exp(self.path.damping * unknown[3])),
            stiffness=float(self.origin.stiffness * np.exp(self.path.stiffness * unknown[3])),
        )

    def point(self, unknown: np.ndarray) -> BifurcationPoint:
        """The bifurcation at unknowns."""
        groups = self.groups(unknown)
        return BifurcationPoint(self.kind, self.period, np.append(unknown[:2], groups.amplitude), groups)

    def conditions(self, unknown: np.ndarray) -> np.ndarray:
        """The three functions, NaN where the motion is lost."""
        groups = self.groups(unknown)
        return conditions(self.kind, self.period, np.append(unknown[:2], groups.amplitude), groups)

    def system(self, unknown: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
        """The three functions and their derivatives by the unknowns, shape (3, 4)."""
        value = self.conditions(unknown)
        if not np.isfinite(value).all():
            return None
        jacobian = difference_quotients(self.conditions, unknown, DIFFERENCE)
        # The third function, alone, grows with the multipliers.
        scale = np.append(np.ones(2), max(1.0, linear_algebra.length(jacobian[2])))
        return value / scale, jacobian / scale[:, None]

    def tangent(self, unknown: np.ndarray, previous: np.ndarray) -> np.ndarray | None:
        """Unit vector along the curve, at an acute angle to `previous`; None where the motion is lost."""
        evaluated = self.system(unknown)
        if evaluated is None or not np.isfinite(evaluated[1]).all():
            return None
        return linear_algebra.null_vector(evaluated[1], previous)

    def correct(self, guess: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """The point of the curve in the plane through `guess` normal to `direction`, or None."""
        return newton(self.system, guess, direction, converged=CONVERGED, iterations=ITERATIONS, farthest=FARTHEST)

    def halving(self, unknown: np.ndarray) -> np.ndarray:
        """(x, y) half a period later minus (x, y); the difference passes zero where the orbit's period halves."""
        return linearise(self.groups(unknown), unknown[:2], self.period // 2).image - unknown[:2]


def eigenvectors(matrix: np.ndarray, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Right and left eigenvectors of the multiplier ±1, r of length 1 and l·r = 1."""
    right = linear_algebra.eigenvector(matrix, sign)
    left = linear_algebra.eigenvector(matrix.T, sign)
    return right, left / linear_algebra.dot(left, right)


def normal_form(point: BifurcationPoint, along: np.ndarray) -> tuple[float, np.ndarray]:
    """The coefficient whose zero is a cusp or a generalised doubling (Kuznetsov 2004, Sect. 5.4), and r.

    For a fold it is l·D²Pⁿ(r, r)/2, with the sign of r chosen so that r·`along` ≥ 0. For a doubling it is the cubic
    coefficient, which is positive in the supercritical case: the doubled orbit is then stable if the single orbit was.
    """
    state = point.unknown[:2]
    matrix = linearise(point.groups, state, point.period).matrix
    right, left = eigenvectors(matrix, SIGNS[point.kind])
    if linear_algebra.dot(right, along) < 0.0:
        right, left = -right, -left

    def change(step):
        """The change of M r at the state a step aside, shape (2,)."""
        aside = linearise(point.groups, state + step, point.period)
        return np.full(2, np.nan) if aside is None else linear_algebra.product(aside.matrix - matrix, right)

    def bend(direction):
        """Second derivatives of (x, y) along r and a direction, shape (2,)."""
        part = BENDING / linear_algebra.length(direction)
        return (change(part * direction) - change(-part * direction)) / (2.0 * part)

    bent = bend(right)
    if point.kind == "fold":
        return float(0.5 * linear_algebra.dot(left, bent)), right
    sidestep = SIDESTEP / max(1.0, linear_algebra.length(bent))
    third = (change(sidestep * right) + change(-sidestep * right)) / sidestep**2
    following = linear_algebra.solve(np.eye(2) - matrix, bent)
    return float(linear_algebra.dot(left, third / 6.0 + 0.5 * bend(following))), right


def follow_bifurcation_curve(
    point: BifurcationPoint,
    path: ParameterPath,
    amplitude: tuple[float, float],
    reach: tuple[float, float],
    *,
    longest_step: float,
    max_points: int,
    progress: str | None = None,
) -> BifurcationCurve:
    """Follow the curve of a bifurcation in both directions.

    Parameters
    ----------
    point : a fold or a period doubling, at λ = 0
    path : of the groups
    amplitude : lowest and highest Γ
    reach : lowest and highest λ
    longest_step : largest arclength of a step, in (x, y, log Γ, λ)
    max_points : in one direction after which the curve ends with "length"
    progress : as in `continue_bifurcation`

    Examples
    --------
    >>> fold = find_bifurcation("fold", 1, np.array([-3.41, 1.61, 0.508]), groups_of(parameter_table(Conveyor())))
    >>> path = ParameterPath(damping=1.0, stiffness=0.0)
    >>> curve = follow_bifurcation_curve(fold, path, (0.1, 5.0), (-0.5, 0.5), longest_step=0.1, max_points=100)
    >>> curve.ends, round(curve.points[0].groups.amplitude, 2)  # Γ at the least damping
    (('limit', 'limit'), 0.29)
    """
    equations = CurveEquations(point, path)
    begin = np.append(point.unknown[:2], [np.log(point.groups.amplitude), 0.0])
    limits = (*np.log(amplitude), *reach)
    upwards, before = np.array([0.0, 0.0, 0.0, 1.0]), []
    with progress_bar(label=progress, unit="points") as shown:
        after, last = _side(equations, begin, upwards, limits, longest_step, max_points, shown)
        first = last
        if last != "closed":
            before, first = _side(equations, begin, -upwards, limits, longest_step, max_points, shown)
    unknowns = [*before[:0:-1], *after]
    points = [equations.point(unknown) for unknown in unknowns]
    forms, rights = [], [np.array([1.0, 0.0])]
    for point in points:
        form, right = normal_form(point, rights[-1])
        forms.append(form)
        rights.append(right)
    impacts = [linearise(point.groups, point.unknown[:2], point.period).impacts for point in points]
    meetings = list(_meetings(equations, unknowns, forms, rights[1:], impacts, (first, last)))
    log_ratios = np.array([unknown[3] for unknown in unknowns])
    return BifurcationCurve(points, log_ratios, np.array(forms), meetings, (first, last))


def follow_grazing_curve(
    point: BifurcationPoint,
    path: ParameterPath,
    amplitude: tuple[float, float],
    reach: tuple[float, float],
    *,
    step: float,
    progress: str | None = None,
) -> BifurcationCurve:
    """Follow the amplitude at which an orbit touches the plate (a grazing) in both directions, in equal steps of λ.

    The curve ends with "lost" where no touch is found near the last one. Points of codimension two are not searched
    for.

    Parameters
    ----------
    point : a grazing, at λ = 0
    path, amplitude, reach, progress : as in `follow_bifurcation_curve`
    step : in λ

    Examples
    --------
    >>> groups = groups_of(parameter_table(Conveyor()))
    >>> grazing = find_bifurcation("grazing", 1, np.array([3.480, 0.9686]), groups)
    >>> path = ParameterPath(damping=1.0, stiffness=0.0)
    >>> curve = follow_grazing_curve(grazing, path, (0.1, 5.0), (-0.5, 0.5), step=0.1)
    >>> curve.ends, len(curve.points)
    (('limit', 'limit'), 11)
    """
    path_points, ends, equations = [(point, 0.0)], [], CurveEquations(point, path)
    with progress_bar(label=progress, unit="points") as shown:
        for direction, end in ((-1.0, reach[0]), (1.0, reach[1])):
            current, log_ratio, reason = point, 0.0, "limit"
            while abs(log_ratio) < abs(end) and amplitude[0] <= current.groups.amplitude <= amplitude[1]:
                log_ratio = direction * min(abs(log_ratio) + step, abs(end))
                groups = equations.groups(np.append(np.zeros(2), [np.log(current.groups.amplitude), log_ratio]))
                next_grazing = find_bifurcation(GRAZING, point.period, current.unknown, groups)
                if next_grazing is None or np.abs(next_grazing.unknown - current.unknown).max() > 3.0 * step:
                    reason = "lost"
                    break
                current = next_grazing
                path_points.append((current, log_ratio))
                shown.update()
            ends.append(reason)
    path_points.sort(key=lambda grazing: grazing[1])
    points, log_ratios = [grazing for grazing, _ in path_points], np.array([log_ratio for _, log_ratio in path_points])
    return BifurcationCurve(points, log_ratios, np.full(len(points), np.nan), [], tuple(ends))


def continue_bifurcation(
    bifurcation: Bifurcation, parameter: str, limits: Sequence[float], *, progress: str | None = None
) -> Columns:
    """The curve of a bifurcation over the amplitude and a second parameter, with its points of codimension two.

    Parameters
    ----------
    bifurcation : of a branch from `continue_orbit`; the plate has no harmonics
    parameter : angle, damping, frequency, gravity, mass or stiffness
    limits : lowest and highest value of the parameter in SI units, on either side of the bifurcation's value
    progress : as in `sweep`; the bar counts points, whose number is not known before

    Returns
    -------
    columns of the shape (n,): kind, that of the bifurcation for the points of the curve in order, and behind them cusp,
    generalised doubling or grazing; period (excitation cycles); acceleration (m/s²) and the parameter (SI units); delta
    (m) and v (m/s), the state at phase 0, NaN for a grazing; normal_form, which is zero at a cusp and at a generalised
    doubling; status, "ok", or at the ends of the curve the reason: limit (also of FACTOR times the amplitude), length,
    closed, lost, period halving, or step, where no smooth curve goes on

    Examples
    --------
    >>> orbit = periodic_orbit(Conveyor(acceleration=50.0), Start(z=3e-4))
    >>> (doubling,) = continue_orbit(orbit, "acceleration", (49.0, 55.0)).bifurcations
    >>> curve = continue_bifurcation(doubling, "damping", (0.2, 0.4))
    >>> curve.acceleration[[0, -1]].round(2).tolist(), curve.damping[[0, -1]].round(2).tolist()  # m/s², N s/m
    ([50.54, 58.97], [0.2, 0.4])
    """
    check_type("bifurcation", bifurcation, Bifurcation)
    check_type("bifurcation.orbit", bifurcation.orbit, Orbit)
    check_choice("parameter", parameter, PATHS)
    check_choice("bifurcation.kind", bifurcation.kind, (*SIGNS, GRAZING))
    row, kind, period = bifurcation.orbit.parameters, bifurcation.kind, bifurcation.orbit.period
    ends = check_limits(limits, parameter, row[parameter].item())
    if not ends[0] > 0.0:
        raise ValueError(f"limits[0] = {limits[0]!r} must be above 0: a curve is followed over the logarithm")
    point = bifurcation_near(row, kind, bifurcation.orbit.state, period)
    if point is None:
        raise ValueError("bifurcation is none of its conveyor; find one with continue_orbit")
    scale = np.sin if parameter == "angle" else np.asarray
    back = np.arcsin if parameter == "angle" else np.asarray
    begin, *reach = np.log(scale([row[parameter].item(), *ends])).tolist()
    amplitude = point.groups.amplitude / FACTOR, point.groups.amplitude * FACTOR
    low, high = (end - begin for end in reach)
    path = PATHS[parameter](point.groups.exponent)
    if kind == GRAZING:
        curve = follow_grazing_curve(point, path, amplitude, (low, high), step=0.5 * LONGEST_STEP, progress=progress)
    else:
        longest = {"longest_step": LONGEST_STEP, "max_points": MOST_POINTS}
        curve = follow_bifurcation_curve(point, path, amplitude, (low, high), **longest, progress=progress)
    points = [(kind, found, part, form, "ok") for found, part, form in zip(*curve[:3], strict=True)]
    for end, next_to_end in ((0, 1), (-1, -2)) if len(points) > 1 else ():
        last = _at_limit(points[end], points[next_to_end], path, (low, high))
        points[end] = (*last[:-1], curve.ends[end])
    rows = points + [(found.kind, found.point, found.log_ratio, np.nan, found.status) for found in curve.meetings]
    kinds, points, parts, forms, status = zip(*rows, strict=True)
    values = back(np.exp(begin + np.array(parts)))
    conveyors = [replace_parameters(row, **{parameter: value}) for value in values.tolist()]
    states = [
        stroboscopic_map.state_of(found.groups, found.unknown[:2]) * length_and_speed_units(conveyor)
        if len(found.unknown) == 3
        else [np.nan] * 2
        for found, conveyor in zip(points, conveyors, strict=True)
    ]
    delta, v = np.array(states).T
    amplitudes = [
        amplitude_of(conveyor, found.groups.amplitude) for found, conveyor in zip(points, conveyors, strict=True)
    ]
    columns = {"kind": np.array(kinds, dtype=object), "period": np.full(len(points), period)}
    columns |= {"acceleration": np.array(amplitudes), parameter: values, "delta": delta, "v": v}
    columns |= {"normal_form": np.array(forms), "status": np.array(status, dtype=object)}
    inside = (np.array(parts) >= low) & (np.array(parts) <= high)
    return Columns(columns).select(inside)


def _at_limit(last, before, path, reach):
    """The last row of a curve, or, where it lies beyond the limits of λ, that of the curve on the limit, if found."""
    (kind, point, part, form, _), (_, inner, start, *_) = last, before
    limit = min(max(part, reach[0]), reach[1])
    if limit == part:
        return last
    share = (limit - start) / (part - start)
    guess = inner.unknown + share * (point.unknown - inner.unknown)
    groups = CurveEquations(point, path).groups(np.array([0.0, 0.0, np.log(point.groups.amplitude), limit - part]))
    found = find_bifurcation(kind, point.period, guess, groups)
    if found is None:
        return last
    if kind in SIGNS:
        value, _ = normal_form(found, np.array([1.0, 0.0]))
        form = math.copysign(value, form) if kind == "fold" else value  # that of a fold has the sign of r
    return kind, found, limit, form, "ok"


def _side(equations, begin, direction, limits, longest_step, max_points, shown):
    """The unknowns along one direction of a curve, and the reason why it ends."""
    unknowns = [begin]
    lengths = {"first": min(FIRST_STEP, longest_step), "smallest": SMALLEST_STEP, "largest": longest_step}
    steps = follow_curve(equations.correct, equations.tangent, begin, direction, **lengths, straight=STRAIGHT)
    for first, last, _, next_tangent, length in steps:
        if equations.period % 2 == 0 and linear_algebra.dot(equations.halving(first), equations.halving(last)) < 0.0:
            return unknowns, "period halving"
        unknowns.append(last)
        shown.update()
        if not (limits[0] <= last[2] <= limits[1] and limits[2] <= last[3] <= limits[3]):
            return unknowns, "limit"
        is_near = len(unknowns) > 3 and linear_algebra.length(last - begin) < length
        if is_near and linear_algebra.dot(next_tangent, begin - last) > 0.0:
            return [*unknowns, begin], "closed"
        if len(unknowns) > max_points:
            return unknowns, "length"
    return unknowns, "lost" if equations.tangent(begin, direction) is None else "step"


def _meetings(equations, unknowns, forms, rights, impacts, ends) -> Iterable[CodimensionTwoPoint]:
    """Points of codimension two on a curve, and grazings at its ends."""
    if ends[0] == "step" and len(unknowns) > 1:
        yield from _grazings(equations, *unknowns[1::-1], "the curve ends here")
    for n in range(len(unknowns) - 1):
        begin, end = unknowns[n], unknowns[n + 1]
        if impacts[n] != impacts[n + 1]:
            grazings = list(_grazings(equations, begin, end, "ok"))
            yield from grazings or [CodimensionTwoPoint(GRAZING, equations.point(end), float(end[3]), "not located")]
        if np.sign(forms[n]) * np.sign(forms[n + 1]) < 0.0:
            yield _degenerate(equations, begin, end, lambda one, along=rights[n]: normal_form(one, along)[0])
    if ends[1] == "step" and len(unknowns) > 1:
        yield from _grazings(equations, *unknowns[-2:], "the curve ends here")


def _degenerate(equations, begin, end, test):
    """The cusp or generalised doubling between two unknowns: a zero of `test`, by bisection."""
    kind = "cusp" if equations.kind == "fold" else "generalised doubling"
    first, last = test(equations.point(begin)), test(equations.point(end))
    largest, status = max(abs(first), abs(last)), "ok"
    while status == "ok" and linear_algebra.length(end - begin) > RESOLUTION:
        chord = end - begin
        middle = equations.correct(0.5 * (begin + end), chord / linear_algebra.length(chord))
        if middle is None:
            status = "not located"
            break
        value = test(equations.point(middle))
        if value * first > 0.0:
            begin, first = middle, value
        else:
            end, last = middle, value
    if status == "ok" and max(abs(first), abs(last)) > SMALL * largest:
        status = "changes sign by a jump"  # at a grazing
    return CodimensionTwoPoint(kind, equations.point(end), float(end[3]), status)


def _grazings(equations, begin, end, status):
    """The orbit between two unknowns, or a little beyond the second, that touches the plate at relative rest, if any.

    The functions of the bifurcation have no second derivatives there. The grazing is therefore found as a zero of other
    functions, whose unknowns are the phase ψ of the touch, log Γ and λ.
    """

    def functions(guess):
        groups = equations.groups(np.append(np.zeros(2), guess[1:]))
        touch = linearise(groups, np.zeros(2), equations.period, guess[0])
        return np.full(3, np.nan) if touch is None else np.append(touch.image, multiplier_test(equations.kind, touch))

    for near in (end, begin):
        phase = touching_point(equations.groups(near), near[:2], equations.period)
        if phase is None:
            continue
        touch = find_touch(functions, np.append(phase[0], near[2:]))
        if touch is not None and np.abs(touch[1:] - near[2:]).max() < 2.0 * max(np.abs(end - begin).max(), NEARBY):
            groups = equations.groups(np.append(np.zeros(2), touch[1:]))
            point = BifurcationPoint(GRAZING, equations.period, np.array([touch[0], groups.amplitude]), groups)
            yield CodimensionTwoPoint(GRAZING, point, float(touch[2]), status)
            return
