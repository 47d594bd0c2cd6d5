"""What the harmonics of the measured drive change: transit with and without them, at the measured amplitude."""

import math

import numpy as np
import pandas as pd

from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.excitation.limits import MATTERS
from conveyor_pipeline.machine.excitation.overlay import drive_of, harmonics_above_noise
from conveyor_pipeline.machine.operating import transit
from conveyor_pipeline.machine.operating.populations import VARIED

WITH, WITHOUT = DRIVES = ("with harmonics", "without harmonics")
TABLES = {
    "comparison": (
        fields.text("drive", f"{' or '.join(DRIVES)}"),
        fields.number("acceleration", "m/s²", "measured amplitude"),
        *transit.MEASURES,
    )
}
MORE = 8  # parts for each part of the transit table, because a change is smaller than the velocities
SURE = 2.0  # standard errors from which two velocities differ
YES, NO, PERHAPS = "yes", "no", "not known"


def make(
    parameters: pd.DataFrame,
    harmonics: pd.DataFrame,
    settings: dict,
    *,
    threads: int = 1,
    progress: str | None = None,
) -> pd.DataFrame:
    """The table for the parameters and harmonics above the noise that the accelerometer has measured."""
    model = settings["model"] | drive_of(parameters)
    amplitude = np.array([model.pop("acceleration")])
    above = harmonics_above_noise(harmonics)
    tables = []
    for drive, components in ((WITH, above), (WITHOUT, [])):
        drive_settings = {**settings, "model": {**model, "harmonics": components}, "starts": MORE * settings["starts"]}
        table = transit.measure(amplitude, drive_settings, (VARIED,), threads=threads, progress=progress)
        tables.append(table.drop(columns="population").assign(drive=drive))
    return pd.concat(tables, ignore_index=True)


def change(comparison: pd.DataFrame, name: str) -> dict[str, float]:
    """A velocity `with` and `without` harmonics (m/s), its relative change, and the standard error of the change."""
    rows = comparison.set_index("drive")
    after, before = rows[name][WITH], rows[name][WITHOUT]
    size = abs(before) or math.nan
    error = math.hypot(*rows[f"{name}_stderr"][[WITH, WITHOUT]]) / size
    return {"after": after, "before": before, "change": (after - before) / size, "stderr": error}


def verdict(changes: list[dict[str, float]]) -> str:
    """Whether harmonics matter: whether a velocity changes by more than MATTERS, and by more than chance."""
    large = [effect for effect in changes if abs(effect["change"]) > MATTERS]
    if any(abs(effect["change"]) > SURE * effect["stderr"] for effect in large):
        return YES
    return PERHAPS if large or any(math.isnan(effect["change"]) for effect in changes) else NO
