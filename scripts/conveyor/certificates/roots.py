"""The first zero of a function on an interval: interval Newton with a proof that no zero comes before (Moore 1966)."""

from collections.abc import Callable

from flint import arb

from .balls import Refused

# Share of the interval: a search that needs shorter pieces gives up, because the function grazes zero.
SMALLEST = 1e-9
# Newton steps of `sharpen`; a step that reduces the radius by less than this factor is the last one.
ITERATIONS, SHRINKS = 40, 0.9

Function = Callable[[arb], arb]


def bracket_first_root(
    value: Function, slope: Function, end: arb, rises_from_zero: bool, what: str
) -> tuple[arb, arb] | None:
    """Ends of an interval that holds the first zero in (0, end]; None if there is none, by proof.

    Refused where no sign can be proved: the function grazes zero, or the enclosures are too wide.

    Parameters
    ----------
    value, slope : enclosures of the function and of its derivative over a ball of arguments
    end : exact, > 0; the function must have a sign there
    rises_from_zero : whether the function is zero at 0 and rises from there; otherwise it must be positive at 0
    what : names the function in a refusal

    Returns
    -------
    low, high : exact; the function is positive on (0, low], falls on [low, high] and is negative at `high`
    """
    low, length = arb(0), end
    while rises_from_zero:
        # A function that is zero at 0 and has a positive slope up to `length` is positive on (0, length].
        if slope(low.union(length)) > 0:
            low, rises_from_zero = length, False
        length = length / 2
        if length < end * SMALLEST:
            raise Refused(f"grazing: {what} does not rise from zero")
    if low == 0 and not value(low) > 0:
        raise Refused(f"grazing: {what} is not positive at the beginning")
    while low < end:
        high = (low + length).mid()
        if not high < end:
            high = end
        piece = low.union(high)
        slopes = slope(piece)
        if slopes < 0 and value(high) < 0:
            # Positive at `low`, negative at `high`, falling in between: one zero, and it is the first.
            return low, high
        if _is_positive(value, slopes, piece, high):
            low, length = high, 2 * length
            continue
        length = length / 2
        if length < end * SMALLEST:
            raise Refused(f"grazing: no sign of {what} can be proved")
    return None


def _is_positive(value: Function, slopes: arb, piece: arb, high: arb) -> bool:
    """Whether a function that is positive at the lower end of a piece is proved to be positive on all of it."""
    if slopes > 0 or (slopes < 0 and value(high) > 0):
        return True
    # Mean value theorem: f(x) lies in f(c) + f'(piece)(x - c).
    centre = piece.mid()
    return value(centre) + slopes * (piece - centre) > 0


def sharpen(value: Function, slope: Function, low: arb, high: arb) -> arb:
    """Enclose the only zero between `low` and `high`, where the function falls, by interval Newton steps."""
    root = low.union(high)
    for _ in range(ITERATIONS):
        centre = root.mid()
        at_centre = value(centre)
        # Mean value theorem again: 0 = f(c) + f'(·)(root - c).
        narrowed = (centre - at_centre / slope(root)).intersection(root)
        if at_centre > 0:
            narrowed = narrowed.intersection(centre.union(high))
        elif at_centre < 0:
            narrowed = narrowed.intersection(low.union(centre))
        if not narrowed.rad() < SHRINKS * root.rad():
            return narrowed
        root, low, high = narrowed, narrowed.lower(), narrowed.upper()
    return root
