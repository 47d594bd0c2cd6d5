"""The first zero of a function on an interval: that it exists, that it is the only one up to there, and where it is."""

from collections.abc import Callable

from flint import arb

from .balls import Refused, between, middle

# The part of the whole interval below which a search gives up: a function that stays so near zero grazes it.
SMALLEST = 1e-9
# Iterations towards a zero, and what must remain of its ball for another one.
ITERATIONS, SHRINKS = 40, 0.9


def first_root(
    value: Callable[[arb], arb], slope: Callable[[arb], arb], end: arb, from_zero: bool, what: str
) -> tuple[arb, arb] | None:
    """Ends of an interval that holds the first zero in (0, end]; None if there is none, by proof.

    Parameters
    ----------
    value, slope : enclosures of the function and of its derivative over a ball of arguments
    end : exact, > 0; the function must have a sign there
    from_zero : whether the function is zero at 0 and rises from there; else it must be positive at 0
    what : names the function in a refusal

    Returns
    -------
    low, high : exact; the function is positive on (0, low], falls on [low, high] and is negative at `high`

    Raises
    ------
    Refused
        where no sign can be proved: the function grazes zero, or the enclosures are too wide
    """
    here, length = arb(0), end
    while from_zero:
        # A function that is zero at 0 and has a positive slope up to `length` is positive on (0, length].
        if slope(between(here, length)) > 0:
            here, from_zero = length, False
        length = length / 2
        if length < end * SMALLEST:
            raise Refused(f"grazing: {what} does not rise from zero")
    if here == 0 and not value(here) > 0:
        raise Refused(f"grazing: {what} is not positive at the beginning")
    while here < end:
        there = middle(here + length)
        if not there < end:
            there = end
        piece = between(here, there)
        inner = slope(piece)
        if inner > 0:
            # It rises from a positive value.
            here, length = there, 2 * length
            continue
        last = value(there)
        if inner < 0 and last > 0:
            # It falls to a positive value.
            here, length = there, 2 * length
            continue
        if inner < 0 and last < 0:
            # Positive at `here`, negative at `there`, falling in between: one zero, and it is the first.
            return here, there
        centre = middle(piece)
        # Mean value theorem: f(x) lies in f(c) + f'(piece)(x - c).
        if value(centre) + inner * (piece - centre) > 0:
            here, length = there, 2 * length
            continue
        length = length / 2
        if length < end * SMALLEST:
            raise Refused(f"grazing: no sign of {what} can be proved")
    return None


def sharpen(value: Callable[[arb], arb], slope: Callable[[arb], arb], low: arb, high: arb) -> arb:
    """A ball for the only zero between `low` and `high`, where the function falls, by Newton's iteration on balls."""
    root = between(low, high)
    for _ in range(ITERATIONS):
        centre = middle(root)
        here = value(centre)
        # Mean value theorem again: 0 = f(c) + f'(·)(root - c).
        following = (centre - here / slope(root)).intersection(root)
        if here > 0:
            following = following.intersection(between(centre, high))
        elif here < 0:
            following = following.intersection(between(low, centre))
        if not following.rad() < SHRINKS * root.rad():
            return following
        root, low, high = following, following.lower(), following.upper()
    return root
