"""The page on checks of the numbers against theory and brute force."""

import math

import pandas as pd
from scipy.stats import binomtest

from pipeline.templates import render

ROUNDING = 1e-13  # smaller differences are rounding errors
CONFIDENCE = 0.95  # of the limit of the share of different labels


def format_difference(value: float) -> str:
    """A difference in one digit."""
    return f"{value:.0e}" if value >= ROUNDING else f"below {ROUNDING:g}"


def theory_row(row) -> list[str]:
    """The cells of a row of the table of theory: quantity, theory, solver, difference, accepted difference, source."""
    unit = "" if row.unit == "1" else f" {row.unit}"
    error = "" if math.isnan(row.error) else f" ± {row.error:.0e}"
    return [
        f"{row.case}: {row.quantity}",
        f"{row.theory:.9g}{unit}",
        f"{row.computed:.9g}{error}{unit}",
        format_difference(row.difference),
        f"{row.accepted:.0e}",
        row.source,
    ]


def map_rows(points: pd.DataFrame) -> list[list]:
    """The cells of each map: points, those near a boundary, in chaos, with another label, and both."""
    differs = points.label != points.state
    counts = points.assign(
        points=1, chaos=points.label == "chaos", different=differs, different_near=differs & points.near_boundary
    ).groupby("map", sort=False)
    return (
        counts[["points", "near_boundary", "chaos", "different", "different_near"]].sum().reset_index().values.tolist()
    )


def make(template: str, theory: pd.DataFrame, map_check: pd.DataFrame) -> str:
    """The page from its template, the table of quantities with a closed form, and the table of checked map points."""
    settings = map_check.attrs
    different, points = int((map_check.label != map_check.state).sum()), len(map_check)
    limit = binomtest(different, points, alternative="less").proportion_ci(CONFIDENCE).high
    return render(
        template,
        {
            "theory": [theory_row(row) for row in theory.itertuples()],
            "compared": len(theory),
            "agreeing": int((theory.difference <= theory.accepted).sum()),
            **{name: settings[name] for name in ("repeats", "cycles")},
            **{name: f"{settings[name]:g}" for name in ("tolerance", "close", "significant")},
            "accepted_share": f"{settings['accepted']:g}",
            "points": points,
            "different": different,
            "share": f"{different / points:.2g}",
            "margin": f"{settings['accepted'] - different / points:.2g}",
            "confidence": f"{100.0 * CONFIDENCE:g}",
            "largest_share": f"{limit:.1g}",
            "undecided": int((map_check.state == "undecided").sum()),
            "maps": map_rows(map_check),
        },
    )
