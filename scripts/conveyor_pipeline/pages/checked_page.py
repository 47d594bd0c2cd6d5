"""The page on checks of the numbers against theory and brute force."""

import pandas as pd
from scipy.stats import binomtest

from conveyor_pipeline.common.templates import render
from conveyor_pipeline.pages.flat_blocks import beside_points, compare_flat
from conveyor_pipeline.study.accuracy.map_check import ACCEPTED, CLOSE, CYCLES, REPEATS, SIGNIFICANT, TOLERANCE

ROUNDING = 1e-13  # smaller differences are rounding errors
CONFIDENCE = 0.95  # of the limit of the share of different labels


def count_labels(points: pd.DataFrame) -> pd.DataFrame:
    """For each map: points, those near a boundary, in chaos, with another label, and both."""
    differs = points.label != points.state
    counts = points.assign(
        points=1, chaos=points.label == "chaos", different=differs, different_near=differs & points.near_boundary
    ).groupby("map", sort=False)
    return counts[["points", "near_boundary", "chaos", "different", "different_near"]].sum().reset_index()


def make(template: str, theory: pd.DataFrame, map_check: pd.DataFrame, bodies: pd.DataFrame) -> str:
    """The page from its template, with the tables of closed forms, of checked map points and of blocks."""
    different = int((map_check.label != map_check.state).sum())
    points = len(map_check)
    values = {
        "theory": theory,
        "rounding": ROUNDING,
        "cycles": CYCLES,
        "tolerance": TOLERANCE,
        "close": CLOSE,
        "repeats": REPEATS,
        "significant": SIGNIFICANT,
        "accepted": ACCEPTED,
        "points": points,
        "different": different,
        "undecided": (map_check.state == "undecided").sum(),
        "confidence": CONFIDENCE,
        "largest_share": binomtest(different, points, alternative="less").proportion_ci(CONFIDENCE).high,
        "maps": count_labels(map_check),
        "flat": compare_flat(bodies),
        "beside": beside_points(bodies),
    }
    return render(template, values)
