"""The table and the page of the simulation study, from made-up data sets."""

import json
import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT

from calibration import study, study_table
from calibration.inference import data_of
from calibration.measurements import parse
from calibration.synthetic import csv_text, measure
from conveyor.parameters import RANGES
from docs import calibration_study_page

TRUE = {"friction": 0.2, "damping": 1.0, "stiffness": 1e5}


def row(number, kind, p_value, half=0.1, error=0.0, gain=-3.0, **others):
    """A data set whose best values have a relative error, with intervals of a relative half width."""
    found = {"number": number, "kind": kind, "frequency": 50.0, "angle": 0.3, "mass": 1e-3, "measurements": 30}
    found |= {"in_band": 0.9, "p_value": p_value, "effective": 100.0}
    found |= {"alternative": "inclination", "log_bayes_factor": gain, **others}
    for name, value in TRUE.items():
        best = (1.0 + error) * value
        found |= {name: value, f"{name}_best": best}
        found |= {f"{name}_low": (1.0 - half) * best, f"{name}_high": (1.0 + half) * best}
    return json.dumps(found)


SETTINGS = {"calibration": {"noise": 0.02}}


def test_the_page_counts_intervals_that_hold_and_models_that_are_called_wrong():
    rows = [
        row(0, "rich", 0.4),
        row(1, "rich", 0.005),
        row(2, "rich", 0.5, half=0.3, error=0.5, gain_of_distant=-1.0),
        row(3, "poor", 0.9),
    ]
    # Evidences of the true model: e^6.9, e^-0.46 and e^2.3 times as large.
    wrong = [(0.001, -3.0, 6.9), (0.04, -3.0, -0.46), (0.9, 6.0, 2.3)]
    for number, (p_value, gain, of_truth) in enumerate(wrong, start=4):
        rows.append(row(number, "inclination", p_value, gain=gain, gain_of_truth=of_truth))
    table = pd.DataFrame(study_table.make(rows))
    assert list(table.explained) == [True, False, True, True, False, True, False]
    table.attrs = SETTINGS
    template = (ROOT / "workflow/templates/calibration_study.md").read_text(encoding="utf-8")
    page = calibration_study_page.make(template, table)
    assert "| True friction within its 95 % interval | 2 of 3 | 1 of 1 |" in page
    assert "| All true parameters within their intervals | 6 of 9 (67 %) | 3 of 3 (100 %) |" in page
    assert "| Intervals of friction and damping of at most ±20 % | 2 of 3 | 1 of 1 |" in page
    assert "Wider intervals that the measurements leave open (see below) | 1 of 1 | 0 of 0 |" in page
    assert '| Wrongly called "not explained" | 1 of 3 | 0 of 1 |' in page
    assert "| the track rises by 0.06 rad | 3 | 2 | -0.2 to 3.0 |" in page


MODEL = {"frequency": 40.0, "angle": 0.3, "mass": 1e-3, "gravity": 9.81, "exponent": 1.5}
TRUE_CONTACT = {"friction": 0.25, "damping": 0.3, "stiffness": 3e5}
BOX = {"height": [0.0, 5e-4], "vz0": [-0.2, 0.2], "psi0": [0.0, 2.0 * math.pi]}
OWN = BOX | {"model": MODEL, "static_friction": 0.0, "noise": 0.02, "seed": 1}
OWN |= {"parameters": list(TRUE_CONTACT)}


@pytest.mark.parametrize(("friction", "is_open"), [(0.25, True), (0.9, False)])
def test_distant_samples_are_compared_with_the_true_parameters(friction, is_open, monkeypatch):
    """The measurements hardly depend on a slightly larger damping, but on a much larger friction."""
    monkeypatch.setattr(study, "MANY", 256)
    rows = measure(MODEL | TRUE_CONTACT, [20.0, 22.0, 24.0, 26.0], BOX, 0.02, np.random.default_rng(4), duration=0.1)
    text = csv_text(rows, "synthetic", duration=0.1, before=0.1)
    data = data_of(parse(text, "mine.csv", OWN, RANGES), MODEL)
    near = pd.DataFrame([TRUE_CONTACT])
    assert math.isnan(study.gain_of_distant(near, TRUE_CONTACT, TRUE_CONTACT, data, OWN, 1))
    far = near.assign(friction=friction, damping=0.37)
    gain = study.gain_of_distant(far, TRUE_CONTACT, TRUE_CONTACT, data, OWN, 1)
    assert (gain > -calibration_study_page.ALLOWED) == is_open
