"""The page of checks: differences in words, and what does not agree is not counted."""

import pandas as pd
from project import ROOT

from docs import checked_page

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


def test_a_quantity_that_does_not_agree_is_shown_and_not_counted():
    text = checked_page.make(TEMPLATE, pd.DataFrame([ROW, ROW | {"computed": 0.5, "difference": 1.0}]))
    assert "1 of 2 quantities agree" in text
    assert "| duration in s | undamped | 0.25 | 0.25 | – | below 1e-13 | 1e-09 | Hertz 1882 |" in text
    assert "| duration in s | undamped | 0.25 | 0.5 | – | 1e+00 | 1e-09 | Hertz 1882 |" in text
