"""The numbers of the page on the parameters that the paper's numbers imply."""

import math

import numpy as np
import pandas as pd

from identification import findings
from identification.misfits import OBJECTIVES
from identification.printed import CONVERGED, EULER
from identification.search_space import PARAMETERS
from pipeline.templates import render

IN_WORDS = {
    "all": "all numbers",
    "end_left_out": "without the upper end of Fig. 8",
    "paper_method": "without it, with the paper's method",
}
UNITS = {
    "friction": (1.0, "friction μ", "", 3),
    "damping": (1.0, "damping", "N s/m", 3),
    "stiffness": (1e-5, "stiffness", "10⁵ N/m^1.5", 2),
    "angle": (180.0 / math.pi, "angle of throw", "°", 2),
}


def told(parameter: str, value: float) -> str:
    """A parameter's value in the unit of the page."""
    scale, _, _, digits = UNITS[parameter]
    return f"{scale * value:.{digits}f}"


def told_end(parameter: str, end: findings.End | None) -> str:
    """An end of an interval, with a star where another parameter is at the end of what is searched."""
    return "open" if end is None else told(parameter, end.value) + ("\\*" if end.held else "")


def named(parameter: str) -> str:
    _, name, unit, _ = UNITS[parameter]
    return f"{name} in {unit}" if unit else name


def number_rows(printed: pd.DataFrame, implied: pd.DataFrame) -> list[list[str]]:
    """Each number: the paper's, those at the printed parameters by both methods, those at the best ones."""
    at = printed[printed["set"] == "printed"]
    columns = [at[at.method == method] for method in (EULER, CONVERGED)]
    columns += [implied[implied["set"] == name] for name in implied["set"].unique()]
    rows = []
    for name, *of_sets in zip(at.number.unique(), *(one.itertuples(name=None) for one in columns), strict=True):
        cells = [pd.Series(values[1:], index=at.columns) for values in of_sets]
        one = cells[0]
        accepted = written_interval(one.low, one.high)
        measured = [f"{cell.value:.4g} ({cell.misfit:+.2f})" for cell in cells]
        rows.append([name, one["is"], f"{one.paper:.6g}", accepted, *measured])
    return rows


def written_interval(low: float, high: float) -> str:
    return f"[{'-∞' if math.isnan(low) else f'{low:.8g}'}, {high:.8g}]"


def friction_rows(printed: pd.DataFrame) -> list[list[str]]:
    """Velocities at the frictions that are told, all else as printed."""
    converged = printed[printed.method == CONVERGED]
    base = converged[converged["set"] == "printed"].set_index("number").value
    rows = []
    for _, of_set in converged.groupby("set", sort=False):
        values = of_set.set_index("number").value
        rest = values.drop(list(findings.VELOCITIES.values()))
        velocities = [f"{values[name]:.2f}" for name in findings.VELOCITIES.values()]
        rows.append([f"{of_set.friction.iloc[0]:g}", *velocities, f"{np.abs(rest - base[rest.index]).max():g}"])
    return rows


def interval_rows(profiles: pd.DataFrame, optima: pd.DataFrame, model: dict) -> list[list[str]]:
    """Best values and intervals for each set of evidence, and whether the printed value lies in it."""
    rows = [["printed", *(told(name, model[name]) for name in PARAMETERS)]]
    for evidence, of_set in optima.groupby("evidence", sort=False):
        best = of_set.loc[of_set.total.idxmin()]
        cells = []
        for name, (low, high) in findings.intervals(profiles, optima, evidence).items():
            inside = (low is None or low.value <= model[name]) and (high is None or model[name] <= high.value)
            verdict = "with" if inside else "**without**"
            cells.append(
                f"{told(name, best[name])}; {told_end(name, low)} to {told_end(name, high)}, {verdict} the printed one"
            )
        rows.append([IN_WORDS[evidence], *cells])
    return rows


def bounded(profiles: pd.DataFrame, optima: pd.DataFrame, evidence: str) -> str:
    """Which parameters the evidence bounds on both sides, on one, on none, whatever the bounds of the others."""
    kinds = ("bounded on both sides", "bounded on one side", "not identifiable")
    found = {kind: [] for kind in kinds}
    for name, ends in findings.intervals(profiles, optima, evidence).items():
        found[kinds[sum(end is None or end.held for end in ends)]].append(UNITS[name][1])
    return "; ".join(f"{kind}: {', '.join(names)}" for kind, names in found.items() if names)


