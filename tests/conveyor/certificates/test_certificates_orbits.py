"""Proofs of orbits, bifurcations and horseshoes, compared with other arithmetic, and proofs that must fail."""

from fractions import Fraction

import numpy as np
import pytest
from flint import arb, arb_mat

from conveyor.analysis import stroboscopic_map
from conveyor.analysis.bifurcations import continuation, periodic_orbits
from conveyor.certificates import brackets, covering
from conveyor.certificates.balls import Refused, bounds, exactly, precision
from conveyor.certificates.brackets import bracket_doubling, bracket_fold
from conveyor.certificates.excursion import plan_sets
from conveyor.certificates.law import Accuracy, System, law_of
from conveyor.certificates.newton import Approximation, correct, krawczyk, prove_zero
from conveyor.certificates.orbit import ProvedOrbit, check_near, prove_orbit
from conveyor.certificates.shooting import Shooting, equations_at, launch
from conveyor.solver.model import Conveyor, Start, pack

FINE = Accuracy(order=24, tolerance=1e-22)
PARAMETERS = pack(Conveyor(), Start())


@pytest.fixture(autouse=True)
def arithmetic():
    with precision(128, 24):
        yield


def settled(acceleration: float, z0: float, period: int) -> np.ndarray:
    """Strobes (δ, Y) of the stable orbit that an initial condition leads to, in units of the law."""
    row = pack(Conveyor(acceleration=acceleration), Start(z0))
    state = stroboscopic_map.initial_states(row[None], periodic_orbits.ORBIT_TOLERANCE)[0]
    orbit = periodic_orbits.settled_orbit(row, state, (period,), 1000)
    return strobes(acceleration, orbit.state, period)


def strobes(acceleration: float, state: np.ndarray, period: int) -> np.ndarray:
    returns = periodic_orbits.ReturnMap(PARAMETERS, period)
    unknown = returns.scaled(acceleration, state)
    return np.vstack([unknown[:2], returns.strobes(unknown)[:-1, :2]])


def stored(acceleration: float, start: np.ndarray, period: int) -> periodic_orbits.Orbit:
    """The orbit of these strobes in floating point."""
    state = periodic_orbits.ReturnMap(PARAMETERS, period).state(np.append(start[0], acceleration))
    return periodic_orbits.orbit_near(pack(Conveyor(acceleration=acceleration), Start()), state, period)


def shooting(period: int, law=None, accuracy=FINE) -> Shooting:
    return Shooting(law or law_of(Conveyor()), accuracy, period)


def proved(acceleration: float, start: np.ndarray, period: int = 1, **changes):
    equations = shooting(period, **changes)
    return prove_orbit(equations, equations.law.gamma(exactly(acceleration)), start)


@pytest.fixture(scope="module")
def jumping():
    return settled(40.0, 3e-4, 1)


@pytest.mark.parametrize(
    ("acceleration", "z0", "period", "impacts"),
    [(40.0, 0.0, 1, 0), (40.0, 3e-4, 1, 1), (49.0, 0.0, 1, 1), (58.0, 3e-4, 2, 2)],
)
def test_stable_orbits_are_proved(acceleration, z0, period, impacts):
    """Riding, jumping, bouncing, and jumping with period 2."""
    start = settled(acceleration, z0, period)
    orbit = proved(acceleration, start, period)
    assert orbit.stability == "stable"
    assert len(orbit.impacts) == impacts
    assert check_near(orbit, start, 1e-10) < 1e-11
    assert orbit.half_width < 1e-17
    float_orbit = stored(acceleration, start, period)
    for (real, imag), value in zip(orbit.multipliers(), float_orbit.multipliers, strict=True):
        assert float(real) == pytest.approx(value.real, abs=1e-10)
        assert abs(float(imag)) == pytest.approx(abs(value.imag), abs=1e-10)


def test_an_unstable_orbit_is_proved_unstable():
    stable = stored(54.0, settled(54.0, 3e-4, 1), 1)
    beyond = periodic_orbits.orbit_near(pack(Conveyor(acceleration=56.0), Start()), stable.state, 1)
    orbit = proved(56.0, strobes(56.0, beyond.state, 1))
    assert orbit.stability == "unstable"
    assert orbit.doubling_test < 0


