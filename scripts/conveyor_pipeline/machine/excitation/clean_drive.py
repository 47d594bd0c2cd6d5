"""What a clean drive is worth: transit of parts on drives with one harmonic, over its order, share and phase.

The harmonic has the direction of vibration, so that it has equal shares and phases along and normal to the track.
"""

import itertools
import math

import numpy as np
import pandas as pd

from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.excitation.effects import REGIMES
from conveyor_pipeline.machine.operating import transit
from conveyor_pipeline.machine.operating.populations import VARIED

TABLES = {
    "clean_drive": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation, without the harmonic"),
        fields.text("regime", f"{' or '.join(REGIMES)}, as the config says"),
        fields.count("order", "order of the harmonic; 0 for none"),
        fields.number("share", "1", "acceleration of the harmonic over the fundamental"),
        fields.number("phase", "rad", "phase of the harmonic; null for none"),
        *transit.MEASURES,
    )
}


def harmonic(order: int, share: float, phase: float) -> dict[str, float]:
    """An entry of `model.harmonics` in the direction of vibration."""
    return {"order": order, "along": share, "along_phase": phase, "normal": share, "normal_phase": phase}


def drives_of(settings: dict) -> list[tuple[int, float, float]]:
    """Order, share and phase (rad) of each harmonic; the first drive has none."""
    phases = 2.0 * math.pi * np.arange(settings["phases"]) / settings["phases"]
    phases = np.where(phases > math.pi, phases - 2.0 * math.pi, phases).tolist()
    return [(0, 0.0, math.nan), *itertools.product(settings["orders"], settings["shares"], phases)]


def make(settings: dict, *, progress: str | None = None) -> pd.DataFrame:
    """The table for the settings of the config."""
    regimes = {amplitude: regime for regime in REGIMES for amplitude in settings[regime]}
    amplitudes = np.unique(list(regimes))
    tables = []
    for order, share, phase in drives_of(settings):
        model = {**settings["model"], "harmonics": [harmonic(order, share, phase)] if order else []}
        drive_settings = {**settings, "model": model}
        table = transit.measure(amplitudes, drive_settings, (VARIED,), progress=progress)
        tables.append(table.drop(columns="population").assign(order=order, share=share, phase=phase))
    table = pd.concat(tables, ignore_index=True)
    return table.assign(regime=table.acceleration.map(regimes))
