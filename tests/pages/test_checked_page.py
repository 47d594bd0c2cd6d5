"""The page of checks: differences from theory or brute force are shown and do not count as agreement."""

import pandas as pd
from project import ROOT

from conveyor_pipeline.pages import checked_page

TEMPLATE = (ROOT / "workflow/templates/checked.md").read_text(encoding="utf-8")
ROW = {
    "kind": "impact",
    "quantity": "duration",
    "case": "undamped",
    "unit": "s",
    "theory": 0.25,
    "computed": 0.25,
    "error": float("nan"),
    "difference": 1e-16,
    "accepted": 1e-9,
    "source": "Hertz 1882",
}

POINTS = pd.DataFrame(
    {
        "map": ["high", "low", "high"],
        "near_boundary": [True, False, False],
        "label": ["chaos", "first", "second"],
        "state": ["undecided", "first", "second"],
    }
)
POINTS.attrs = {"cycles": 2000}


def test_a_quantity_that_does_not_agree_is_shown_and_not_counted():
    text = checked_page.make(
        TEMPLATE, pd.DataFrame([ROW, ROW | {"computed": 0.5, "error": 1e-3, "difference": 1.0}]), POINTS
    )
    assert "1 of 2 quantities agree" in text
    assert "| undamped: duration | 0.25 s | 0.25 s | below 1e-13 | 1e-09 | Hertz 1882 |" in text
    assert "| undamped: duration | 0.25 s | 0.5 ± 1e-03 s | 1e+00 | 1e-09 | Hertz 1882 |" in text


def test_an_undecided_label_counts_as_different():
    text = checked_page.make(TEMPLATE, pd.DataFrame([ROW]), POINTS)
    assert "**1 of 3 labels differ**, a share of 0.33 (1 of them because the motion is undecided)." in text
    assert "| high | 2 | 1 | 1 | 1 | 1 |\n| low | 1 | 0 | 0 | 0 | 0 |" in text


def test_no_different_label_leaves_the_limit_of_the_rule_of_three():
    """Of 300 points without a difference: 1 - 0.05^(1/300), nearly 3/300."""
    equal = pd.DataFrame({"map": "high", "near_boundary": False, "label": "first", "state": "first"}, index=range(300))
    equal.attrs = POINTS.attrs
    text = checked_page.make(TEMPLATE, pd.DataFrame([ROW]), equal)
    assert "With 95 % confidence, fewer than 0.01 of all points" in text