def test_other_bits_and_order_agree(jumping):
    one = proved(40.0, jumping)
    with precision(192, 32):
        other = proved(40.0, jumping, law=law_of(Conveyor()), accuracy=Accuracy(order=32, tolerance=1e-30))
        for a, b in zip(one.zero.enclosure.entries(), other.zero.enclosure.entries(), strict=True):
            assert a.overlaps(b)
        assert one.trace.overlaps(other.trace)
        assert other.half_width < 1e-6 * one.half_width


def test_a_false_orbit_is_refused(jumping):
    """Shifted by 1e-6: there is no orbit in a small box around it, and Newton finds a different orbit."""
    problem = shooting(1)
    gamma = problem.law.gamma(exactly(40.0))
    equations = equations_at(problem, gamma)
    near = correct(equations, launch(problem, gamma, jumping), problem.least)
    count = near.centre.nrows()
    deviation = arb_mat([[arb(0, 1e-9)] for _ in range(count)])

    def image(centre):
        value, slope = equations(centre, False)[0], equations(centre + deviation, True)[1]
        return zip(deviation.entries(), krawczyk(value, slope, near.inverse, deviation).entries(), strict=True)

    assert all(wide.contains_interior(narrow) for wide, narrow in image(near.centre))
    shifted = near.centre + arb_mat([[exactly(1e-6)] for _ in range(count)])
    assert any(not wide.overlaps(narrow) for wide, narrow in image(shifted))
    with pytest.raises(Refused, match="another one"):
        check_near(proved(40.0, jumping), jumping + 1e-6, 1e-7)


def test_zeros_of_a_parabola():
    """x² = 2 has one zero near 1.4; x² = -1 has none, and the double zero of x² is not proved."""

    def approximation(constant, centre):
        return Approximation(
            arb_mat([[centre]]), arb_mat([[centre * centre - constant]]), arb_mat([[1 / (2 * centre)]])
        )

    def parabola(constant):
        return lambda x, _: (arb_mat([[x[0, 0] * x[0, 0] - constant]]), arb_mat([[2 * x[0, 0]]]), None)

    zero = prove_zero(parabola(2), approximation(2, arb(1.40625)), 1e-20)
    assert zero.enclosure[0, 0].contains(arb(2).sqrt().mid())
    assert zero.enclosure[0, 0].rad() < 1e-3
    near = correct(parabola(2), approximation(2, arb(1.40625)), 1e-16)
    assert abs(near.centre[0, 0] - arb(2).sqrt()) < 1e-15
    for constant in (-1, 0):
        with pytest.raises(Refused):
            prove_zero(parabola(constant), approximation(constant, arb(1)), 1e-20)


@pytest.mark.parametrize(
    ("multipliers", "stability"),
    [
        ((0.5, 0.25), "stable"),
        ((0.5j, -0.5j), "stable"),
        ((1.5, 0.5), "unstable"),
        ((-1.5, -0.5), "unstable"),
        ((1j, -1j), "open"),
        ((1.0, 0.5), "open"),
    ],
)
def test_stability_by_hand(multipliers, stability):
    """Both multipliers inside the unit circle, one outside, or undecided."""
    one, other = multipliers
    trace, determinant = (arb(complex(value).real) for value in (one + other, one * other))
    orbit = ProvedOrbit(None, None, trace, determinant, arb(0))
    assert orbit.stability == stability
    found = {(float(real), float(imag)) for real, imag in orbit.multipliers()}
    assert found == {(complex(value).real, complex(value).imag) for value in multipliers}


def test_a_wrong_period_is_refused(jumping):
    with pytest.raises(Refused, match="its period may be 1 instead of 2"):
        proved(40.0, np.vstack([jumping, jumping]), 2)
    double = settled(58.0, 3e-4, 2)
    with pytest.raises(Refused, match="nothing nearby"):
        proved(58.0, double[:1])


