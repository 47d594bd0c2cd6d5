"""The page of certificates: intervals are rounded outwards, and an orbit without a proof is listed with the reason."""

from decimal import Decimal

import pandas as pd
import pytest
from project import ROOT

from conveyor_pipeline.pages import certificates_page

TEMPLATE = (ROOT / "workflow/rules/pages/certificates.md").read_text(encoding="utf-8")
ORBIT = {
    "branch": 0,
    "acceleration": 40.0,
    "period": 1,
    "contained": True,
    "reason": None,
    "stability": "stable",
    "impacts": 1,
    "distance": 1e-15,
    "half_width": 1e-20,
    "contact_time_low": 0.1,
    "contact_time_high": 0.1,
    "impact_phase_low": 1.25,
    "impact_phase_high": 1.25,
    "impact_speed_low": 0.5,
    "impact_speed_high": 0.5,
}
REFUSED = ORBIT | {"branch": 3, "period": 2, "contained": False, "stability": "unknown", "reason": "it grazes"}
FOLD = {
    "kind": "fold",
    "number": 1,
    "period": 1,
    "proved": True,
    "reason": None,
    "acceleration_low": 24.0,
    "acceleration_high": 24.0,
    "stored_acceleration": 24.0,
}
HORSESHOE = {"acceleration": 80.0, "sets": 7, "entropy": 0.12349, "proved": True, "reason": None, "bits": 96}


def page(*orbits: dict) -> str:
    certificates = pd.DataFrame(orbits)
    certificates[["order", "bits"]] = 30, 128
    return certificates_page.make(TEMPLATE, certificates, pd.DataFrame([FOLD]), pd.DataFrame([HORSESHOE]))


@pytest.mark.parametrize(("low", "high"), [(1.2345678901, 1.2345678912), (-0.3, -0.1), (62.7, 62.7)])
def test_intervals_are_rounded_outwards(low, high):
    below, above = map(Decimal, certificates_page.interval(low, high).strip("[]").split(", "))
    assert below <= Decimal(low) <= Decimal(high) <= above


def test_an_orbit_without_a_proof_is_listed_with_the_reason():
    text = page(ORBIT, REFUSED)
    assert "Rejected, with the reason:\n\n- branch 3, 40 m/s², 2 cycles: it grazes\n" in text
    assert "| 2 | 1 | 0 | 0 | 0 |" in text
    assert "None was rejected." in page(ORBIT)


def test_entropy_is_rounded_down():
    assert "| 80 | 7 | 0.1234 |" in page(ORBIT)


def test_the_example_is_left_out_if_it_is_not_proved():
    assert "the jumping orbit at 40 m/s²" in page(ORBIT)
    assert "the jumping orbit at 40 m/s²" not in page(REFUSED)
