"""Source of sums of products, written out, for the generated recurrences of contact_law.

The sums of the Taylor recurrences are short loops of varying length, which a processor predicts badly. Written out,
an expansion takes 0.13 µs; with loops it takes 0.26 µs for p = 1 and 0.37 µs for p = 3/2. The runs of the benchmark
would take 1.3 to 1.8 times as long with loops, and lanes could not follow contacts.
"""

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
