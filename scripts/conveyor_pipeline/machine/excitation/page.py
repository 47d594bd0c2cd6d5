"""The measured drive in words, with all numbers from the tables."""

import math

import pandas as pd

from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.excitation import comparison as compared
from conveyor_pipeline.machine.excitation.effects import MEASURES
from conveyor_pipeline.machine.excitation.estimates import CHANCE
from conveyor_pipeline.machine.excitation.limits import MATTERS
from conveyor_pipeline.machine.operating.populations import differences


def make(
    template: str,
    parameters: pd.DataFrame,
    harmonics: pd.DataFrame,
    quality: pd.DataFrame,
    comparison: pd.DataFrame,
    prefix: str,
) -> str:
    """The page from its template and the tables of the drive."""
    drive = parameters.set_index("parameter").to_dict("index")
    fit = quality.iloc[0].to_dict()
    changes = {label: compared.change(comparison, name) for name, label in MEASURES.items()}
    return render(
        template,
        {
            "settings": parameters.attrs,
            "prefix": prefix,
            "drive": drive,
            "backwards": abs(drive["phase_shift"]["value"]) > 0.5 * math.pi,
            "harmonics": harmonics[harmonics.above_noise].to_dict("records"),
            "orders": int(harmonics.order.max()) if len(harmonics) else 1,
            "quality": fit,
            "other": not math.isnan(fit["other_frequency"]),
            "chance": CHANCE,
            "changes": changes,
            "matters": MATTERS,
            "verdict": compared.verdict(list(changes.values())),
            "transit": comparison.attrs,
            "parts": differences(comparison.attrs)["spread"],
            "more": compared.MORE,
            "late": comparison.set_index("drive").late.to_dict(),
        },
    )
