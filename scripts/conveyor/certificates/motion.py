"""The motion from one phase of the excitation to another: flights and contacts with proved events, and the derivative.

A state is (δ, Y) at a known phase (see law). The derivative of a later state by it is a product of matrices, one for
each flight and for each step of a contact. Impacts and separations add none: the rates of δ and Y are continuous there,
so that the matrix of the jump is the identity as long as the plate is met with a speed. It is: the proof of every root
of the gap or of w contains a proof that the function falls there.
"""

from typing import NamedTuple

from flint import arb, arb_mat

from . import taylor
from .balls import Refused, between, middle
from .flight import Flight
from .law import Law
from .roots import first_root, sharpen

# Pieces of a motion after which it is given up, and shorter steps that are tried where an event hides in a step's end.
MAX_PIECES, SHORTER_STEPS = 2000, 12


class Accuracy(NamedTuple):
    """How the steps are made."""

    order: int
    tolerance: float  # of the last terms of a step's series


class Impact(NamedTuple):
    """An impact: the phase and the speed of approach."""

    phase: arb
    speed: arb


class Arrival(NamedTuple):
    """Where a motion arrives."""

    delta: arb
    y: arb
    matrix: arb_mat  # derivative of (δ, Y) by the state at the beginning, a third column by γ; no columns if not wanted
    impacts: list[Impact]
    contact: arb  # phase spent in contact
    pieces: int


class _Contact(NamedTuple):
    """A state in contact, or at its beginning (w = 0)."""

    w: arb
    y: arb
    phase: arb


def follow(
    law: Law, accuracy: Accuracy, gamma: arb, begin: arb, end: arb, delta: arb, y: arb, columns: int = 0
) -> Arrival:
    """The motion from the phase `begin` to the phase `end`, for all states and amplitudes of the given balls.

    Parameters
    ----------
    law, accuracy, gamma : the law, how it is integrated, and the amplitude
    begin, end : phases, rad
    delta, y : state at `begin`
    columns : 0 for no derivative, 2 for that by (δ, Y), 3 for that by γ too

    Raises
    ------
    Refused
        if the order of events is not the same for all of them, or an event grazes
    """
    matrix = arb_mat([[1, 0, 0][:columns], [0, 1, 0][:columns]])
    impacts: list[Impact] = []
    contact = arb(0)
    if delta > 0:
        here = _Contact(delta.sqrt(), y, begin)
    elif delta < 0:
        here = Flight(begin, -delta, -y, gamma)
    else:
        raise Refused("an impact or a separation lies at the section")
    touched = begin
    for pieces in range(1, MAX_PIECES):
        if isinstance(here, Flight):
            lapse = _fly(here, end)
            if lapse is None:
                left = end - here.phase
                return Arrival(-here.gap(left), -here.rate(left), here.carried(matrix, left), impacts, contact, pieces)
            # Positive: the gap falls where it has its root.
            speed = -here.rate(lapse)
            matrix = here.carried(matrix, lapse)
            touched = here.phase + lapse
            impacts.append(Impact(touched, speed))
            here = _Contact(arb(0), speed, touched)
            continue
        made = taylor.step(law, gamma, here, columns, accuracy.order, accuracy.tolerance)
        s, event = _press(law, made, here, end)
        matrix = made.carried(matrix, s)
        here = _Contact(*(made.value(i, s) for i in (taylor.W, taylor.Y, taylor.PHASE)))
        if event == "end":
            return Arrival(here.w * here.w, here.y, matrix, impacts, contact + end - touched, pieces)
        if event == "separation":
            # At w = 0 is δ' = Y, negative: w falls where it has its root.
            contact += here.phase - touched
            here = Flight(here.phase, arb(0), -here.y, gamma)
    raise Refused(f"not at the end after {MAX_PIECES} steps and flights")


def _fly(flight: Flight, end: arb) -> arb | None:
    """The time to the impact that ends a flight, or None if it reaches the phase `end`; the gap is positive before."""
    left = end - flight.phase
    found = first_root(flight.gap, flight.rate, left.upper(), flight.gap0.is_zero(), "the gap of a flight")
    if found is None:
        return None
    lapse = sharpen(flight.gap, flight.rate, *found)
    if not lapse < left:
        raise Refused("an impact lies at the section")
    return lapse


def _press(law: Law, made: taylor.Step, here: _Contact, end: arb) -> tuple[arb, str]:
    """The s at which a step ends, and why: "separation", "end" (the phase is reached) or "step"; w > 0 before."""

    def w(s: arb) -> arb:
        return made.value(taylor.W, s)

    def slope(s: arb) -> arb:
        return made.speed(law, s) / 2

    def ahead(s: arb) -> arb:
        return end - made.value(taylor.PHASE, s)

    def pace(s: arb) -> arb:
        return -w(s)

    refusal = None
    length = made.length
    for _ in range(SHORTER_STEPS):
        # A shorter step may end where w and the phase have a sign.
        try:
            found = first_root(w, slope, length, here.w.is_zero(), "the penetration of a contact")
            separation = None if found is None else sharpen(w, slope, *found)
            reach = length if separation is None else separation.lower()
            # dφ/ds = w > 0 up to here: the phase is reached at most once.
            arrival = None if ahead(reach) > 0 else _arrival(w, ahead, pace, reach)
        except Refused as refused:
            refusal = refused
            length = middle(length * arb(0.8))
            continue
        if arrival is not None:
            return arrival, "end"
        if separation is None:
            return length, "step"
        if not ahead(separation) > 0:
            raise Refused("a separation lies at the section")
        return separation, "separation"
    raise refusal


def _arrival(w, ahead, pace, reach: arb) -> arb:
    """The s at which a phase is reached before `reach`, exact, up to which w > 0 is proved."""
    if not ahead(reach) < 0:
        raise Refused("the section lies at the end of a step")
    low, high = arb(0), reach
    for _ in range(40):
        centre = middle(between(low, high))
        if ahead(centre) > 0:
            low = centre
        elif ahead(centre) < 0:
            high = centre
        if w(between(low, high)) > 0:
            return sharpen(ahead, pace, low, high)
    raise Refused("grazing: the section is reached while the penetration vanishes")
