"""The page on the parameters that the paper's numbers imply."""

import math

import numpy as np
import pandas as pd

from claims.finding import format_interval
from identification import findings
from identification.misfits import OBJECTIVES
from identification.printed import CONVERGED, EULER
from identification.search_space import PARAMETERS
from pipeline.templates import render

# Names of the sets of evidence.
EVIDENCE = {
    "all": "all numbers",
    "end_left_out": "without the upper end of Fig. 8",
    "paper_method": "without this end, with the error of the paper's method",
}
UNITS = {
    "friction": (1.0, "friction μ", "", 3),
    "damping": (1.0, "damping", "N s/m", 3),
    "stiffness": (1e-5, "stiffness", "10⁵ N/m^1.5", 2),
    "angle": (180.0 / math.pi, "angle of throw", "°", 2),
}


def format_value(parameter: str, value: float) -> str:
    """A parameter's value in the unit of the page."""
    scale, _, _, digits = UNITS[parameter]
    return f"{scale * value:.{digits}f}"


def format_end(parameter: str, end: findings.End | None) -> str:
    """An end of an interval, with a star if another parameter is at a bound of the search there."""
    return "open" if end is None else format_value(parameter, end.value) + ("\\*" if end.held else "")


def name_with_unit(parameter: str) -> str:
    """The name of a parameter with the unit of the page."""
    _, name, unit, _ = UNITS[parameter]
    return f"{name} in {unit}" if unit else name


def number_rows(printed: pd.DataFrame, implied: pd.DataFrame) -> list[list[str]]:
    """The cells of each number: the paper's, by both methods at the printed parameters, and at the best parameters."""
    at = printed[printed["set"] == "printed"]
    columns = [at[at.method == method] for method in (EULER, CONVERGED)]
    columns += [implied[implied["set"] == name] for name in implied["set"].unique()]
    rows = []
    for name, *sets in zip(at.number.unique(), *(one.itertuples(name=None) for one in columns), strict=True):
        cells = [pd.Series(values[1:], index=at.columns) for values in sets]
        first = cells[0]
        accepted = format_interval(first.low, first.high)
        measured = [f"{cell.value:.4g} ({cell.misfit:+.2f})" for cell in cells]
        rows.append([name, first["is"], f"{first.paper:.6g}", accepted, *measured])
    return rows


def friction_rows(printed: pd.DataFrame) -> list[list[str]]:
    """The cells of each variant of friction: velocities, and the largest change of all remaining numbers."""
    converged = printed[printed.method == CONVERGED]
    base = converged[converged["set"] == "printed"].set_index("number").value
    rows = []
    for _, variant in converged.groupby("set", sort=False):
        values = variant.set_index("number").value
        rest = values.drop(list(findings.VELOCITIES.values()))
        velocities = [f"{values[name]:.2f}" for name in findings.VELOCITIES.values()]
        rows.append([f"{variant.friction.iloc[0]:g}", *velocities, f"{np.abs(rest - base[rest.index]).max():g}"])
    return rows


def interval_rows(profiles: pd.DataFrame, optima: pd.DataFrame, model: dict) -> list[list[str]]:
    """Best values and intervals for each set of evidence, and whether the intervals contain the printed values."""
    rows = [["printed", *(format_value(name, model[name]) for name in PARAMETERS)]]
    for evidence, fits in optima.groupby("evidence", sort=False):
        best = fits.loc[fits.total.idxmin()]
        cells = []
        for name, (low, high) in findings.intervals(profiles, optima, evidence).items():
            inside = (low is None or low.value <= model[name]) and (high is None or model[name] <= high.value)
            verdict = "contains" if inside else "**excludes**"
            interval = f"{format_end(name, low)} to {format_end(name, high)}"
            cells.append(f"{format_value(name, best[name])} ({interval}; {verdict} the printed value)")
        rows.append([EVIDENCE[evidence], *cells])
    return rows


def describe_bounds(profiles: pd.DataFrame, optima: pd.DataFrame, evidence: str) -> str:
    """The parameters that the evidence bounds on both sides, on one side and on no side, in words.

    A bound counts only if no other parameter is at a bound of the search there.
    """
    kinds = ("bounded on both sides", "bounded on one side", "not identifiable")
    found = {kind: [] for kind in kinds}
    for name, ends in findings.intervals(profiles, optima, evidence).items():
        found[kinds[sum(end is None or end.held for end in ends)]].append(UNITS[name][1])
    return "; ".join(f"{', '.join(names)} ({kind})" for kind, names in found.items() if names)


