"""The recommended settings of the drive in words."""

import numpy as np
import pandas as pd

from conveyor import throw_number
from conveyor_pipeline.common.steepness import is_frictionless, is_steep
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.operating.chart import MANY_LATE
from conveyor_pipeline.machine.operating.drive import DRAWN, SEARCHED, SEEDS, SETTLED, last_growth
from conveyor_pipeline.machine.operating.populations import ENDS, differences
from conveyor_pipeline.machine.operating.regimes import RULE_OF_THREE

LEAST_SEED = 0.8  # of the hypervolume of all seeds, below which a seed has not found the front
CLOSE = 0.02  # of the width of bounds, or of a limit: a design that is closer lies at it


def throw_numbers(designs: pd.DataFrame, model: dict) -> list[float]:
    """The throw number of each design."""
    per_amplitude = [throw_number(1.0, **(model | {"angle": angle})) for angle in designs.angle]
    return (designs.acceleration * per_amplitude).tolist()


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
        "is_settled": growth <= SETTLED and last.hypervolume.min() >= LEAST_SEED,
        "least_seed": LEAST_SEED,
        "flat": last.hypervolume.max() == 0.0,
    }


def ends_reached(design: dict, settings: dict) -> list[str]:
    """The keys of the bounds and limits of a search at which a design lies, with the side of the bounds."""
    reached = []
    for name in SEARCHED:
        low, high = settings["bounds"][name]
        for side, distance in (("lower", design[name] - low), ("upper", high - design[name])):
            if low < high and distance <= CLOSE * (high - low):
                reached.append(f"the {side} bound of `drive.bounds.{name}`")
    limits = (("impact_speed", design["checked_impact_speed"]), ("displacement", design["displacement"]))
    return reached + [f"`drive.{name}`" for name, value in limits if value >= (1.0 - CLOSE) * settings[name]]


def make(template: str, drive_front: pd.DataFrame, drive_generations: pd.DataFrame, has_body: bool = False) -> str:
    """The page from its template and the tables of the front and of the generations.

    has_body : whether the config has blocks, which the search does not follow
    """
    recommended = drive_front[drive_front.recommended].sort_values("checked_velocity", ascending=False, kind="stable")
    values = summarize_search(front=drive_front, generations=drive_generations)
    values |= {
        "rows": recommended.to_dict("records"),
        "reached": ends_reached(recommended.iloc[0].to_dict(), drive_front.attrs) if len(recommended) else [],
        "throw_numbers": throw_numbers(recommended, drive_front.attrs["model"]),
        "late": (recommended.checked_late > MANY_LATE).sum(),
        "has_body": has_body,
        "slides": is_steep(drive_front.attrs["model"]),
        "frictionless": is_frictionless(drive_front.attrs["model"]),
    }
    return render(template, values)
