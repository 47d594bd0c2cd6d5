"""The measured drive in words, with all numbers from the tables."""

import math

import pandas as pd

from conveyor.parameters import MOST_HARMONICS
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.excitation import comparison as compared
from conveyor_pipeline.machine.excitation.effects import MEASURES
from conveyor_pipeline.machine.excitation.estimates import CHANCE, NORMAL
from conveyor_pipeline.machine.excitation.limits import MATTERS, OTHER_DIRECTION, OTHER_FREQUENCY, STATEMENT
from conveyor_pipeline.machine.excitation.reading import AXES
from conveyor_pipeline.machine.operating.populations import differences

LISTED = 5  # orders of the table, whether or not they are above the noise


def hidden_shares(harmonics: pd.DataFrame) -> pd.DataFrame:
    """The share that a harmonic may have at most by its 95 % interval, of both axes; 0 if it is above the noise."""
    return pd.DataFrame(
        {
            axis: (harmonics[axis] + NORMAL * harmonics[f"{axis}_stderr"]).where(~harmonics[f"{axis}_above_noise"], 0.0)
            for axis in AXES
        }
    )


def verdict_of(changes: list[dict[str, float]], hidden: float) -> str:
    """Whether harmonics matter; not known if the noise could hide a share that may matter."""
    verdict = compared.verdict(changes)
    return compared.PERHAPS if verdict == compared.NO and hidden >= STATEMENT["share"] else verdict


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
    hidden = hidden_shares(harmonics)
    largest_hidden = {axis: float(hidden[axis].max()) if len(hidden) else 0.0 for axis in AXES}
    rows = harmonics.assign(**hidden.add_prefix("hidden_"))
    is_listed = (rows.order <= LISTED) | rows.above_noise
    return render(
        template,
        {
            "settings": parameters.attrs,
            "prefix": prefix,
            "drive": drive,
            "backwards": abs(drive["phase_shift"]["value"]) > 0.5 * math.pi,
            "harmonics": rows[is_listed].to_dict("records"),
            "above": bool(harmonics.above_noise.any()),
            "dropped": max(int(harmonics.above_noise.sum()) - MOST_HARMONICS, 0),
            "most_harmonics": MOST_HARMONICS,
            "hidden": largest_hidden,
            "statement": STATEMENT["share"],
            "orders": int(harmonics.order.max()) if len(harmonics) else 1,
            "quality": fit,
            "turned": math.atan(fit["across"]),
            "other": not math.isnan(fit["other_frequency"]),
            "chance": CHANCE,
            "other_frequency": OTHER_FREQUENCY,
            "other_direction": OTHER_DIRECTION,
            "changes": changes,
            "matters": MATTERS,
            "verdict": verdict_of(list(changes.values()), max(largest_hidden.values())),
            "is_change_known": compared.verdict(list(changes.values())) != compared.PERHAPS,
            "transit": comparison.attrs,
            "parts": differences(comparison.attrs)["spread"],
            "more": compared.MORE,
            "late": comparison.set_index("drive").late.to_dict(),
        },
    )
