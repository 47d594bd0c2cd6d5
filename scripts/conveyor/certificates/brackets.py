"""Brackets of bifurcations: amplitudes between which a Floquet multiplier passes -1, or a branch folds.

The branch is proved to exist over the whole interval. The test function (1 ± μ1)(1 ± μ2) is continuous along it and has
different signs at its ends, so that it has a zero in between (Bolzano's theorem).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from .. import linear_algebra
from .balls import Refused, exactly
from .newton import Approximation, Zero, approximate_inverse, correct, exact, midpoints, prove_zero
from .orbit import ProvedOrbit, linearise, prove_orbit
from .shooting import Shooting, equations_on_arc, launch

# Half the length of the first secant: in m/s², and along an arc in the units of the unknowns.
NEAR, NEAR_ON_ARC = 1e-6, 1e-4
# Number of secants; each is a hundred times shorter than the secant before.
SECANTS = 2


class Bracket(NamedTuple):
    """An interval that is proved to contain the amplitude of a bifurcation."""

    acceleration: arb  # m/s²
    tests: tuple[arb, arb]  # (1 ± μ1)(1 ± μ2) at both ends of the interval or of the arc; different signs


def check_within(zero: Zero, branch: Zero) -> None:
    """Prove that a zero lies on a branch: its parameter value lies in the ball of the branch's parameter values.

    Refused if the zero's enclosure is not inside the box that contains exactly one zero for each of these values.
    """
    pairs = zip(branch.box.entries(), zero.enclosure.entries(), strict=True)
    if not all(box.contains(point) for box, point in pairs):
        raise Refused("the ends are not proved to lie on the branch between them")


def approach_root(test: Callable[[arb], arb], guess: arb, reach: float) -> arb:
    """An approximate zero of a test function, as an exact number, by the secant method; nothing is proved here."""
    for _ in range(SECANTS):
        before, behind = test(guess - reach).mid(), test(guess + reach).mid()
        guess, reach = (guess - reach * (behind + before) / (behind - before)).mid(), reach / 100
        if not guess.is_finite():
            raise Refused("a test function is constant near the approximate bifurcation")
    return guess


def bracket_doubling(shooting: Shooting, acceleration: float, strobes: np.ndarray, half_width: float) -> Bracket:
    """A bracket of the amplitude at which a Floquet multiplier of an orbit passes -1 (a period doubling).

    Parameters
    ----------
    shooting : period and accuracy
    acceleration : approximate amplitude, m/s²
    strobes : (δ, Y) of the orbit there in units of the law, shape (period, 2)
    half_width : of the bracket, m/s²
    """

    def orbit_at(amplitude: arb) -> ProvedOrbit:
        return prove_orbit(shooting, shooting.law.gamma(amplitude), strobes)

    centre = float(approach_root(lambda amplitude: orbit_at(amplitude).doubling_test, exactly(acceleration), NEAR))
    bracket = exactly(centre - half_width), exactly(centre + half_width)
    ends = [orbit_at(amplitude) for amplitude in bracket]
    tests = ends[0].doubling_test, ends[1].doubling_test
    if not tests[0] * tests[1] < 0:
        raise Refused("1 + trace + determinant has no two different signs at the ends")
    amplitudes = bracket[0].union(bracket[1])
    branch = orbit_at(amplitudes)
    for end in ends:
        check_within(end.zero, branch.zero)
    return Bracket(amplitudes, tests)


def bracket_fold(shooting: Shooting, acceleration: float, strobes: np.ndarray, half_arc: float) -> Bracket:
    """A bracket of the least amplitude of a branch that folds.

    The equations with the place along an arc as a parameter are proved to be regular. By Cramer's rule dγ/d(place) is
    det(P' - 1) = (1 - μ1)(1 - μ2) divided by a determinant without zeros. The derivative changes its sign with this
    product.

    Parameters
    ----------
    shooting : period and accuracy
    acceleration : approximate amplitude, m/s²
    strobes : (δ, Y) of the orbit there in units of the law, shape (period, 2)
    half_arc : half the length of the arc, in the units of the unknowns
    """
    gamma = shooting.law.gamma(exactly(acceleration)).mid()
    # Newton's iteration at a fixed amplitude would diverge near the fold, so that the approximation is not corrected.
    origin = arb_mat([*launch(shooting, gamma, strobes).centre.tolist(), [gamma]])
    # The tangent of the branch is the null vector of the derivative without its last row.
    flat = equations_on_arc(shooting, origin, arb_mat([[0] * (2 * shooting.count) + [1]]), arb(0))
    _, slope, _ = flat(origin, True)
    along = midpoints(slope)[:-1]
    direction = exact(linear_algebra.null_vector(along, np.ones(along.shape[1]))[None])

    def zero_at(place: arb) -> Zero:
        equations = equations_on_arc(shooting, origin, direction, place)
        centre = origin + direction.transpose() * place.mid()
        value, slope, _ = equations(centre, True)
        near = correct(equations, Approximation(centre, value, approximate_inverse(slope)), shooting.least)
        return prove_zero(equations, near, shooting.least)

    def fold_test(zero: Zero) -> arb:
        return ProvedOrbit(shooting, zero, *linearise(shooting, zero.evidence)).fold_test

    turn = approach_root(lambda place: fold_test(zero_at(place)), arb(0), NEAR_ON_ARC)
    half = arb(half_arc)
    ends = zero_at(turn - half), zero_at(turn + half)
    top, branch = zero_at(turn), zero_at(turn + arb(0, half))
    for zero in (top, *ends):
        check_within(zero, branch)
    at_first, at_last, at_top, on_branch = (zero.enclosure.entries()[-1] for zero in (*ends, top, branch))
    if not (at_top < at_first and at_top < at_last):
        raise Refused("the amplitude is not least within the arc")
    tests = fold_test(ends[0]), fold_test(ends[1])
    if not tests[0] * tests[1] < 0:
        raise Refused("1 - trace + determinant has no two different signs at the ends of the arc")
    return Bracket(on_branch.lower().union(at_top.upper()) / shooting.law.slope, tests)
