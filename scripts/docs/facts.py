"""What the pages tell, in words: README, article and site take their numbers from here."""

import math

import numpy as np
import pandas as pd

from claims.about_proofs import stable_motions
from figures.captions import bifurcation, fig10, fig22

VERDICTS = ("reproduced", "reproduced by the paper's method only", "not reproduced")


def listed(texts: list[str]) -> str:
    """Texts in a row, "a, b and c"."""
    return " and ".join(filter(None, [", ".join(texts[:-1]), *texts[-1:]])) or "none"


def short(value: float | None) -> str:
    """A number in four digits; a dash for none."""
    return "–" if value is None or np.isnan(value) else f"{value:.4g}"


def plain(value: float) -> str:
    """A number as short as it can be, "3e-10"."""
    return f"{value:g}".replace("e-0", "e-").replace("e+0", "e")


def power(value: float) -> str:
    """A number in one digit, "3e-10"."""
    return plain(float(f"{value:.0e}"))


def round_up(value: float) -> str:
    """A bound in two digits, "1.3e-9", that is not below the number."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return plain(float(f"{math.ceil(value / unit) * unit:.1e}"))


def margin(value: float, low: float, high: float) -> float:
    """How far a number lies within its accepted interval, in its unit; negative outside, NaN without a number."""
    return float(np.nanmin([value - low, high - value])) if not np.isnan(value) else np.nan


def accepted(low: float, high: float) -> str:
    """An accepted interval in words; NaN is no bound."""
    if np.isnan(low):
        return f"at most {high:.4g}"
    return f"at least {low:.4g}" if np.isnan(high) else f"{low:.4g} to {high:.4g}"


def of_claim(row) -> dict:
    """A claim as the pages tell it: its numbers in words, one for each of its quantities."""
    decides = row.converged if len(row.converged) else row.paper_method
    bounds = [
        tuple(np.nan if bound is None else bound for bound in pair)
        for pair in zip(row.accepted_low, row.accepted_high, strict=True)
    ]
    margins = [margin(value, *pair) for value, pair in zip(decides, bounds, strict=True)]
    numbers = {name: [short(value) for value in getattr(row, name)] for name in ("paper", "paper_method", "converged")}
    # A method that has no say in a claim has a dash for each of its quantities.
    numbers = {name: values or ["–"] * len(row.quantities) for name, values in numbers.items()}
    return {
        "id": row.id,
        "where": row.where,
        "statement": row.statement,
        "verdict": row.verdict,
        "note": "" if pd.isna(row.reason) else row.reason,
        "quantities": list(row.quantities),
        "because": list(row.because),
        "accepted": [accepted(*pair) for pair in bounds],
        "margin": [short(value) for value in margins],
        **numbers,
    }


def of_claims(claims: pd.DataFrame) -> dict[str, dict]:
    """All claims as the pages tell them, by their names."""
    return {row.id: of_claim(row) for row in claims.itertuples()}


def of_verdicts(claims: pd.DataFrame) -> dict[str, str]:
    """How many claims have each verdict, and which."""
    names = {verdict: claims.id[claims.verdict == verdict].tolist() for verdict in VERDICTS}
    reproduced, by_paper, not_reproduced = names.values()
    return {
        "claims": str(len(claims)),
        "reproduced": str(len(reproduced)),
        "by_paper": str(len(by_paper)),
        "not_reproduced": str(len(not_reproduced)),
        "by_paper_names": listed(by_paper),
        "not_reproduced_names": listed(not_reproduced),
    }


def of_proofs(orbits: pd.DataFrame, bifurcations: pd.DataFrame, chaos: pd.DataFrame) -> dict[str, str]:
    """What interval arithmetic proved."""
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
        "chaos_proved": listed([f"{value:g}" for value in chaos.acceleration[chaos.proved]]),
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
    return f"It misses {len(missed)} of its {len(goals)} speed goals: {listed(missed)}."


def of_speed(benchmark: pd.DataFrame) -> dict[str, str]:
    """How fast and how accurate the solver is at its default tolerance, beside the paper's method."""
    default = benchmark[benchmark.chosen == "default"]
    goals = {case: entry["wanted"]["speed"] for case, entry in benchmark.attrs["cases"].items()}
    return {
        "speed_goals": compare_with_goals(default, goals),
        "speed_least": f"{default.speed.min():.0f}",
        "speed_most": f"{default.speed.max():.0f}",
        "tolerance": power(default.tolerance.iloc[0]),
        "worst_error": round_up(np.max(default.error)),
    }


def of_valley(fit: pd.DataFrame) -> dict[str, str]:
    """How well Eq. 13 is determined."""
    paper = fit[fit.fit == "paper"].iloc[0]
    good = fit[(fit.fit == "valley") & (fit.error <= paper.error)]
    return {"valley_low": f"{good.B.min():g}", "valley_high": f"{good.B.max():g}"}


def facts(found: dict[str, pd.DataFrame]) -> dict[str, str]:
    """All facts of the pages by the names that their templates ask for.

    Parameters
    ----------
    found : the tables claims, benchmark, edge, edge_euler, estimate, estimate_euler, spectrum, cascade, certificates,
        certified_bifurcations, certified_chaos and fit
    """
    claims = found["claims"].set_index("id")

    def claim(name: str, column: str, place: int = 0) -> float:
        return claims.loc[name, column][place]

    edges = fig10(converged=found["edge"], euler=found["edge_euler"])
    estimates = fig22(converged=found["estimate"], euler=found["estimate_euler"], spectrum=found["spectrum"])
    chaos = bifurcation(spectrum=found["spectrum"], cascade=found["cascade"], longest_period=0)
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
        **of_verdicts(found["claims"]),
        **of_proofs(found["certificates"], found["certified_bifurcations"], found["certified_chaos"]),
        **of_speed(found["benchmark"]),
        **of_valley(found["fit"]),
    }