def total_rows(optima: pd.DataFrame) -> list[list[str]]:
    """Least totals by evidence and reading, and those of the printed parameters."""
    return [
        [
            f"{IN_WORDS[row.evidence]} ({row.numbers})",
            row.tension,
            f"{row.total:.2f}",
            *(told(name, getattr(row, name)) for name in PARAMETERS),
            f"{row.printed_total:.2f}",
            row.status,
        ]
        for row in optima.itertuples()
    ]


def front_rows(front: pd.DataFrame) -> list[list[str]]:
    """The least of each objective on the fronts."""
    return [
        [reading, *(f"{of_reading[name].min():.2f}" for name in OBJECTIVES), str(len(of_reading))]
        for reading, of_reading in front.groupby("tension", sort=False)
    ]


def printed_as_a_whole(optima: pd.DataFrame, reading: str) -> str:
    """Whether all printed parameters together lie in the region of each set of evidence."""
    parts = []
    for evidence, rows in optima.groupby("evidence", sort=False):
        one = rows[rows.tension == reading].iloc[0]
        rise = one.printed_total - rows.total.min()
        verdict = "inside the region" if rise <= one.rise_of_all else "outside the region"
        parts.append(f"{IN_WORDS[evidence]}: {verdict} (a rise of {rise:.1f}, allowed are {one.rise_of_all:.1f})")
    return "; ".join(parts)


def of_interpolation(implied: pd.DataFrame) -> np.ndarray:
    """By how many half intervals interpolated edges move numbers, shape (n,)."""
    rows = implied.dropna(subset="interpolated")
    half = 0.5 * (rows.high - rows.low)
    # A mean squared error has no lower bound, and counts by its root.
    moved = np.where(
        rows.low.isna(),
        np.sqrt(rows.value / rows.high) - np.sqrt(rows.interpolated / rows.high),
        (rows.value - rows.interpolated) / half,
    )
    return np.abs(moved)


def values(tables: dict[str, pd.DataFrame]) -> dict[str, object]:
    """All that the template asks for, from the tables of the stage by their names."""
    printed, implied, front, optima = (tables[name] for name in ("printed", "implied", "front", "optima"))
    profiles, settings = tables["profiles"], tables["profiles"].attrs
    numbers, model, triple = settings["numbers"], settings["model"], settings["measured"]["triple"]
    without = optima[optima.evidence == "end_left_out"].set_index("tension")
    apart = abs(without.total["clip"] - without.total["allow"])
    moved = of_interpolation(implied)
    return {
        "coarse": findings.coarse(settings),
        "sets": [IN_WORDS[name] for name in implied["set"].unique()],
        "numbers": number_rows(printed, implied),
        "parameters": [named(name) for name in PARAMETERS],
        "contacts": settings["contacts"]["loss"] * settings["contacts"]["stiffness"],
        "interpolation_median": f"{np.median(moved):.3f}",
        "interpolation_most": f"{moved.max():.2f}",
        "up": f"{numbers[findings.UP_ALONE]['paper']:g}",
        "down": f"{numbers[findings.DOWN_ALONE]['paper']:g}",
        "widening": f"{findings.contradiction(numbers):.3g}",
        "zero": f"{-triple['A'] / triple['C'] - triple['B']:.2f}",
        "frictions": friction_rows(printed),
        "friction_alone": findings.friction_alone(tables["frictions"], numbers),
        "seeds": len(settings["search"]["seeds"]),
        "search": findings.search(front, tables["generations"]),
        "fronts": front_rows(front),
        "totals": total_rows(optima),
        "confidence": f"{100.0 * settings['profiles']['confidence']:g}",
        "factor": f"{math.sqrt(optima[optima.evidence == 'all'].scale.iloc[0]):.2f}",
        "intervals": interval_rows(profiles, optima, model),
        "bounded_all": bounded(profiles, optima, "all"),
        "bounded_without": bounded(profiles, optima, "end_left_out"),
        "bounded_method": bounded(profiles, optima, "paper_method"),
        "reading": "not identifiable" if apart <= without.rise.iloc[0] else "identifiable",
        "pulls": f"{without.total['allow']:.2f}",
        "clipped": f"{without.total['clip']:.2f}",
        "pulls_printed": f"{without.printed_total['allow']:.1f}",
        "clipped_printed": f"{without.printed_total['clip']:.1f}",
        "tension": model["tension"],
        "whole": printed_as_a_whole(optima, model["tension"]),
    }


def make(template: str, **tables: pd.DataFrame) -> str:
    """The page from its template and the tables of the stage identification."""
    return render(template, values(tables))
