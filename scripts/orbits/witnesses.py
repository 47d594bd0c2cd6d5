"""Three criteria of chaos on each attractor: Lyapunov exponent, 0-1 test and period, and reasons for disagreement."""

import numpy as np
import pandas as pd

from conveyor import MAX_PERIOD, for_each_chunk, strobes, zero_one
from orbits.attractor_states import parameters_on_attractors
from pipeline import fields

TABLES = {
    "witnesses": (
        fields.ORBIT[1],
        fields.text("branch", "up or down, as in the table of strobes"),
        fields.number("lambda_1", "1/s", "larger vertical Lyapunov exponent"),
        fields.number("stderr", "1/s", "standard error of lambda_1"),
        fields.number("zero_one", "1", "K of the 0-1 test: 0 for regular, 1 for chaotic motion"),
        *fields.STATE,
        fields.flag("by_exponent", "whether the motion is chaotic by its exponent"),
        fields.flag("by_zero_one", "whether the motion is chaotic by the 0-1 test"),
        fields.flag("by_period", "whether the motion has no period"),
        fields.flag("agree", "whether the three criteria agree"),
        fields.text("reason", "reason of a disagreement; null if they agree"),
    ),
}

STROBES = 2000  # samples of the 0-1 test
SEED = 1  # of its frequencies
SIGNIFICANT = 3.0  # standard errors from zero of an exponent whose sign is certain
RESOLUTION = 1e-9  # m/s: strobes that vary by less are constant


def zero_one_values(parameters: np.ndarray, settings: dict, *, threads: int, progress: str | None) -> np.ndarray:
    """K of the 0-1 test on the speed of approach at the strobes, shape (n,)."""
    indicators = np.empty(len(parameters))

    def work(begin, end):
        for i in range(begin, end):
            speeds = strobes(parameters[i], STROBES, settings["tolerance"])[:, 1]
            indicators[i] = zero_one(speeds, SEED, RESOLUTION)

    for_each_chunk(work, len(parameters), threads=threads, chunk=8, progress=progress)
    return indicators


def reason(row: pd.Series) -> str | None:
    """The reason why the criteria disagree, in words; None if they agree."""
    if row.agree:
        return None
    reasons = []
    if abs(row.lambda_1) <= SIGNIFICANT * row.stderr:
        reasons.append(
            f"λ1 = {row.lambda_1:.3g} ± {row.stderr:.2g} 1/s does not differ significantly from 0, near a bifurcation"
        )
    if 0.1 < row.zero_one < 0.9:
        reasons.append(f"the 0-1 test is undecided, K = {row.zero_one:.2f}")
    if row.period == 0 and row.lambda_1 < 0.0:
        reasons.append(
            f"λ1 = {row.lambda_1:.3g} 1/s, but no period up to {MAX_PERIOD}: a longer period, or not settled"
        )
    if row.period > 0 and row.lambda_1 > 0.0:
        reasons.append(f"λ1 = {row.lambda_1:.3g} 1/s along a transient that ends in period {row.period}")
    return (
        "; ".join(reasons)
        or f"λ1 = {row.lambda_1:.3g} ± {row.stderr:.2g} 1/s, K = {row.zero_one:.2f}, period {row.period}"
    )


def make(
    strobes: pd.DataFrame, spectrum: pd.DataFrame, settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of the table of witnesses from the tables of strobes and of Lyapunov spectra."""
    last, parameters = parameters_on_attractors(strobes, settings)
    rows = last[["acceleration", "branch", "period", "state"]].merge(spectrum, on=["branch", "acceleration"])
    rows["zero_one"] = zero_one_values(parameters, settings, threads=threads, progress=progress)
    rows["by_exponent"] = rows.lambda_1 > SIGNIFICANT * rows.stderr
    rows["by_zero_one"] = rows.zero_one > 0.5
    rows["by_period"] = rows.period == 0
    rows["agree"] = (rows.by_exponent == rows.by_zero_one) & (rows.by_exponent == rows.by_period)
    rows["reason"] = [reason(row) for _, row in rows.iterrows()]
    return {column.name: rows[column.name].to_numpy() for column in TABLES["witnesses"]}