def test_a_map_with_a_wrong_sign_is_refused(jumping):
    law = law_of(Conveyor())
    for turned in (law._replace(beta=-law.beta), law._replace(slope=-law.slope)):
        with pytest.raises(Refused):
            check_near(proved(40.0, jumping, law=turned), jumping, 1e-7)


def test_an_orbit_that_grazes_is_refused():
    """An interval of amplitudes in which the riding part begins to leave the plate."""
    riding = continuation.follow_branch(stored(45.0, settled(45.0, 0.0, 1), 1), "acceleration", (44.9, 46.0))
    grazing = bifurcation(riding, "grazing")
    equations = shooting(1)
    gamma = equations.law.gamma(exactly(grazing.acceleration) + arb(0, 1e-7))
    with pytest.raises(Refused, match="grazing"):
        prove_orbit(equations, gamma, strobes(grazing.acceleration, grazing.state, 1))


@pytest.fixture(scope="module")
def branch():
    return continuation.follow_branch(stored(40.0, settled(40.0, 3e-4, 1), 1), "acceleration", (23.0, 56.0))


def bifurcation(branch, kind):
    return next(found.orbit for found in branch.bifurcations if found.kind == kind)


def test_the_doubling_is_bracketed(branch):
    orbit = bifurcation(branch, "period_doubling")
    start = strobes(orbit.acceleration, orbit.state, 1)
    found = bracket_doubling(shooting(1), orbit.acceleration, start, 1e-9)
    low, high = bounds(found.acceleration)
    assert 0.0 < high - low < 1e-8
    assert low - 1e-7 < orbit.acceleration < high + 1e-7
    assert found.tests[0] > 0 > found.tests[1]


def test_no_doubling_is_bracketed_where_there_is_none(jumping, monkeypatch):
    """Far from a doubling the search fails; without a search the signs at both ends are equal."""
    with pytest.raises(Refused):
        bracket_doubling(shooting(1), 40.0, jumping, 1e-9)
    monkeypatch.setattr(brackets, "SECANTS", 0)
    with pytest.raises(Refused, match="no two different signs"):
        bracket_doubling(shooting(1), 40.0, jumping, 1e-9)


def test_the_fold_is_bracketed(branch):
    orbit = bifurcation(branch, "fold")
    found = bracket_fold(shooting(1), orbit.acceleration, strobes(orbit.acceleration, orbit.state, 1), 1e-6)
    low, high = bounds(found.acceleration)
    assert 0.0 < high - low < 1e-8
    assert low - 1e-7 < orbit.acceleration < high + 1e-7
    assert not found.tests[0].overlaps(found.tests[1])


def test_no_fold_is_bracketed_where_there_is_none(jumping, branch, monkeypatch):
    """Also if the arc does not contain the turn, or is too long for a proof."""
    with pytest.raises(Refused):
        bracket_fold(shooting(1), 40.0, jumping, 1e-6)
    orbit = bifurcation(branch, "fold")
    start = strobes(orbit.acceleration, orbit.state, 1)
    with pytest.raises(Refused):
        bracket_fold(shooting(1), orbit.acceleration, start, 0.1)
    monkeypatch.setattr(brackets, "SECANTS", 0)
    with pytest.raises(Refused, match="not least within the arc"):
        bracket_fold(shooting(1), 40.0, jumping, 1e-6)


CHAOS = Accuracy(order=16, tolerance=1e-14)


def is_proved(plan):
    try:
        return horseshoe(*plan).entropy > 0.0
    except Refused:
        return False


@pytest.fixture(scope="module")
def horseshoe_plan():
    """Sets along the shortest provable excursion from the strongest saddle of one cycle at 80 m/s²."""
    rides = continuation.follow_branch(stored(45.0, settled(45.0, 0.0, 1), 1), "acceleration", (44.9, 80.5)).orbits
    returns = periodic_orbits.ReturnMap(PARAMETERS, 1)
    near = [orbit for orbit in rides if abs(orbit.acceleration - 80.0) < 0.2]
    found = [returns.newton(returns.scaled(80.0, orbit.state)) for orbit in near]
    fixed = next(unknown for unknown in found if unknown is not None)
    return next(plan for plan in plan_sets(PARAMETERS, fixed, 1e-6, 0.3, 14) if is_proved(plan))


