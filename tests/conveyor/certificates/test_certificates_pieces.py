"""Enclosures of flights, contacts and events: the solver, closed forms, and cases that must be refused."""

import math

import numpy as np
import pytest
from flint import arb, arb_mat

from conveyor.analysis import stroboscopic_map
from conveyor.analysis.bifurcations.periodic_orbits import ReturnMap
from conveyor.certificates import double_double, taylor
from conveyor.certificates.balls import Refused, bounds, exactly, precision
from conveyor.certificates.flight import Flight
from conveyor.certificates.law import Accuracy, System, law_of
from conveyor.certificates.motion import follow
from conveyor.certificates.roots import bracket_first_root, sharpen
from conveyor.solver.model import Conveyor, Start, pack

FINE = Accuracy(order=24, tolerance=1e-22)
COARSE = Accuracy(order=16, tolerance=1e-11)
RUN = 1e-14  # tolerance of the floating-point runs


@pytest.fixture(autouse=True)
def arithmetic():
    with precision(128, 24):
        yield


def random_conveyor(random) -> Conveyor:
    return Conveyor(
        acceleration=random.uniform(20.0, 90.0),
        stiffness=5e5 * 10.0 ** random.uniform(-0.5, 0.5),
        damping=random.uniform(0.05, 0.6),
        psi0=random.uniform(0.0, 6.0),
        exponent=random.choice([1.5, 2.0]),
    )


