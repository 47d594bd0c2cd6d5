"""The recommended settings of the drive in words."""

import numpy as np
import pandas as pd

from operating.chart import RULE_OF_THREE, numbers, rounded
from pipeline.templates import render


def last_growth(generations: pd.DataFrame) -> float:
    """Largest relative growth of the hypervolume in the last quarter of the generations of any seed; inf for none."""
    growth = []
    for _, rows in generations.groupby("seed"):
        volumes = rows.hypervolume.to_numpy()
        earlier = volumes[3 * len(volumes) // 4 - 1]
        growth.append(volumes[-1] / earlier - 1.0 if earlier > 0.0 else np.inf)
    return max(growth)


def search_numbers(*, front: pd.DataFrame, generations: pd.DataFrame) -> dict[str, str | bool]:
    """How the front was searched and checked, and whether the search has settled."""
    search, growth = front.attrs, last_growth(generations)
    last = generations[generations.generation == generations.generation.max()]
    return {
        **{name: str(search[name]) for name in ("starts", "drawn", "population", "generations")},
        "displacement": rounded(1e3 * search["displacement"]),
        "velocity": rounded(search["velocity"]),
        "impact_speed": rounded(search["impact_speed"]),
        "share": rounded(100.0 * search["share"]),
        "margin": rounded(100.0 * search["margin"]),
        "others": f"{100.0 * RULE_OF_THREE / search['starts']:.2g}",
        "seeds": str(len(search["seeds"])),
        "found": str(len(front)),
        "checked": str(int(front.checked.sum())),
        "confirmed": str(int(front.confirmed.sum())),
        "growth": f"{100.0 * growth:.2g}",
        "limit": rounded(100.0 * search["settled"]),
        "settled": growth <= search["settled"],
        "worst_seed": f"{100.0 * last.hypervolume.min():.3g}",
    }


def make(template: str, drive_front: pd.DataFrame, drive_generations: pd.DataFrame) -> str:
    """The page from its template and the tables of the front and of the generations."""
    rows = [
        [
            rounded(row.acceleration),
            rounded(row.frequency),
            rounded(np.degrees(row.angle)),
            rounded(np.degrees(row.phase_shift)),
            rounded(1e3 * row.displacement),
            rounded(row.checked_velocity),
            numbers(row.velocity_low, row.velocity_high),
            numbers(row.impact_low, row.impact_high),
            f"{100.0 * row.checked_share:.1f}",
        ]
        for row in drive_front[drive_front.recommended].sort_values("checked_velocity").itertuples()
    ]
    return render(template, search_numbers(front=drive_front, generations=drive_generations) | {"rows": rows})