def horseshoe(centres, axes):
    with precision(64, 16):
        law = law_of(Conveyor())
        return covering.prove_horseshoe(System(law, law.gamma(arb(80)), CHAOS), centres, axes)


def test_a_horseshoe_is_proved(horseshoe_plan):
    found = horseshoe(*horseshoe_plan)
    assert found.entropy > 0.1
    assert len(found.sets) < 20


def test_a_false_horseshoe_is_refused(horseshoe_plan):
    centres, axes = horseshoe_plan
    with pytest.raises(Refused, match="beyond both unstable sides"):
        horseshoe(centres[[0, *range(2, len(centres))]], [axes[0], *axes[2:]])
    flat = [axes[0], axes[1] * [1.0, 1e-3], *axes[2:]]
    with pytest.raises(Refused, match="between the stable sides"):
        horseshoe(centres, flat)
    with pytest.raises(Refused, match="disjoint"):
        horseshoe(centres[[0, 0, *range(1, len(centres))]], [axes[0], axes[0], *axes[1:]])


def test_entropy_of_a_full_shift():
    """Stays and excursions of one cycle each are two free symbols; of one and two cycles, the golden mean."""
    for cycles, root in ((1, arb(2)), (2, (1 + arb(5).sqrt()) / 2)):
        bound = covering.bound_entropy(cycles)
        assert bound <= root.log()
        assert root.log() - bound < 1e-15


# An independent enclosure: intervals of whole numbers over 2^BITS, a first-order a priori box and Lagrange's remainder;
# nothing is shared with the library.
BITS = 100


