"""The recommended settings of the drive in words."""

import numpy as np
import pandas as pd

from conveyor_pipeline.common.steepness import is_frictionless, is_steep
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.operating.chart import MANY_LATE, RULE_OF_THREE
from conveyor_pipeline.machine.operating.drive import DRAWN, SEEDS, SETTLED, last_growth
from conveyor_pipeline.machine.operating.parts import differences
from conveyor_pipeline.machine.operating.transit import ENDS


def summarize_search(*, front: pd.DataFrame, generations: pd.DataFrame) -> dict:
    """The settings of the search, the sizes of its front, and the largest growth of the hypervolume of a seed."""
    last = generations[generations.generation == generations.generation.max()]
    growth = max(last_growth(rows.hypervolume.to_numpy()) for _, rows in generations.groupby("seed"))
    return {
        "search": front.attrs,
        "seeds": len(SEEDS),
        "drawn": DRAWN * front.attrs["population"],
        "settled": SETTLED,
        **differences(front.attrs),
        "ends": ENDS,
        "unseen_share": RULE_OF_THREE / front.attrs["starts"],
        "found": len(front),
        "checked": front.checked.sum(),
        "confirmed": front.confirmed.sum(),
        "growth": growth,
        "is_late": np.isinf(growth),
        "worst_seed": last.hypervolume.min(),
        "flat": last.hypervolume.max() == 0.0,
    }


def make(template: str, drive_front: pd.DataFrame, drive_generations: pd.DataFrame) -> str:
    """The page from its template and the tables of the front and of the generations."""
    recommended = drive_front[drive_front.recommended].sort_values("checked_velocity", ascending=False, kind="stable")
    values = summarize_search(front=drive_front, generations=drive_generations)
    values |= {
        "rows": recommended.to_dict("records"),
        "late": (recommended.checked_late > MANY_LATE).sum(),
        "slides": is_steep(drive_front.attrs["model"]),
        "frictionless": is_frictionless(drive_front.attrs["model"]),
    }
    return render(template, values)
