"""Straight-line code for the Taylor series of a Hertz contact.

The recurrences are short loops of varying length, which a processor predicts badly: written out they take less than
half the time. Writing them out is left to this module.
"""

from .jit import fma  # noqa: F401 (called by the generated code)
from .polynomial import ORDER

# Partial sums that do not wait for each other.
LANES = 3


def total(products: list[tuple[str, str]]) -> str:
    """Source of a sum of products, in up to LANES partial sums."""
    sums = []
    for lane in range(min(LANES, len(products))):
        (a, b), *others = products[lane::LANES]
        partial = f"{a} * {b}"
        for a, b in others:
            partial = f"fma({a}, {b}, {partial})"
        sums.append(partial)
    return " + ".join(sums)


def product(a: str, b: str, n: int) -> str:
    """Source of Σ_k a_k b_{n-k}; the newest coefficients, a_n and b_n, last: by then the sum of the others is ready."""
    if n == 0:
        return f"{a}0 * {b}0"
    middle = [(f"{a}{k}", f"{b}{n - k}") for k in range(1, n)]
    return f"fma({a}{n}, {b}0, fma({a}0, {b}{n}, {total(middle) or '0.0'}))"


def square(a: str, n: int) -> str:
    """Source of Σ_k a_k a_{n-k}, each pair once, the newest coefficient a_n last."""
    if n == 0:
        return f"{a}0 * {a}0"
    pairs = [(f"{a}{k}", f"{a}{n - k}") for k in range(1, (n + 1) // 2)]
    source = f"2.0 * ({total(pairs)})" if pairs else "0.0"
    if n % 2 == 0:
        source = f"fma({a}{n // 2}, {a}{n // 2}, {source})"
    return f"fma(2.0 * {a}0, {a}{n}, {source})"


def hertz_source() -> str:
    """Source of `expand_hertz`, which fills the first rows of a step's series.

    It takes the values at s = 0, then gravity, a_z, omega, stiffness and damping per mass, then the array and its first
    row to fill. Equations and rows (w, t, v, sine, cosine, w², w⁴, w cosine) are those of contact.py. With the
    derivative v w of w², d/ds (v + d_c/m w²) needs no product of v and w.
    """
    lines = ["def expand_hertz(w0, v0, s0, c0, gravity, a_z, omega, stiffness, damping, series, at):"]
    lines += ["t0 = 0.0", "q0 = w0 * w0"]
    for n in range(ORDER):
        inverse = 1.0 / (n + 1)
        lines += [
            f"w{n + 1} = v{n} * {0.5 * inverse!r}",
            f"t{n + 1} = w{n} * {inverse!r}",
            f"q{n + 1} = {square('w', n + 1)}",
            f"x{n} = {product('c', 'w', n)}",
            f"sine_w = {product('s', 'w', n)}",
            f"p{n} = {square('q', n)}",
            f"rate = fma(-stiffness, p{n}, fma(a_z, x{n}, gravity * w{n}))",
            f"v{n + 1} = fma(-damping, q{n + 1}, rate * {inverse!r})",
            f"turn = omega * {inverse!r}",
            f"c{n + 1} = -turn * sine_w",
            f"s{n + 1} = turn * x{n}",
        ]
    for row, letter in enumerate("wtvscqpx"):
        terms = ORDER if letter in "px" else ORDER + 1
        lines += [f"series[at + {row}, {n}] = {letter}{n}" for n in range(terms)]
    return "\n    ".join(lines) + "\n"


# Named after this file, so that numba can cache the machine code.
exec(compile(hertz_source(), __file__, "exec"))
