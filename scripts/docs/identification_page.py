"""The page on the parameters that the paper's numbers imply."""

import math

import numpy as np
import pandas as pd

from claims.finding import format_interval
from identification import findings
from identification.misfits import OBJECTIVES
from identification.printed import CONVERGED, EULER
from identification.search_space import PARAMETERS
from identification.settings import NUMBERS_OF_CLAIMS
from pipeline.templates import render


def number_rows(printed: pd.DataFrame, implied: pd.DataFrame) -> list[tuple[dict, ...]]:
    """The rows of each number: by both methods at the printed parameters, and at the best parameters of each set.

    Numbers that the search does not use are left out.
    """
    at_printed = printed[printed["set"] == "printed"]
    sets = [at_printed[at_printed.method == method] for method in (EULER, CONVERGED)]
    sets += [rows for _, rows in implied.groupby("set", sort=False)]
    used = (rows[rows.number.isin(NUMBERS_OF_CLAIMS)].to_dict("records") for rows in sets)
    return list(zip(*used, strict=True))


def friction_rows(printed: pd.DataFrame) -> list[dict]:
    """Velocities with each variant of friction, and the largest change of all remaining numbers."""
    converged = printed[printed.method == CONVERGED]
    values = converged.pivot(index="set", columns="number", values="value")
    velocities = list(findings.VELOCITIES.values())
    changes = (values - values.loc["printed"]).drop(columns=velocities).abs().max(axis=1)
    return [
        {"friction": friction, "velocities": values.loc[name, velocities], "change": changes[name]}
        for name, friction in converged.groupby("set", sort=False).friction.first().items()
    ]


def interval_rows(profiles: pd.DataFrame, optima: pd.DataFrame, model: dict) -> dict[str, list[dict]]:
    """For each parameter, by set of evidence: best value, confidence interval, and whether it has the printed value.

    `open` is the number of ends (0 for a parameter that is bounded on both sides, 2 on neither side). An end is open
    also if another parameter is at a bound of the search there.
    """
    rows = {}
    for evidence, fits in optima.groupby("evidence", sort=False):
        best = fits.loc[fits.total.idxmin()]
        rows[evidence] = [
            {
                "parameter": name,
                "best": best[name],
                "low": low,
                "high": high,
                "contains": (low is None or low.value <= model[name]) and (high is None or model[name] <= high.value),
                "open": sum(end is None or end.held for end in (low, high)),
            }
            for name, (low, high) in findings.intervals(profiles, optima, evidence).items()
        ]
    return rows


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


def make(
    template: str,
    printed: pd.DataFrame,
    implied: pd.DataFrame,
    front: pd.DataFrame,
    generations: pd.DataFrame,
    profiles: pd.DataFrame,
    optima: pd.DataFrame,
    frictions: pd.DataFrame,
) -> str:
    """The page from its template and the tables of the stage identification."""
    settings = profiles.attrs
    numbers, model, triple = settings["numbers"], settings["model"], settings["measured"]["triple"]
    fronts = front.groupby("tension", sort=False)
    left_out = optima[optima.evidence == "end_left_out"].set_index("tension")
    errors = interpolation_errors(implied)
    values = {
        "settings": settings,
        "coarse": findings.is_coarse(settings),
        "format_interval": format_interval,
        "sets": implied["set"].unique(),
        "numbers": number_rows(printed, implied),
        "parameters": list(PARAMETERS),
        "interpolation_median": np.median(errors),
        "interpolation_most": errors.max(),
        "up": numbers[findings.UP_ALONE]["paper"],
        "down": numbers[findings.DOWN_ALONE]["paper"],
        "widening": findings.contradiction(numbers),
        "zero": -triple["A"] / triple["C"] - triple["B"],
        "frictions": friction_rows(printed),
        "accepted": findings.accepted_frictions(frictions, numbers),
        "search": findings.summarize_search(front, generations),
        "fronts": fronts[list(OBJECTIVES)].min().assign(members=fronts.size()).reset_index().to_dict("records"),
        "optima": optima.assign(
            printed_rise=optima.printed_total - optima.groupby("evidence").total.transform("min")
        ).to_dict("records"),
        "factor": math.sqrt(optima[optima.evidence == "all"].scale.iloc[0]),
        "intervals": interval_rows(profiles, optima, model),
        "left_out": left_out.to_dict("index"),
        "identifiable": abs(left_out.total["clip"] - left_out.total["allow"]) > left_out.rise.iloc[0],
    }
    return render(template, values)
