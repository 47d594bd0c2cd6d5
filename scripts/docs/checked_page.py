"""The page that says how the numbers were checked."""

import math

import pandas as pd

from pipeline.templates import render


def in_unit(name: str, unit: str) -> str:
    return name if unit == "1" else f"{name} in {unit}"


ROUNDING = 1e-13  # smaller differences are rounding errors, whose digits mean nothing


def order(value: float) -> str:
    """An error or a difference in one digit, a dash for none."""
    if math.isnan(value):
        return "–"
    return f"{value:.0e}" if value >= ROUNDING else f"below {ROUNDING:g}"


def theory_row(row) -> list[str]:
    """The cells of a row of the table of theory."""
    return [
        in_unit(row.quantity, row.unit),
        row.case,
        f"{row.theory:.12g}",
        f"{row.computed:.12g}",
        *map(order, (row.error, row.difference, row.accepted)),
        row.source,
    ]


def make(template: str, theory: pd.DataFrame) -> str:
    """The page from its template and the table of quantities with a closed form."""
    return render(
        template,
        {
            "theory": [theory_row(row) for row in theory.itertuples()],
            "compared": len(theory),
            "agreeing": int((theory.difference <= theory.accepted).sum()),
        },
    )
