"""Brackets of bifurcations: amplitudes between which a multiplier passes -1, or a branch turns, by the mean value
theorem of Bolzano on a branch that is proved from end to end.
"""

from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from .balls import Refused, between, exactly, middle
from .guess import Motion, guess
from .newton import Zero, corrected, exact, floats, prove
from .orbit import ProvedOrbit, linearised, prove_orbit
from .shooting import OnArc, Shooting

# Secant steps to where a test function is zero, from two amplitudes this far apart (m/s²).
SECANT_STEPS, APART = 6, 1e-6
# Part of a branch on which its turn is searched, in the units of the unknowns, and how often.
SEARCHED_ARC, SEARCHES = 1e-4, 2


class Doubling(NamedTuple):
    """Within `acceleration` (m/s²) a multiplier of the orbit passes -1."""

    acceleration: arb
    tests: tuple[arb, arb]  # (1 + μ1)(1 + μ2) at both ends
    branch: ProvedOrbit  # over all amplitudes between them


class Fold(NamedTuple):
    """An arc of a branch has its least amplitude within, where a multiplier is +1."""

    acceleration: arb  # encloses the least amplitude, m/s²
    tests: tuple[arb, arb]  # (1 - μ1)(1 - μ2) at both ends of the arc
    opposite: tuple[arb, arb]  # (1 + μ1)(1 + μ2) there
    branch: Zero  # over the whole arc


def check_within(zero: Zero, other: Zero) -> None:
    """Prove that a zero at one value of the parameter is the one of a branch over a ball that contains this value.

    Raises
    ------
    Refused
        if the enclosure of the one is not inside the box in which the other is the only one
    """
    pairs = zip(other.box.entries(), zero.enclosure.entries(), strict=True)
    if not all(box.contains(point) for box, point in pairs):
        raise Refused("the ends are not proved to lie on the branch between them")


def bracket_doubling(shooting: Shooting, acceleration: float, strobes: np.ndarray, half_width: float) -> Doubling:
    """A bracket of the amplitude at which a multiplier of an orbit passes -1.

    Parameters
    ----------
    shooting : period and accuracy
    acceleration : approximate amplitude, m/s²
    strobes : (δ, Y) of the orbit there in units of the law, shape (period, 2)
    half_width : of the bracket, m/s²

    Raises
    ------
    Refused
        with the reason
    """
    law = shooting.law

    def orbit_at(amplitude: float) -> ProvedOrbit:
        return prove_orbit(shooting, law.gamma(exactly(amplitude)), strobes)

    def test(amplitude: float) -> float:
        return guess(law, float(law.gamma(exactly(amplitude))), shooting.nodes, strobes).doubling_test

    # Where to look, in floating point: nothing is proved by the secant.
    before, here = acceleration, acceleration + APART
    last, now = test(before), test(here)
    for _ in range(SECANT_STEPS):
        if now == last or abs(here - before) < 0.1 * half_width:
            break
        before, here, last = here, here - now * (here - before) / (now - last), now
        now = test(here)
    low, high = here - half_width, here + half_width
    ends = orbit_at(low), orbit_at(high)
    signs = [(end.doubling_test > 0, end.doubling_test < 0) for end in ends]
    if signs not in ([(True, False), (False, True)], [(False, True), (True, False)]):
        raise Refused("1 + trace + determinant has no two different signs at the ends")
    branch = prove_orbit(shooting, between(ends[0].gamma, ends[1].gamma), strobes)
    for end in ends:
        check_within(end.zero, branch.zero)
    return Doubling(between(exactly(low), exactly(high)), tuple(end.doubling_test for end in ends), branch)


def bracket_fold(shooting: Shooting, acceleration: float, strobes: np.ndarray, half_arc: float) -> Fold:
    """A bracket of the least amplitude of a branch that turns.

    On the arc the equations with the place as a parameter are regular, by proof. There, by Cramer's rule, dγ/d(place)
    is det(P' - 1) = (1 - μ1)(1 - μ2) over a determinant that has no zero: it changes its sign with this product.

    Parameters
    ----------
    shooting : period and accuracy
    acceleration : approximate amplitude, m/s²
    strobes : (δ, Y) of the orbit there in units of the law, shape (period, 2)
    half_arc : half the length of the arc, in the units of the unknowns

    Raises
    ------
    Refused
        with the reason
    """
    gamma = float(shooting.law.gamma(exactly(acceleration)))
    # Newton's iteration at one amplitude would diverge here.
    states = Motion(shooting.law, gamma, shooting.nodes).launch(strobes)
    origin = exact(np.append(states, gamma)[:, None])
    # The direction of the branch: what the equations, without the last one, leave free.
    flat = OnArc(shooting, origin, arb_mat([[0] * (2 * shooting.count) + [1]]), arb(0))
    _, slope, _ = flat(origin, True)
    direction = exact(np.linalg.svd(floats(slope)[:-1])[2][-1:])

    def at(place: arb) -> Zero:
        equations = OnArc(shooting, origin, direction, place)
        start = origin + direction.transpose() * middle(place)
        _, slope, _ = equations(start, True)
        near = corrected(equations, floats(start).ravel(), floats(slope), shooting.least)
        return prove(equations, near, shooting.least, "arc of the branch")

    def tests(zero: Zero) -> tuple[arb, arb]:
        trace, determinant, _ = linearised(shooting, zero.evidence)
        return 1 - trace + determinant, 1 + trace + determinant

    # Where the branch turns: nothing is proved by the secants.
    half, turn, reach = arb(half_arc), arb(0), arb(SEARCHED_ARC)
    for _ in range(SEARCHES):
        before, behind = (middle(tests(at(turn + side * reach))[0]) for side in (-1, 1))
        turn, reach = middle(turn - reach * (behind + before) / (behind - before)), reach / 100
    ends = at(turn - half), at(turn + half)
    top, branch = at(turn), at(turn + arb(0, half))
    for zero in (top, *ends):
        check_within(zero, branch)
    gammas = [zero.enclosure.entries()[-1] for zero in (*ends, top, branch)]
    if not (gammas[2] < gammas[0] and gammas[2] < gammas[1]):
        raise Refused("the amplitude is not least within the arc")
    folds = [tests(end) for end in ends]
    if not (folds[0][0] > 0 > folds[1][0] or folds[0][0] < 0 < folds[1][0]):
        raise Refused("1 - trace + determinant has no two different signs at the ends of the arc")
    least = between(gammas[3].lower(), gammas[2].upper()) / shooting.law.slope
    return Fold(least, *zip(*folds, strict=True), branch)
