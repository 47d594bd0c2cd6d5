"""Numbers of the caption of the figure identification."""

import pandas as pd

from calibration import paper_findings as findings
from calibration.edges import contacts_of


def numbers(*, frictions: pd.DataFrame) -> dict:
    settings = frictions.attrs
    return {
        "contacts": contacts_of(settings["effort"]) ** 2,
        "coarse": settings["effort"] < findings.ENOUGH,
        "accepted": findings.accepted_frictions(frictions, settings["numbers"]),
    }
