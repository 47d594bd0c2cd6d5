"""Straight-line code for the Taylor series of a Hertz contact.

The recurrences are short loops of varying length, which a processor predicts badly: written out they take less than
half the time. Writing them out is left to this module.
"""

from .polynomial import ORDER


def total(terms: list[str]) -> str:
    """Source of a sum, in up to four partial sums that do not wait for each other."""
    return " + ".join(f"({' + '.join(terms[lane::4])})" for lane in range(min(4, len(terms))))


def product(a: str, b: str, n: int) -> str:
    """Source of Σ_k a_k b_{n-k}; the newest coefficients, a_n and b_n, last: by then the sum of the others is ready."""
    ends = [f"{a}0 * {b}{n}"] + ([f"{a}{n} * {b}0"] if n else [])
    middle = [f"{a}{k} * {b}{n - k}" for k in range(1, n)]
    return (f"({total(middle)}) + " if middle else "") + f"({' + '.join(ends)})"


def square(a: str, n: int) -> str:
    """Source of Σ_k a_k a_{n-k}, each pair once, the newest coefficient a_n last."""
    if n == 0:
        return f"{a}0 * {a}0"
    pairs = [f"{a}{k} * {a}{n - k}" for k in range(1, (n + 1) // 2)]
    parts = [f"2.0 * ({total(pairs)})"] if pairs else []
    if n % 2 == 0:
        parts.append(f"{a}{n // 2} * {a}{n // 2}")
    middle = f"({' + '.join(parts)}) + " if parts else ""
    return f"{middle}2.0 * {a}0 * {a}{n}"


def hertz_source() -> str:
    """Source of `expand_hertz`, which fills the first rows of a step's series.

    It takes the values at s = 0, then gravity, a_z, omega, stiffness and damping per mass, then the array and its first
    row to fill. Equations and rows (w, t, v, sine, cosine, w², w⁴, w cosine) are those of contact.py. With the
    derivative v w of w², d/ds (v + d_c/m w²) needs no product of v and w.
    """
    lines = ["def expand_hertz(w0, v0, s0, c0, gravity, a_z, omega, stiffness, damping, series, at):"]
    lines += ["t0 = 0.0", "q0 = w0 * w0"]
    for n in range(ORDER):
        lines += [
            f"w{n + 1} = v{n} * {0.5 / (n + 1)!r}",
            f"t{n + 1} = w{n} * {1.0 / (n + 1)!r}",
            f"q{n + 1} = {square('w', n + 1)}",
            f"x{n} = {product('c', 'w', n)}",
            f"sine_w = {product('s', 'w', n)}",
            f"p{n} = {square('q', n)}",
            f"v{n + 1} = (gravity * w{n} + a_z * x{n} - stiffness * p{n}) * {1.0 / (n + 1)!r} - damping * q{n + 1}",
            f"c{n + 1} = -omega * sine_w * {1.0 / (n + 1)!r}",
            f"s{n + 1} = omega * x{n} * {1.0 / (n + 1)!r}",
        ]
    for row, letter in enumerate("wtvscqpx"):
        terms = ORDER if letter in "px" else ORDER + 1
        lines += [f"series[at + {row}, {n}] = {letter}{n}" for n in range(terms)]
    return "\n    ".join(lines) + "\n"


# Compiled under this file's name, so that its machine code is cached with that of the other kernels.
exec(compile(hertz_source(), __file__, "exec"))