def after_a_cycle(conveyor: Conveyor, state: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(δ, Y) after a cycle in units of the law, its derivative, and the features of the cycle, in floating point."""
    row = pack(conveyor, Start())
    returns = ReturnMap(row, 1)
    unknown = np.append(state, conveyor.acceleration)
    end = returns.state(unknown)
    _, matrices, features = stroboscopic_map.monodromy(row, RUN, end, 1, 0.0)
    unit = returns.unit[:2]
    return returns.scaled(conveyor.acceleration, end)[:2], matrices[0] * unit / unit[:, None], features[0]


def test_enclosures_contain_the_solver_on_random_cycles():
    """Initial states in the air, random conveyors; enclosures are little wider than the round-off of the solver."""
    random = np.random.default_rng(1)
    held = 0
    for _ in range(60):
        conveyor = random_conveyor(random)
        law = law_of(conveyor)
        state = np.array([-random.uniform(0.5, 8.0), random.uniform(-2.0, 4.0)])
        begin, gamma = law.phase, law.gamma(exactly(conveyor.acceleration))
        try:
            found = follow(
                System(law, gamma, COARSE), begin, begin + 2 * arb.pi(), *map(arb, state.tolist()), columns=2
            )
        except Refused:
            continue
        if not found.impacts:
            # A flight is closed form: its enclosure is narrower than the round-off of floats.
            continue
        end, matrix, features = after_a_cycle(conveyor, state)
        assert found.delta.contains(float(end[0]))
        assert found.y.contains(float(end[1]))
        assert all(found.matrix[i, j].overlaps(arb(float(matrix[i, j]), 1e-7)) for i in range(2) for j in range(2))
        assert len(found.impacts) == features[stroboscopic_map.IMPACTS]
        assert float(found.contact / law.omega) == pytest.approx(features[stroboscopic_map.CONTACT_TIME], abs=1e-9)
        assert found.delta.rad() < 1e-3
        held += 1
    assert held >= 30


def test_flight_against_the_parabola():
    """A plate at rest: the flight ends at u + √(u² + 2 q)."""
    flight = Flight(arb(1), arb(0.3), arb(0.7), arb(0))
    found = bracket_first_root(flight.gap, flight.rate, arb(10), False, "gap")
    lapse = sharpen(flight.gap, flight.rate, *found)
    truth = flight.rate0 + (flight.rate0 * flight.rate0 + 2 * flight.gap0).sqrt()
    assert lapse.overlaps(truth)
    assert lapse.rad() < 1e-30
    assert flight.rate(lapse).overlaps(-(flight.rate0 * flight.rate0 + 2 * flight.gap0).sqrt())


def hooke(law, gamma, begin, end, delta, speed):
    """δ and δ' of δ'' + β δ' + κ δ = 1 + γ cos φ at the phase `end`: equilibrium, harmonic part and damped ringing."""
    beta, kappa = law.beta, law.kappa
    size = (kappa - 1) * (kappa - 1) + beta * beta
    cosine, sine = gamma * (kappa - 1) / size, gamma * beta / size

    def driven(phase):
        value = 1 / kappa + cosine * phase.cos() + sine * phase.sin()
        return value, sine * phase.cos() - cosine * phase.sin()

    first, rate = driven(begin)
    frequency = (kappa - beta * beta / 4).sqrt()
    a, decay = delta - first, -beta / 2
    b = (speed - rate - decay * a) / frequency
    lapse = end - begin
    factor, (s, c) = (decay * lapse).exp(), (frequency * lapse).sin_cos()
    last, last_rate = driven(end)
    value = factor * (a * c + b * s)
    slope = decay * value + factor * frequency * (b * c - a * s)
    return last + value, last_rate + slope


def test_contact_against_the_closed_form_of_a_spring():
    conveyor = Conveyor(exponent=1.0, stiffness=3000.0, acceleration=30.0)
    law = law_of(conveyor)
    gamma, begin = law.gamma(arb(30)), arb(0)
    end = begin + arb(0.6)
    found = follow(System(law, gamma, FINE), begin, end, arb(0.03), arb(0.05), columns=3)
    delta, speed = hooke(law, gamma, begin, end, arb(0.03), arb(0.05) - law.beta * arb(0.03))
    assert found.delta.overlaps(delta)
    assert found.y.overlaps(speed + law.beta * delta)
    assert found.delta.rad() < 1e-19
    # The motion is linear, so its derivatives by δ, Y and γ are differences.
    for column, (change, more) in enumerate((((1, 0), 0), ((0, 1), 0), ((0, 0), 1))):
        start = arb(0.03) + change[0], arb(0.05) + change[1]
        other = hooke(law, gamma + more, begin, end, start[0], start[1] - law.beta * start[0])
        assert found.matrix[0, column].overlaps(other[0] - delta)
        assert found.matrix[1, column].overlaps(other[1] - speed + law.beta * (other[0] - delta))


def test_determinant_follows_from_the_time_in_contact():
    law = law_of(Conveyor())
    found = follow(System(law, law.gamma(arb(40)), FINE), arb(0), 2 * arb.pi(), arb(-5.5), arb(0.7), columns=2)
    assert len(found.impacts) == 1
    assert found.matrix.det().overlaps((-law.beta * found.contact).exp())
    assert found.matrix.det().rad() < 1e-17


def test_derivative_by_the_amplitude_agrees_with_differences():
    law = law_of(Conveyor())
    step = arb(1e-9)
    at = [
        follow(
            System(law, law.gamma(arb(40)) + side * step, FINE), arb(0), 2 * arb.pi(), arb(-5.5), arb(0.7), columns=3
        )
        for side in (-1, 0, 1)
    ]
    for row, values in enumerate(([found.delta for found in at], [found.y for found in at])):
        difference = (values[2] - values[0]) / (2 * step)
        assert float(at[1].matrix[row, 2]) == pytest.approx(float(difference), rel=1e-9)


def test_the_image_of_a_box_contains_all_images():
    law = law_of(Conveyor())
    gamma, end = law.gamma(arb(40)), 2 * arb.pi()
    wide = follow(System(law, gamma, COARSE), arb(0), end, arb(-5.5, 1e-5), arb(0.7, 1e-5), columns=2)
    for shift in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        start = arb(-5.5) + shift[0] * arb(1e-5), arb(0.7) + shift[1] * arb(1e-5)
        corner = follow(System(law, gamma, COARSE), arb(0), end, *start)
        assert wide.delta.overlaps(corner.delta)
        moved = wide.matrix * arb_mat([[value * arb(1e-5)] for value in shift])
        centre = follow(System(law, gamma, COARSE), arb(0), end, arb(-5.5), arb(0.7))
        assert (centre.delta + moved[0, 0]).overlaps(corner.delta)


def test_the_remainder_bounds_the_missing_terms():
    """A step of low order, compared with the same step of high order."""
    law = law_of(Conveyor())
    start = [arb(0), arb(3.6), arb(2.26)]
    short = taylor.make_step(System(law, law.gamma(arb(40)), Accuracy(6, 1e-5)), start, 3)
    long = taylor.make_step(System(law, law.gamma(arb(40)), Accuracy(24, 1e-22)), start, 3)
    s = short.length.min(long.length)
    for component in range(len(short.parts)):
        low, high = short.value(component, s), long.value(component, s)
        assert low.overlaps(high)
        assert high.rad() < 1e-15
    left_out = short.parts[taylor.Y](s) - long.value(taylor.Y, s)
    assert not left_out.contains(0)
    assert abs(left_out) <= short.remainders[taylor.Y]


@pytest.mark.parametrize("change", [(slice(None), 0, 3, 1e-24), (slice(None), 2, slice(None), -1e-31)])
def test_a_false_enclosure_of_a_series_is_refused(monkeypatch, change):
    """Midpoints moved by more than their radii, and radii that are too small."""
    component, part, order, by = change

    def enclose_falsely(*arguments):
        rows = double_double.enclose_series(*arguments)
        rows[component, part, order] += by
        return rows

    law = law_of(Conveyor())
    start = [arb(0), arb(3.6), arb(2.26)]
    taylor.make_step(System(law, law.gamma(arb(40)), Accuracy(24, 1e-22)), start, 2)
    monkeypatch.setattr(taylor, "enclose_series", enclose_falsely)
    with pytest.raises(Refused, match="the series of a step is not proved"):
        taylor.make_step(System(law, law.gamma(arb(40)), Accuracy(24, 1e-22)), start, 2)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 2.5])
@pytest.mark.parametrize("bits", [64, 128])
def test_enclosures_of_series_are_narrow(exponent, bits):
    """Below 1e-12 and in proportion to their boxes, for all exponents, with and without penetration at the start."""
    law = law_of(Conveyor(exponent=exponent, stiffness=5e5 * 1e4 ** (2 * (exponent - 1.5))))
    with precision(bits, 24):
        for start in ([arb(0), arb(3.6), arb(2.26)], [arb(0.3), arb(-0.7), arb(1)]):
            for radius in (0.0, 1e-9):
                wide = [value + arb(0, radius) for value in start[1:]]
                made = taylor.make_step(System(law, law.gamma(arb(40)), Accuracy(24, 1e-14)), [start[0], *wide], 3)
                widths = [float(made.value(i, made.length).rad()) for i in range(len(made.parts))]
                assert max(widths) < 1e-12 + 100.0 * radius


def test_truncation_of_series_is_noticed():
    law = law_of(Conveyor())
    with precision(128, 16), pytest.raises(ValueError, match="series of order 24 in a context for 16"):
        follow(System(law, law.gamma(arb(40)), FINE), arb(0), arb(1), arb(1), arb(1))


def test_grazing_is_refused():
    """A flight whose gap touches zero from above, and a box of flights that includes hits and misses."""
    gamma, touch = arb(3), arb.pi()
    back = Flight(touch, arb(0), arb(0), gamma)
    start = Flight(touch - 1, back.gap(arb(-1)), back.rate(arb(-1)), gamma)
    assert start.gap0 > 0
    for gap in (start.gap0, start.gap0 + arb(0, 1e-6)):
        flight = start._replace(gap0=gap)
        with pytest.raises(Refused, match="grazing"):
            bracket_first_root(flight.gap, flight.rate, arb(2), False, "the gap")
    # Farther from the plate the same flight has no impact; nearer it has one.
    assert bracket_first_root(start._replace(gap0=start.gap0 + 0.1).gap, start.rate, arb(1.5), False, "the gap") is None
    assert (
        bracket_first_root(start._replace(gap0=start.gap0 - 0.1).gap, start.rate, arb(1.5), False, "the gap")
        is not None
    )


def test_a_state_at_an_event_is_refused():
    law = law_of(Conveyor())
    with pytest.raises(Refused, match="at the section"):
        follow(System(law, law.gamma(arb(40)), FINE), arb(0), arb(1), arb(0, 1e-9), arb(1))


def test_a_separation_at_the_end_of_a_motion_is_refused():
    """Parts in a ball of states leave the plate within a ball of phases; a motion cannot end there."""
    law, delta = law_of(Conveyor()), arb(0.01, 1e-3)
    system = System(law, law.gamma(arb(40)), FINE)
    separation = follow(system, arb(0), arb(1), delta, arb(-1)).contact
    reasons = set()
    for part in np.linspace(-0.5, 0.95, 30):
        end = (separation.mid() + separation.rad() * arb(float(part))).mid()
        with pytest.raises(Refused) as refusal:
            follow(system, arb(0), end, delta, arb(-1))
        reasons.add(str(refusal.value))
    assert "a separation lies at the section" in reasons


def test_first_of_several_roots_is_found():
    """cos has its first zero at π/2, and none before 1.5."""
    low, high = bracket_first_root(lambda s: s.cos(), lambda s: -s.sin(), arb(9), False, "cosine")
    root = sharpen(lambda s: s.cos(), lambda s: -s.sin(), low, high)
    assert root.overlaps(arb.pi() / 2)
    assert root.rad() < 1e-30
    assert bracket_first_root(lambda s: s.cos(), lambda s: -s.sin(), arb(1.5), False, "cosine") is None
    with pytest.raises(Refused, match="grazing"):
        bracket_first_root(lambda s: (s - 1) * (s - 1), lambda s: 2 * (s - 1), arb(2), False, "a square")


def test_numbers_are_read_as_decimals():
    law = law_of(Conveyor())
    assert law.slope.overlaps((arb.pi() / 15).sin() * 100 / 981)
    assert law.slope.rad() < 1e-38
    assert law.beta.overlaps(arb(3) / 10 / (arb(7) / 10000 * 100 * arb.pi()))
    assert not law.beta.contains(0.3 / 7e-4 / (100.0 * math.pi))
    with pytest.raises(ValueError, match="tension"):
        law_of(Conveyor(tension="clip"))
    with pytest.raises(ValueError, match="exponent"):
        law_of(Conveyor(exponent=1.7))


def test_floats_are_rounded_outwards():
    """The nearest float of 1/3 is below it, that of 1/10 above."""
    for number in (arb(1) / 3, arb(1) / 10):
        low, high = bounds(number)
        assert arb(low) < number < arb(high)
        assert high == math.nextafter(low, 1.0)
    assert bounds(arb(0.25)) == (0.25, 0.25)
