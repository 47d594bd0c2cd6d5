"""The table and the page of the simulation study, from made-up data sets."""

import json

import pandas as pd
from project import ROOT

from calibration import study_table
from docs import calibration_study_page

TRUE = {"friction": 0.2, "damping": 1.0, "stiffness": 1e5}


def row(number, kind, p_value, half=0.1, error=0.0, gain=-3.0):
    """A data set whose best values have a relative error, with intervals of a relative half width."""
    found = {"number": number, "kind": kind, "frequency": 50.0, "angle": 0.3, "mass": 1e-3, "measurements": 30}
    found |= {"in_band": 0.9, "p_value": p_value, "effective": 100.0}
    found |= {"alternative": "inclination", "log_bayes_factor": gain}
    for name, value in TRUE.items():
        best = (1.0 + error) * value
        found |= {name: value, f"{name}_best": best}
        found |= {f"{name}_low": (1.0 - half) * best, f"{name}_high": (1.0 + half) * best}
    return json.dumps(found)


SETTINGS = {
    "conveyors": {
        "frequency": [15.0, 150.0],
        "angle": [0.17, 0.61],
        "mass": [1e-4, 0.2],
        "friction": [0.1, 0.6],
        "damping": [0.06, 0.8],
        "stiffness": [4.0, 1800.0],
    },
    "throw_number": [0.8, 3.5],
    "amplitudes": 10,
    "poor": 5,
    "parts_of_study": 3,
    "wrong": {"phase_shift": 0.8, "inclination": 0.06, "exponent": 1.0},
    "calibration": {"noise": 0.02, "confidence": 0.95, "significance": 0.03, "decisive": 150.0},
}


def test_the_page_counts_intervals_that_hold_and_models_that_are_called_wrong():
    rows = [row(0, "rich", 0.4), row(1, "rich", 0.02), row(2, "rich", 0.5, half=0.3, error=0.5), row(3, "poor", 0.9)]
    rows += [row(4, "inclination", 0.001), row(5, "inclination", 0.04), row(6, "inclination", 0.9, gain=6.0)]
    table = pd.DataFrame(study_table.make(rows, SETTINGS))
    assert list(table.explained) == [True, False, True, True, False, True, False]
    table.attrs = SETTINGS
    template = (ROOT / "workflow/templates/calibration_study.md").read_text(encoding="utf-8")
    page = calibration_study_page.make(template, table)
    assert "| True friction within its 95 % interval | 2 of 3 | 1 of 1 |" in page
    assert "| All true parameters within their intervals | 6 of 9 (67 %) | 3 of 3 (100 %) |" in page
    assert "| Intervals of friction and damping of at most ±20 % | 2 of 3 | 1 of 1 |" in page
    assert '| Wrongly called "not explained" | 1 of 3 | 0 of 1 |' in page
    assert "| the track rises by 0.06 rad | 3 | 2 |" in page
