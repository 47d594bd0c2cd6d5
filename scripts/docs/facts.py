"""Facts for the pages: README, article and site take their numbers from here."""

import math

import numpy as np
import pandas as pd

from claims.about_proofs import stable_motions
from claims.finding import format_number
from claims.verdicts import VERDICTS
from figures.captions import bifurcation, fig10, fig22


def join_texts(texts: list[str]) -> str:
    """Texts as a list in a sentence, "a, b and c"."""
    return " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]])) or "none"


def plain(value: float) -> str:
    """A number in up to six digits without leading zeros in the exponent, "3e-10"."""
    return f"{value:g}".replace("e-0", "e-").replace("e+0", "e")


def round_up(value: float) -> str:
    """A number rounded up to two digits, "1.3e-9"."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return plain(float(f"{math.ceil(value / unit) * unit:.1e}"))


def margin(value: float, low: float, high: float) -> float:
    """Distance of a number from the nearest end of its accepted interval; negative outside, NaN for NaN."""
    return float(np.nanmin([value - low, high - value])) if not np.isnan(value) else np.nan


def describe_interval(low: float, high: float) -> str:
    """An accepted interval in words; NaN is no bound."""
    if np.isnan(low):
        return f"at most {high:.4g}"
    return f"at least {low:.4g}" if np.isnan(high) else f"{low:.4g} to {high:.4g}"


def describe_claim(row) -> dict:
    """The fields of a claim in the templates, with one text per quantity."""
    decisive = row.converged if len(row.converged) else row.paper_method
    bounds = [
        tuple(np.nan if bound is None else bound for bound in pair)
        for pair in zip(row.accepted_low, row.accepted_high, strict=True)
    ]
    margins = [margin(value, *pair) for value, pair in zip(decisive, bounds, strict=True)]
    # A claim that does not concern a method has a dash for each quantity.
    numbers = {
        name: [format_number(value) for value in getattr(row, name)] or ["–"] * len(row.quantities)
        for name in ("paper", "paper_method", "converged")
    }
    return {
        "id": row.id,
        "where": row.where,
        "statement": row.statement,
        "verdict": row.verdict,
        "note": "" if pd.isna(row.reason) else row.reason,
        "quantities": list(row.quantities),
        "because": list(row.because),
        "accepted": [describe_interval(*pair) for pair in bounds],
        "margin": [format_number(value) for value in margins],
        **numbers,
    }


def describe_claims(claims: pd.DataFrame) -> dict[str, dict]:
    """The fields of all claims, by name."""
    return {row.id: describe_claim(row) for row in claims.itertuples()}


def describe_verdicts(claims: pd.DataFrame) -> dict[str, str]:
    """The number of claims with each verdict, and their names."""
    names = {verdict: claims.id[claims.verdict == verdict].tolist() for verdict in VERDICTS}
    reproduced, by_paper, not_reproduced = names.values()
    return {
        "claims": str(len(claims)),
        "reproduced": str(len(reproduced)),
        "by_paper": str(len(by_paper)),
        "not_reproduced": str(len(not_reproduced)),
        "by_paper_names": join_texts(by_paper),
        "not_reproduced_names": join_texts(not_reproduced),
    }


def describe_proofs(orbits: pd.DataFrame, bifurcations: pd.DataFrame, chaos: pd.DataFrame) -> dict[str, str]:
    """Numbers of proved orbits and bifurcations, and where two stable motions and chaos are proved."""
    fold = bifurcations[(bifurcations.kind == "fold") & bifurcations.proved]
    counts = stable_motions(orbits)
    both = counts.index[counts >= 2]
    return {
        "fold": f"{fold.acceleration_low.min():.1f}",
        "orbits_tried": str(len(orbits)),
        "orbits_proved": str(int(orbits.contained.sum())),
        "doublings_proved": str(int(((bifurcations.kind == "period_doubling") & bifurcations.proved).sum())),
        "both_stable": str(len(both)),
        "both_stable_from": f"{both.min():g}",
        "both_stable_to": f"{both.max():g}",
        "chaos_proved": join_texts([f"{value:g}" for value in chaos.acceleration[chaos.proved]]),
    }


def compare_with_goals(default: pd.DataFrame, goals: dict[str, float]) -> str:
    """A sentence on the cases whose speed at the default tolerance misses its goal."""
    missed = [
        f"case {row.case} ({row.motion}) reached {row.speed:.0f}× (goal {goals[row.case]:g}×)"
        for row in default.itertuples()
        if row.speed < goals[row.case]
    ]
    if not missed:
        return f"It reaches all {len(goals)} speed goals."
    return f"It misses {len(missed)} of its {len(goals)} speed goals: {join_texts(missed)}."


def describe_speed(benchmark: pd.DataFrame) -> dict[str, str]:
    """Speed and accuracy of the solver at its default tolerance, compared with the paper's method."""
    default = benchmark[benchmark.chosen == "default"]
    goals = {case: entry["wanted"]["speed"] for case, entry in benchmark.attrs["cases"].items()}
    return {
        "speed_goals": compare_with_goals(default, goals),
        "speed_least": f"{default.speed.min():.0f}",
        "speed_most": f"{default.speed.max():.0f}",
        "tolerance": plain(default.tolerance.iloc[0]),
        "worst_error": round_up(np.max(default.error)),
    }


def describe_valley(fit: pd.DataFrame) -> dict[str, str]:
    """The range of B (m/s²) in which Eq. 13 fits no worse than with the paper's parameters."""
    paper = fit[fit.fit == "paper"].iloc[0]
    good = fit[(fit.fit == "valley") & (fit.error <= paper.error)]
    return {"valley_low": f"{good.B.min():g}", "valley_high": f"{good.B.max():g}"}


def collect_facts(tables: dict[str, pd.DataFrame]) -> dict[str, str]:
    """All facts of the pages, by the names that templates use.

    Parameters
    ----------
    tables : claims, benchmark, edge, edge_euler, estimate, estimate_euler, spectrum, cascade, certificates,
        certified_bifurcations, certified_chaos and fit
    """
    claims = tables["claims"].set_index("id")

    def claim(name: str, column: str, place: int = 0) -> float:
        return claims.loc[name, column][place]

    edges = fig10(converged=tables["edge"], euler=tables["edge_euler"])
    estimates = fig22(converged=tables["estimate"], euler=tables["estimate_euler"], spectrum=tables["spectrum"])
    chaos = bifurcation(spectrum=tables["spectrum"], cascade=tables["cascade"], longest_period=0)
    return {
        "euler_positive": f"{claim('C19', 'paper_method'):g}",
        "converged_positive": f"{claim('C19', 'converged'):g}",
        "scatter": f"{claim('C03', 'converged'):g}",
        "first_error": f"{100.0 * claim('C22', 'paper_method', 0):.1f}",
        "second_error": f"{100.0 * claim('C22', 'paper_method', 1):.1f}",
        "wrong_signs": f"{100.0 * (1.0 - claim('C22', 'paper_method', 2)):.0f}",
        "heights_aside": edges["aside"],
        "paper_two_states_from": f"{claim('C02', 'paper', 0):g}",
        "paper_two_states_to": f"{claim('C02', 'paper', 1):g}",
        **{name: chaos[name] for name in ("accumulation", "early_up", "early_down", "regular_share")},
        **{name: estimates[name] for name in ("plateau", "truth", "epsilon")},
        **describe_verdicts(tables["claims"]),
        **describe_proofs(tables["certificates"], tables["certified_bifurcations"], tables["certified_chaos"]),
        **describe_speed(tables["benchmark"]),
        **describe_valley(tables["fit"]),
    }