def total_rows(optima: pd.DataFrame) -> list[list[str]]:
    """The cells of the least total misfit of each set of evidence and tension mode, and of the printed parameters."""
    return [
        [
            f"{EVIDENCE[row.evidence]} ({row.numbers})",
            row.tension,
            f"{row.total:.2f}",
            *(format_value(name, getattr(row, name)) for name in PARAMETERS),
            f"{row.printed_total:.2f}",
            row.status,
        ]
        for row in optima.itertuples()
    ]


def front_rows(front: pd.DataFrame) -> list[list[str]]:
    """The cells of each tension mode: the least value of each objective on its front, and the number of members."""
    return [
        [tension, *(f"{members[name].min():.2f}" for name in OBJECTIVES), str(len(members))]
        for tension, members in front.groupby("tension", sort=False)
    ]


def describe_printed(optima: pd.DataFrame, tension: str) -> str:
    """Whether all printed parameters together lie in the confidence region of each set of evidence, in words."""
    parts = []
    for evidence, rows in optima.groupby("evidence", sort=False):
        one = rows[rows.tension == tension].iloc[0]
        rise = one.printed_total - rows.total.min()
        verdict = "inside" if rise <= one.rise_of_all else "outside"
        limit = f"the total rises by {rise:.1f}; the limit is {one.rise_of_all:.1f}"
        parts.append(f"{EVIDENCE[evidence]}: {verdict} the confidence region ({limit})")
    return "; ".join(parts)


def interpolation_errors(implied: pd.DataFrame) -> np.ndarray:
    """Changes of the numbers by interpolation of the edges, in half accepted intervals, shape (n,)."""
    rows = implied.dropna(subset="interpolated")
    half = 0.5 * (rows.high - rows.low)
    # A mean squared error has no lower bound; its root is compared.
    change = np.where(
        rows.low.isna(),
        np.sqrt(rows.value / rows.high) - np.sqrt(rows.interpolated / rows.high),
        (rows.value - rows.interpolated) / half,
    )
    return np.abs(change)


def values(tables: dict[str, pd.DataFrame]) -> dict[str, object]:
    """The fields of the template, from the tables of the stage by name."""
    printed, implied, front, optima = (tables[name] for name in ("printed", "implied", "front", "optima"))
    profiles, settings = tables["profiles"], tables["profiles"].attrs
    numbers, model, triple = settings["numbers"], settings["model"], settings["measured"]["triple"]
    without = optima[optima.evidence == "end_left_out"].set_index("tension")
    difference = abs(without.total["clip"] - without.total["allow"])
    errors = interpolation_errors(implied)
    return {
        "coarse": findings.is_coarse(settings),
        "sets": [EVIDENCE[name] for name in implied["set"].unique()],
        "numbers": number_rows(printed, implied),
        "parameters": [name_with_unit(name) for name in PARAMETERS],
        "contacts": settings["contacts"]["loss"] * settings["contacts"]["stiffness"],
        "interpolation_median": f"{np.median(errors):.3f}",
        "interpolation_most": f"{errors.max():.2f}",
        "up": f"{numbers[findings.UP_ALONE]['paper']:g}",
        "down": f"{numbers[findings.DOWN_ALONE]['paper']:g}",
        "widening": f"{findings.contradiction(numbers):.3g}",
        "zero": f"{-triple['A'] / triple['C'] - triple['B']:.2f}",
        "frictions": friction_rows(printed),
        "friction_alone": findings.describe_frictions(tables["frictions"], numbers),
        "seeds": len(settings["search"]["seeds"]),
        "search": findings.describe_search(front, tables["generations"]),
        "fronts": front_rows(front),
        "totals": total_rows(optima),
        "confidence": f"{100.0 * settings['profiles']['confidence']:g}",
        "factor": f"{math.sqrt(optima[optima.evidence == 'all'].scale.iloc[0]):.2f}",
        "intervals": interval_rows(profiles, optima, model),
        "bounded_all": describe_bounds(profiles, optima, "all"),
        "bounded_without": describe_bounds(profiles, optima, "end_left_out"),
        "bounded_method": describe_bounds(profiles, optima, "paper_method"),
        "treatment": "not identifiable" if difference <= without.rise.iloc[0] else "identifiable",
        "pulls": f"{without.total['allow']:.2f}",
        "clipped": f"{without.total['clip']:.2f}",
        "pulls_printed": f"{without.printed_total['allow']:.1f}",
        "clipped_printed": f"{without.printed_total['clip']:.1f}",
        "tension": model["tension"],
        "whole": describe_printed(optima, model["tension"]),
    }


def make(template: str, **tables: pd.DataFrame) -> str:
    """The page from its template and the tables of the stage identification."""
    return render(template, values(tables))
