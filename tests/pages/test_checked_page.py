"""The page of checks: differences from theory or brute force are shown and do not count as agreement."""

import numpy as np
import pandas as pd
from project import ROOT, si_config

from conveyor_pipeline.pages import checked_page

TEMPLATE = (ROOT / "workflow/rules/pages/checked.md").read_text(encoding="utf-8")
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
MODEL = si_config()["model"]


def bodies_at(low, high, flat_low, flat_high):
    """A table of points and of flat blocks at four amplitudes with these quantiles (m/s)."""
    rows = pd.DataFrame({"acceleration": [30.0, 40.0, 60.0, 80.0]})
    points = rows.assign(length=np.nan, height=np.nan, velocity_05=low, velocity_95=high, rides=[1.0, 0.5, 0.0, 0.0])
    blocks = rows.assign(
        length=50.3, height=0.2, velocity_05=flat_low, velocity_95=flat_high, rides=[1.0, 1.0, 0.0, 0.0]
    )
    table = pd.concat([points, blocks], ignore_index=True)
    table = table.assign(velocity_50=0.5 * (table.velocity_05 + table.velocity_95))
    table["velocity_50_stderr"] = 0.03 * table.velocity_50
    table.attrs = {"model": MODEL}
    return table


BODIES = bodies_at(
    [0.01, 0.01, 0.1, 0.1], [0.06, 0.06, 0.12, 0.12], [0.0101, 0.01, 0.02, 0.12], [0.011, 0.011, 0.2, 0.14]
)


def test_what_remains_for_a_flat_block():
    text = checked_page.make(TEMPLATE, pd.DataFrame([ROW]), POINTS, BODIES)
    assert "5 × 1 mm" in text
    assert "| 40.0 | 1.00, 3.50, 6.00 | 50 % | 1.00, 1.05, 1.10 | 100 % |" in text
    assert "Points have two at 30 and 40 m/s², flat blocks at\n  60 m/s²" in text
    assert "differs from that of points by at most 1.1 %" in text
    assert "From 80 m/s² on" in text and "by +18 to +18 %, with standard errors of 5 to 5 %" in text
    alike = bodies_at(0.1, 0.12, 0.101, 0.12)
    assert "Points have two at no amplitude" in checked_page.make(TEMPLATE, pd.DataFrame([ROW]), POINTS, alike)


def test_a_quantity_that_does_not_agree_is_shown_and_not_counted():
    text = checked_page.make(
        TEMPLATE, pd.DataFrame([ROW, ROW | {"computed": 0.5, "error": 1e-3, "difference": 1.0}]), POINTS, BODIES
    )
    assert "1 of 2 quantities agree" in text
    assert "| undamped: duration | 0.25 s | 0.25 s | below 1e-13 | 1e-09 | Hertz 1882 |" in text
    assert "| undamped: duration | 0.25 s | 0.5 ± 1e-03 s | 1e+00 | 1e-09 | Hertz 1882 |" in text


def test_an_undecided_label_counts_as_different():
    text = checked_page.make(TEMPLATE, pd.DataFrame([ROW]), POINTS, BODIES)
    assert "**1 of 3 labels differ**, a share of 0.33 (1 of them because the motion is undecided)." in text
    assert "| high | 2 | 1 | 1 | 1 | 1 |\n| low | 1 | 0 | 0 | 0 | 0 |" in text


def test_no_different_label_leaves_the_limit_of_the_rule_of_three():
    """Of 300 points without a difference: 1 - 0.05^(1/300), nearly 3/300."""
    equal = pd.DataFrame({"map": "high", "near_boundary": False, "label": "first", "state": "first"}, index=range(300))
    equal.attrs = POINTS.attrs
    text = checked_page.make(TEMPLATE, pd.DataFrame([ROW]), equal, BODIES)
    assert "With 95 % confidence, fewer than 0.01 of all points" in text
