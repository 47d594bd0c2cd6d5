"""The motion from one phase of the excitation to another: flights and contacts with proved events, and the derivative.

A state is (δ, Y) at a known phase (see law). Its derivative by an earlier state is a product of matrices, one for each
flight and for each step of a contact. An impact or a separation adds no matrix, because the rates of δ and Y are
continuous there, as long as its speed is not zero. The speed is not zero, because the proof of each root of the gap or
of w includes a proof that the function falls there.
"""

from typing import NamedTuple

from flint import arb, arb_mat

from .balls import Refused
from .flight import Flight
from .law import System
from .roots import bracket_first_root, sharpen
from .taylor import PHASE, Step, W, Y, make_step

# Flights and steps after which a motion is given up.
MAX_PIECES = 2000
# Bisections in the search for the end of a motion.
BISECTIONS = 40


class Impact(NamedTuple):
    """An impact: the phase and the speed of approach."""

    phase: arb
    speed: arb


class Arrival(NamedTuple):
    """The state at the end of a motion, and its impacts and contacts."""

    delta: arb
    y: arb
    matrix: arb_mat  # derivative of (δ, Y) by the initial state, a third column by γ; no columns if not wanted
    impacts: list[Impact]
    contact: arb  # phase spent in contact


class _Contact(NamedTuple):
    """A state in contact, or at its beginning (w = 0)."""

    w: arb
    y: arb
    phase: arb


def follow(system: System, begin: arb, end: arb, delta: arb, y: arb, columns: int = 0) -> Arrival:
    """The motion from the phase `begin` to the phase `end`, for all states and amplitudes of the given balls.

    Refused if the order of events is not the same for all states and amplitudes, or an event grazes.

    Parameters
    ----------
    system : the motion at an amplitude, and the accuracy of its steps
    begin, end : phases, rad
    delta, y : state at `begin`
    columns : 0 for no derivative, 2 for the derivative by (δ, Y), 3 for the derivative by γ too
    """
    matrix = arb_mat([[1, 0, 0][:columns], [0, 1, 0][:columns]])
    impacts: list[Impact] = []
    contact, touched = arb(0), begin
    if delta > 0:
        piece = _Contact(delta.sqrt(), y, begin)
    elif delta < 0:
        piece = Flight(begin, -delta, -y, system.gamma)
    else:
        raise Refused("an impact or a separation lies at the section")
    for _ in range(MAX_PIECES):
        if isinstance(piece, Flight):
            lapse = _find_impact(piece, end)
            if lapse is None:
                remaining = end - piece.phase
                return Arrival(
                    -piece.gap(remaining), -piece.rate(remaining), piece.carry(matrix, remaining), impacts, contact
                )
            matrix = piece.carry(matrix, lapse)
            touched = piece.phase + lapse
            # The speed is positive: the gap falls where it has its root.
            impacts.append(Impact(touched, -piece.rate(lapse)))
            piece = _Contact(arb(0), impacts[-1].speed, touched)
            continue
        step = make_step(system, piece, columns)
        s, event = _find_end(system, step, piece, end)
        matrix = step.carry(matrix, s)
        piece = _Contact(*(step.value(component, s) for component in (W, Y, PHASE)))
        if event == "end":
            return Arrival(piece.w * piece.w, piece.y, matrix, impacts, contact + end - touched)
        if event == "separation":
            contact += piece.phase - touched
            # At w = 0 is δ' = Y, negative: w falls where it has its root.
            piece = Flight(piece.phase, arb(0), -piece.y, system.gamma)
    raise Refused(f"the motion does not reach its end within {MAX_PIECES} steps and flights")


def _find_impact(flight: Flight, end: arb) -> arb | None:
    """The time to the impact that ends a flight, or None if it reaches the phase `end`; the gap is positive before."""
    remaining = end - flight.phase
    bracket = bracket_first_root(
        flight.gap, flight.rate, remaining.upper(), flight.gap0.is_zero(), "the gap of a flight"
    )
    if bracket is None:
        return None
    lapse = sharpen(flight.gap, flight.rate, *bracket)
    if not lapse < remaining:
        raise Refused("an impact lies at the section")
    return lapse


def _find_end(system: System, step: Step, contact: _Contact, end: arb) -> tuple[arb, str]:
    """The s at which a step ends, and why: "separation", "end" (the phase is reached) or "step"; w > 0 before."""

    def w(s: arb) -> arb:
        return step.value(W, s)

    def slope(s: arb) -> arb:
        # w' = v/2 with v = Y - β w².
        value = w(s)
        return (step.value(Y, s) - system.law.beta * value * value) / 2

    def remaining(s: arb) -> arb:
        return end - step.value(PHASE, s)

    bracket = bracket_first_root(w, slope, step.length, contact.w.is_zero(), "the penetration of a contact")
    separation = None if bracket is None else sharpen(w, slope, *bracket)
    reach = step.length if separation is None else separation.lower()
    # dφ/ds = w > 0 up to here: the phase is reached at most once.
    if not remaining(reach) > 0:
        return _find_arrival(w, remaining, reach), "end"
    if separation is None:
        return step.length, "step"
    if not remaining(separation) > 0:
        raise Refused("a separation lies at the section")
    return separation, "separation"


def _find_arrival(w, remaining, reach: arb) -> arb:
    """The s below `reach` at which the end of the motion is reached; `reach` is exact, and w > 0 is proved up to it."""
    if not remaining(reach) < 0:
        raise Refused("the section lies at the end of a step")
    low, high = arb(0), reach
    for _ in range(BISECTIONS):
        centre = low.union(high).mid()
        if remaining(centre) > 0:
            low = centre
        elif remaining(centre) < 0:
            high = centre
        if w(low.union(high)) > 0:
            return sharpen(remaining, lambda s: -w(s), low, high)
    raise Refused("grazing: the section is reached while the penetration vanishes")
