"""The Taylor series of a Hertz contact, as generated code without loops.

The recurrences are short loops of varying length, which a processor predicts badly. Written out, they take half the
time or less. This module writes them out.
"""

from .jit import fma  # noqa: F401 (called by the generated code)
from .polynomial import ORDER

# The rows of a contact step, in its order: w, t, v, sine and cosine of the phase, w², w^(2p+1), and the cosine times w.
W, T, V, SINE, COSINE, SQUARE, SPRING, COSINE_W = range(8)
ROWS = 8
# The letters of these rows in the generated code.
LETTERS = {W: "w", T: "t", V: "v", SINE: "s", COSINE: "c", SQUARE: "q", SPRING: "p", COSINE_W: "x"}
# Partial sums of a sum, which the processor computes at the same time.
PARTIAL_SUMS = 3


def total(products: list[tuple[str, str]]) -> str:
    """Source of a sum of products, in up to PARTIAL_SUMS partial sums."""
    sums = []
    for first in range(min(PARTIAL_SUMS, len(products))):
        (a, b), *others = products[first::PARTIAL_SUMS]
        partial = f"{a} * {b}"
        for a, b in others:
            partial = f"fma({a}, {b}, {partial})"
        sums.append(partial)
    return " + ".join(sums)


def product(a: str, b: str, n: int) -> str:
    """Source of Σ_k a_k b_{n-k}. The newest coefficients, a_n and b_n, come last, when the other terms are summed."""
    if n == 0:
        return f"{a}0 * {b}0"
    middle = [(f"{a}{k}", f"{b}{n - k}") for k in range(1, n)]
    return f"fma({a}{n}, {b}0, fma({a}0, {b}{n}, {total(middle) or '0.0'}))"


def square(a: str, n: int) -> str:
    """Source of Σ_k a_k a_{n-k}, each pair once, with the newest coefficient a_n last."""
    if n == 0:
        return f"{a}0 * {a}0"
    pairs = [(f"{a}{k}", f"{a}{n - k}") for k in range(1, (n + 1) // 2)]
    source = f"2.0 * ({total(pairs)})" if pairs else "0.0"
    if n % 2 == 0:
        source = f"fma({a}{n // 2}, {a}{n // 2}, {source})"
    return f"fma(2.0 * {a}0, {a}{n}, {source})"


def hertz_source() -> str:
    """Source of `expand_hertz`, which fills the rows of a step.

    Its arguments are w, v, sine and cosine at s = 0; gravity, a_z, omega, stiffness and damping per mass; the array and
    the first row to fill. contact.py has the equations. Because v w is the derivative of w², the equation for
    v + (d_c/m) w² needs no product of v and w.
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
    for row, letter in LETTERS.items():
        terms = ORDER if row in (SPRING, COSINE_W) else ORDER + 1
        lines += [f"series[at + {row}, {n}] = {letter}{n}" for n in range(terms)]
    return "\n    ".join(lines) + "\n"


# Named after this file, so that numba can cache the machine code.
exec(compile(hertz_source(), __file__, "exec"))
