"""Effects of a harmonic on the transit of parts, from the table of clean drives. No slow imports, for captions."""

import math

import numpy as np
import pandas as pd

from conveyor_pipeline.machine.excitation.limits import MATTERS, STATEMENT

RIDING, CHAOS = REGIMES = ("riding", "chaos")
MEASURES = {"velocity_05": "the slowest 5 %", "velocity_50": "the median"}


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
    for (regime, acceleration, order), group in worst.groupby(["regime", "acceleration", "order"]):
        shares, changes = np.array([0.0, *group.share]), np.array([0.0, *group.change])
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
    chaos (m/s²), the number of `phases`, the largest relative standard error of each velocity in each regime, without a
    harmonic and with this one, `stderr`; and whether chaos and riding keep their limits, `holds`
    """
    worst = largest_changes(table)
    worst = worst[worst.share == STATEMENT["share"]]
    sizes = worst.groupby(["regime", "measure", "acceleration"]).change.max()
    chaos = sizes[CHAOS, "velocity_50"].max()
    riding = sizes[RIDING, "velocity_05"]
    pure = table[table.order == 0]
    compared = table[(table.order == 0) | (table.share == STATEMENT["share"])]
    errors = pd.DataFrame({name: compared[f"{name}_stderr"] / compared[name].abs() for name in MEASURES})
    return {
        "share": STATEMENT["share"],
        "chaos": chaos,
        "chaos_slowest": sizes[CHAOS, "velocity_05"].max(),
        "riding": riding.min(),
        "most": riding.max(),
        "riding_medians": (sizes[RIDING, "velocity_50"].min(), sizes[RIDING, "velocity_50"].max()),
        "amplitudes": np.sort(pure[pure.regime == CHAOS].acceleration.unique()).tolist(),
        "phases": table.phase.nunique(),
        "stderr": errors.groupby(compared.regime).max().T.to_dict(),
        "holds": bool(chaos <= STATEMENT["chaos"] and riding.min() >= STATEMENT["riding"]),
    }