class Interval:
    """Two whole numbers over 2^BITS, rounded outwards."""

    def __init__(self, low, high=None):
        self.low = (Fraction(low) * 2**BITS).__floor__()
        self.high = (Fraction(low if high is None else high) * 2**BITS).__ceil__()

    @classmethod
    def of(cls, low: int, high: int):
        new = cls.__new__(cls)
        new.low, new.high = low, high
        return new

    @property
    def ends(self):
        return Fraction(self.low, 2**BITS), Fraction(self.high, 2**BITS)

    def __add__(self, other):
        return Interval.of(self.low + other.low, self.high + other.high)

    def __neg__(self):
        return Interval.of(-self.high, -self.low)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        products = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval.of(min(products) >> BITS, -(-max(products) >> BITS))

    def over(self, count: int):
        return Interval.of(self.low // count, -(-self.high // count))

    def contains(self, other):
        return self.low <= other.low and other.high <= self.high


def sine_cosine(phase: Interval) -> tuple[Interval, Interval]:
    """Their series about the centre; the remainder of an alternating series is less than its next term."""
    centre = sum(phase.ends) / 2
    sums = [Fraction(0), Fraction(0)]
    term = Fraction(1)
    for n in range(80):
        sums[n % 2] += term if n % 4 in (0, 1) else -term
        term = Fraction((term * centre / (n + 1) * 2**200).__round__(), 2**200)
    # Slopes of at most 1, and less than 2^-150 for the rest and the rounding of 80 terms.
    radius = (phase.ends[1] - phase.ends[0]) / 2 + Fraction(1, 2**150)
    return Interval(sums[1] - radius, sums[1] + radius), Interval(sums[0] - radius, sums[0] + radius)


def coefficients(beta, kappa, gamma, w, v, sine, cosine, order):
    """Taylor coefficients of w, v, sin φ, cos φ and φ - φ(0), by v' = w (1 + γ cos φ - β v) - κ w⁴."""
    w, v, sine, cosine, phase = [w], [v], [sine], [cosine], [Interval(0)]

    def product(a, b, n):
        total = Interval(0)
        for k in range(n + 1):
            total = total + a[k] * b[n - k]
        return total

    square = []
    for n in range(order):
        square.append(product(w, w, n))
        pushed = [Interval(1 if k == 0 else 0) + gamma * cosine[k] - beta * v[k] for k in range(n + 1)]
        rates = (
            v[n].over(2),
            product(w, pushed, n) - kappa * product(square, square, n),
            product(w, cosine, n),
            -product(w, sine, n),
            w[n],
        )
        for series, rate in zip((w, v, sine, cosine, phase), rates, strict=True):
            series.append(rate.over(n + 1))
    return w, v, phase


def lagrange_step(law, w, v, phase, length, order):
    """w, v and φ after `length`: polynomial plus (order)-th coefficients over a box that the motion does not leave."""
    beta, kappa, gamma = law
    sizes = Interval(Fraction(-1, 10), Fraction(1, 10)), Interval(-1, 1), Interval(Fraction(-1, 40), Fraction(1, 40))
    box = [start + size for start, size in zip((w, v, phase), sizes, strict=True)]
    reach, square = Interval(0, length), box[0] * box[0]
    pushed = Interval(1) + gamma * sine_cosine(box[2])[1] - beta * box[1]
    rates = box[1].over(2), box[0] * pushed - kappa * square * square, box[0]
    for start, rate, wide in zip((w, v, phase), rates, box, strict=True):
        assert wide.contains(start + rate * reach)  # Picard: the motion stays in the box
    near = coefficients(beta, kappa, gamma, w, v, *sine_cosine(phase), order)
    far = coefficients(beta, kappa, gamma, box[0], box[1], *sine_cosine(box[2]), order)

    def at(s):
        powers = [Interval(1)]
        for _ in range(order):
            powers.append(powers[-1] * s)
        values = []
        for part, rest in zip(near, far, strict=True):
            value = rest[order] * powers[order]
            for a, power in zip(part[:order], powers, strict=False):
                value = value + a * power
            values.append(value)
        return values[0], values[1], values[2] + phase

    return at


def test_an_independent_enclosure_by_hand(jumping):
    """One contact and one flight of the jumping orbit, from an impact to the next, without code of the library.

    The law of motion in units g/ω², g/ω and 1/ω, with bounds of its numbers from the library.
    """
    orbit = proved(40.0, jumping)
    units = law_of(Conveyor())

    def handed(ball):
        low, high = ball.lower().man_exp(), ball.upper().man_exp()
        return Interval(*(Fraction(int(m)) * Fraction(2) ** int(e) for m, e in (low, high)))

    beta, kappa, gamma = (handed(value) for value in (units.beta, units.kappa, units.gamma(arb(40))))
    impact = orbit.impacts[0]
    w, v, phase = Interval(0), handed(impact.speed), handed(impact.phase)
    length, order = Fraction(1, 80), 12
    while True:
        at = lagrange_step((beta, kappa, gamma), w, v, phase, length, order)
        following = at(Interval(length))
        if following[0].high < 0:
            break
        w, v, phase = following
    low, high = Fraction(0), length
    while high - low > Fraction(1, 10**16):
        middle = (low + high) / 2
        value = at(Interval(middle))[0]
        if not (value.low > 0 or value.high < 0):
            break
        low, high = (middle, high) if value.low > 0 else (low, middle)
    # w passes zero between these two values, which are wide enough for certain signs.
    low, high = low - Fraction(1, 10**13), high + Fraction(1, 10**13)
    assert at(Interval(low))[0].low > 0 > at(Interval(high))[0].high
    _, v, phase = at(Interval(low, high))
    assert v.high < 0
    sine, cosine = sine_cosine(phase)

    def gap(lapse):
        swing = sine_cosine(phase + lapse)[1] - cosine + sine * lapse
        return -(v + lapse.over(2)) * lapse + gamma * swing

    lapse = handed(impact.phase + 2 * arb.pi()) - phase
    early, late = (end + sign * Fraction(1, 10**9) for sign, end in zip((-1, 1), lapse.ends, strict=True))
    assert gap(Interval(early)).low > 0 > gap(Interval(late)).high
    around = Interval(early, late)
    speed = v + around + gamma * (sine_cosine(phase + around)[0] - sine)
    assert speed.contains(handed(impact.speed))
    assert speed.ends[1] - speed.ends[0] < Fraction(1, 10**7)
