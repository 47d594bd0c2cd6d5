"""The recommended settings of the drive in words."""

import numpy as np
import pandas as pd

from pipeline.templates import render


def last_growth(generations: pd.DataFrame) -> float:
    """Largest relative growth of the hypervolume in the last quarter of the generations of any seed."""
    growth = []
    for _, rows in generations.groupby("seed"):
        volumes = rows.hypervolume.to_numpy()
        earlier = volumes[max(3 * len(volumes) // 4 - 1, 0)]
        growth.append(volumes[-1] / earlier - 1.0 if earlier > 0.0 else np.inf if volumes[-1] > 0.0 else 0.0)
    return max(growth)


def make(template: str, drive_front: pd.DataFrame, drive_generations: pd.DataFrame) -> str:
    """The page from its template and the tables of the front and of the generations."""
    search = drive_front.attrs
    rows = [
        [
            f"{row.acceleration:.4g}",
            f"{row.frequency:.4g}",
            f"{np.degrees(row.angle):.3g}",
            f"{np.degrees(row.phase_shift):.3g}",
            f"{1e3 * row.displacement:.3g}",
            f"{row.checked_velocity:.3g} ± {2.0 * row.velocity_stderr:.1g}",
            f"{100.0 * row.checked_share:.1f}",
            f"{row.impact_speed:.2g}",
        ]
        for row in drive_front[drive_front.recommended].sort_values("velocity").itertuples()
    ]
    numbers = {
        "share": f"{100.0 * search['share']:g}",
        "seeds": str(len(search["seeds"])),
        "found": str(len(drive_front)),
        "confirmed": str(int(drive_front.confirmed.sum())),
        "checked": str(int(drive_front.checked.sum())),
        "growth": f"{100.0 * last_growth(drive_generations):.2g}",
    }
    return render(
        template,
        {name: str(search[name]) for name in ("starts", "population", "generations")} | numbers | {"rows": rows},
    )
