"""Balls: exact decimals, outward rounding, and the refusal of a proof."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

from flint import arb, ctx, fmpq


class Refused(ArithmeticError):
    """A statement that could not be proved; its text says why."""


@contextmanager
def precision(bits: int, order: int) -> Iterator[None]:
    """Arithmetic of `bits` bits and series up to `order` within this context."""
    cap = ctx.cap
    ctx.cap = order + 1
    try:
        with ctx.workprec(bits):
            yield
    finally:
        ctx.cap = cap


def exactly(value: float) -> arb:
    """The decimal that is written for a float (its shortest one), as a ball."""
    fraction = Fraction(repr(float(value)))
    return arb(fmpq(fraction.numerator, fraction.denominator))


def bounds(ball: arb) -> tuple[float, float]:
    """The ends of a ball as floats, rounded outwards."""
    low, high = ball.lower(), ball.upper()
    below, above = float(low), float(high)
    # float() rounds to nearest; one step outwards makes up for it.
    while not arb(below) <= low:
        below = math.nextafter(below, -math.inf)
    while not arb(above) >= high:
        above = math.nextafter(above, math.inf)
    return below, above
