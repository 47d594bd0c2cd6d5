"""What a clean drive is worth: transit of parts on drives with one harmonic, over its order, share and phase.

The harmonic has the direction of vibration, so that it has equal shares and phases along and normal to the track.
"""

import itertools
import math

import numpy as np
import pandas as pd

from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.excitation.limits import MATTERS, STATEMENT
from conveyor_pipeline.machine.operating import transit
from conveyor_pipeline.machine.operating.populations import VARIED

RIDING, CHAOS = REGIMES = ("riding", "chaos")
MEASURES = {"velocity_05": "the slowest 5 %", "velocity_50": "the median"}
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


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> pd.DataFrame:
    """The table for the settings of the config."""
    regimes = {amplitude: regime for regime in REGIMES for amplitude in settings[regime]}
    amplitudes, tables = np.unique(list(regimes)), []
    for order, share, phase in drives_of(settings):
        model = {**settings["model"], "harmonics": [harmonic(order, share, phase)] if order else []}
        own = {**settings, "model": model}
        table = transit.measure(amplitudes, own, (VARIED,), threads=threads, progress=progress)
        tables.append(table.drop(columns="population").assign(order=order, share=share, phase=phase))
    table = pd.concat(tables, ignore_index=True)
    return table.assign(regime=table.acceleration.map(regimes))


def changes_of(table: pd.DataFrame) -> pd.DataFrame:
    """The relative change of each velocity by each harmonic, and its standard error, in long form."""
    pure = table[table.order == 0].set_index("acceleration")
    rows = table[table.order > 0]
    frames = []
    for name in MEASURES:
        before, error = (rows.acceleration.map(pure[column]) for column in (name, f"{name}_stderr"))
        size = before.abs().where(before != 0.0)
        frames.append(
            rows[["acceleration", "regime", "order", "share", "phase"]].assign(
                measure=name,
                change=(rows[name] - before) / size,
                # Too large, because the same parts travel on both drives.
                stderr=np.hypot(rows[f"{name}_stderr"], error) / size,
            )
        )
    return pd.concat(frames, ignore_index=True)


def largest_changes(table: pd.DataFrame) -> pd.DataFrame:
    """The size of the change at the worst phase for each amplitude, order, share and measure."""
    changes = changes_of(table).dropna(subset="change")
    sizes = changes.assign(change=changes.change.abs())
    return sizes.groupby(["regime", "acceleration", "order", "share", "measure"]).change.max().reset_index()


def harmless_shares(table: pd.DataFrame) -> pd.DataFrame:
    """The share up to which no phase changes a velocity by more than MATTERS, for each amplitude and order.

    It is interpolated linearly between shares of the table; NaN if even the largest one matters to no velocity.
    """
    worst = largest_changes(table).groupby(["regime", "acceleration", "order", "share"]).change.max().reset_index()
    rows = []
    for (regime, acceleration, order), own in worst.groupby(["regime", "acceleration", "order"]):
        shares, changes = np.array([0.0, *own.share]), np.array([0.0, *own.change])
        above = np.flatnonzero(changes > MATTERS)
        limit = math.nan
        if len(above):
            place = above[0]
            part = (MATTERS - changes[place - 1]) / (changes[place] - changes[place - 1])
            limit = shares[place - 1] + part * (shares[place] - shares[place - 1])
        rows.append({"regime": regime, "acceleration": acceleration, "order": order, "share": limit})
    return pd.DataFrame(rows)


def statement_of(table: pd.DataFrame) -> dict[str, float | bool]:
    """The numbers of the statement that chaos feeds alike on an imperfect drive, and whether it holds.

    Returns
    -------
    the `share` of the harmonic, the largest change of the median in chaos, `chaos`, and of the slowest 5 %,
    `chaos_slowest`; the change of the slowest 5 % that the worst phase makes at the riding amplitude where it is
    smallest, `riding`, and where it is largest, `most`, and both for the median, `riding_medians`; the `amplitudes` in
    chaos (m/s²), the number of `phases`, the relative standard error of the median in chaos, `stderr`; and whether
    chaos and riding keep their limits, `holds`
    """
    worst = largest_changes(table)
    worst = worst[worst.share == STATEMENT["share"]]
    sizes = worst.groupby(["regime", "measure", "acceleration"]).change.max()
    chaos, riding = sizes[CHAOS, "velocity_50"].max(), sizes[RIDING, "velocity_05"]
    pure = table[(table.order == 0) & (table.regime == CHAOS)]
    return {
        "share": STATEMENT["share"],
        "chaos": chaos,
        "chaos_slowest": sizes[CHAOS, "velocity_05"].max(),
        "riding": riding.min(),
        "most": riding.max(),
        "riding_medians": (sizes[RIDING, "velocity_50"].min(), sizes[RIDING, "velocity_50"].max()),
        "amplitudes": np.sort(pure.acceleration.unique()).tolist(),
        "phases": table.phase.nunique(),
        "stderr": (pure.velocity_50_stderr / pure.velocity_50.abs()).max(),
        "holds": bool(chaos <= STATEMENT["chaos"] and riding.min() >= STATEMENT["riding"]),
    }
