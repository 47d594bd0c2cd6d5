"""The page that says whether a second harmonic beats the best pure cosine."""

import pandas as pd

from operating.second_harmonic import GENERATIONS, KINDS, POPULATION, PURE, SETTLED, SHARES, WITH_HARMONIC
from pipeline.templates import render


def compare(drives: pd.DataFrame) -> dict:
    """Both kinds of drives at one peak acceleration: the best velocity of each, the gain and its uncertainty.

    The uncertainty is the largest relative difference between searches of one kind. Kinds are compared if each has two
    searches with a drive within the constraints, else the gain is None.
    """
    within = drives[drives.within]
    kinds = {kind: within[within.kind == kind].velocity_05 for kind in KINDS}
    row = {"peak": drives.peak_acceleration.iloc[0], "kinds": kinds, "gain": None}
    if all(len(velocity) >= 2 for velocity in kinds.values()):
        row["gain"] = kinds[WITH_HARMONIC].max() / kinds[PURE].max() - 1.0
        row["uncertainty"] = max(velocity.max() / velocity.min() - 1.0 for velocity in kinds.values())
    return row


def make(template: str, second_harmonic: pd.DataFrame) -> str:
    """The page from its template and the table of the searches."""
    rows = [compare(drives) for _, drives in second_harmonic.groupby("peak_acceleration")]
    best = second_harmonic[second_harmonic.within].sort_values("velocity_05", ascending=False, kind="stable")
    values = {
        "rows": rows,
        "compared": all(row["gain"] is not None for row in rows),
        "gains": any(row["gain"] is not None and row["gain"] > row["uncertainty"] for row in rows),
        "kinds": KINDS,
        "drives": best.drop_duplicates(["peak_acceleration", "kind"])
        .sort_values("peak_acceleration")
        .to_dict("records"),
        "seeds": second_harmonic.seed.nunique(),
        "unconfirmed": int((~second_harmonic.within).sum()),
        "unsettled": int((~second_harmonic.settled).sum()),
        "searches": len(second_harmonic),
        "settled": SETTLED,
        "population": POPULATION,
        "generations": GENERATIONS,
        "largest_share": SHARES[1],
        "search": second_harmonic.attrs,
    }
    return render(template, values)
