"""Balls: conversions from and to floats, and the exception for a statement that cannot be proved."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

from flint import arb, ctx, fmpq


class Refused(ArithmeticError):
    """A statement that could not be proved; its text says why."""


@contextmanager
def precision(bits: int, order: int) -> Iterator[None]:
    """A context with a working precision of `bits` bits and power series up to `order`."""
    cap = ctx.cap
    ctx.cap = order + 1
    try:
        with ctx.workprec(bits):
            yield
    finally:
        ctx.cap = cap


def exactly(value: float) -> arb:
    """The shortest decimal number that stands for a float, as a ball."""
    fraction = Fraction(repr(float(value)))
    return arb(fmpq(fraction.numerator, fraction.denominator))


def bounds(ball: arb) -> tuple[float, float]:
    """The ends of a ball as floats, rounded outwards."""
    low, high = ball.lower(), ball.upper()
    below, above = float(low), float(high)
    # float() rounds to the nearest number, which may lie inside the ball.
    while not arb(below) <= low:
        below = math.nextafter(below, -math.inf)
    while not arb(above) >= high:
        above = math.nextafter(above, math.inf)
    return below, above
