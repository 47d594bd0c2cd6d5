"""The operating chart in words: advice, a summary and a table, with all numbers from the tables."""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from conveyor import UNITS
from conveyor.analysis.attractors.labels import LONG_FLIGHT
from conveyor.packing import plate_peaks
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.steepness import is_frictionless
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.operating.advice import ENOUGH, EVEN, FAST, KEPT, STILL, moves_forward, neighbours
from conveyor_pipeline.machine.operating.populations import QUANTILES, differences
from conveyor_pipeline.machine.operating.regimes import (
    BESIDE,
    CHANGING,
    CHAOS,
    ONE,
    SEVERAL,
    SLIDES_AWAY,
    UNKNOWN,
    group_narrow,
    summarize_amplitudes,
    summarize_shares,
)
from conveyor_pipeline.machine.operating.transit import spread_stderr, time_of_drop

WORTH_CHANGING = 0.01  # relative change of velocity or spread from which a change of a parameter is named
CERTAIN = 2.0  # standard errors that a change must exceed to be named
MOST_CHANGES = 4  # that are named
MANY_LATE = 0.5  # share of late parts that a page points out
# The states of motion in the words of the trade.
STATE_WORDS = {"first": "riding", "second": "jumping", "chaos": "chaos", "undecided": "undecided"}
# What the force of a drive grows with, in words.
FORCES = {"voltage²": "square of the voltage", "voltage": "voltage", "frequency²": "square of the frequency"}
NORMAL = 1e-3  # share of the vibration along the track below which the plate moves normal to it only
DECIMALS = 6  # of velocities in m/s: smaller ones are rounding errors


def stroke_per_amplitude(frequency: float) -> float:
    """Displacement of the plate along the direction of vibration, peak to peak (m), at 1 m/s², without harmonics."""
    return 2.0 / (2.0 * math.pi * frequency) ** 2


def faster_than_plate(shares: pd.DataFrame) -> list[float]:
    """The amplitudes (m/s²) at which a motion is faster than the plate ever moves, because the contact pulls.

    Friction drives no part faster than the plate, and gravity does on a steep track only.
    """
    model = shares.attrs["model"]
    amplitudes = summarize_amplitudes(shares)
    if model.get("tension", "allow") != "allow" or (shares.status == SLIDES_AWAY).any():
        return []
    _, conveyors = grid.product({"acceleration": amplitudes.acceleration.tolist()}, model)
    return amplitudes.acceleration[(amplitudes.best > plate_peaks(conveyors).vx).to_numpy()].tolist()


def summarize_regimes(rows: pd.DataFrame, shares: pd.DataFrame) -> dict:
    """The rows of the page's table, also by regime, and the lowest amplitude (m/s²) with chaos, None for none."""
    named = {"one": ONE, "several": SEVERAL, "beside": BESIDE, "only_chaos": CHAOS}
    named |= {"changing": CHANGING, "unknown": UNKNOWN}
    parts = {name: rows[rows.regime == regime].to_dict("records") for name, regime in named.items()}
    chaos = shares.acceleration[shares.state == "chaos"]
    return {**parts, "rows": rows.to_dict("records"), "chaos_from": None if chaos.empty else float(chaos.min())}


def summarize_fastest(shares: pd.DataFrame, intervals: list[dict]) -> dict:
    """The fastest motions in some intervals with several velocities.

    `best` and `best_share` are ranges of their velocities (m/s) and of the shares of initial conditions that reach
    them, and `most` is the amplitude with the largest share.
    """
    amplitudes = summarize_amplitudes(shares)
    inside = [amplitudes.acceleration.between(row["begin"], row["end"]) for row in intervals]
    rows = amplitudes[np.any(inside, axis=0)]
    ranges = {name: (rows[name].min(), rows[name].max()) for name in ("best", "best_share")}
    ranges["best"] = [round(end, DECIMALS) + 0.0 for end in ranges["best"]]
    return {**ranges, "most": rows.loc[rows.best_share.idxmax()].to_dict()}


def motion_at(acceleration: float, shares: pd.DataFrame, rows: pd.DataFrame) -> dict:
    """The motion of equal parts at an amplitude (m/s²) of the table of shares, as the page's table has it.

    `regimes` are those of its row of the table, and `states` its states with their shares, the largest one first.
    """
    row = rows[(rows.begin <= acceleration) & (acceleration <= rows.end)].iloc[0]
    state_shares = shares[shares.acceleration == acceleration].groupby("state").share.sum()
    return {
        "regime": row.regime,
        "regimes": row.regimes,
        "states": state_shares.sort_values(ascending=False, kind="stable").to_dict(),
    }


def select_changes(aim: str, changes: pd.DataFrame) -> list[dict]:
    """The changes of one parameter that serve the aim best: more velocity, or less spread."""
    rows = changes[changes.aim == aim]
    effect, error = (rows.gain, rows.gain_stderr) if aim == FAST else (-rows.widening, rows.widening_stderr)
    helps = (effect > WORTH_CHANGING) & (effect > CERTAIN * error)
    order = effect[helps].sort_values(ascending=False, kind="stable").index
    return rows.loc[order[:MOST_CHANGES]].replace({np.nan: None}).to_dict("records")


def summarize_advice(transit: pd.DataFrame, advice: pd.DataFrame, changes: pd.DataFrame) -> dict:
    """The settings of the transit table, how parts differ, and the advice of each aim with its best changes."""
    quantiles, errors = (advice[[f"{name}{end}" for name in QUANTILES]].to_numpy().T for end in ("", "_stderr"))
    advice = advice.assign(spread_stderr=spread_stderr(quantiles, errors))
    rows = {
        row["aim"]: row | {"changes": select_changes(row["aim"], changes)}
        for row in advice.replace({np.nan: None}).to_dict("records")
    }
    tested, untested = neighbours(transit.attrs["model"], advice.attrs["changes"])
    return {
        "track": transit.attrs,
        "dropped": float(time_of_drop(transit.attrs["model"]["frequency"], transit.attrs["longest"])),
        "tested": tested,
        "untested": untested,
        **differences(transit.attrs),
        "fast": rows.get(FAST),
        "even": rows.get(EVEN),
        # Two standard errors of the difference between both spreads.
        "unequal": CERTAIN * math.sqrt(np.square(advice.spread_stderr).sum()),
    }


def name_end(acceleration: float, transit: pd.DataFrame) -> str | None:
    """The key of the axis, start or stop, if an amplitude is an end of the amplitudes of the table of transit."""
    low, high = transit.acceleration.min(), transit.acceleration.max()
    return None if low == high else {low: "start", high: "stop"}.get(acceleration)


def make(
    template: str,
    transit: pd.DataFrame,
    shares: pd.DataFrame,
    regimes: pd.DataFrame,
    advice: pd.DataFrame,
    changes: pd.DataFrame,
    assumed: Sequence[str],
    assumed_model: Sequence[str],
    measured_drive: str,
    remedies: dict[str, str],
) -> str:
    """The page from its template and its tables.

    assumed, assumed_model : differences of parts, and parameters of the model, that the config does not state
    measured_drive : the overlay with the drive of a recording that the config names and does not use; else empty
    remedies : for an amplitude at an end of the examined ones, see settings.remedies_for_amplitudes
    """
    rows = group_narrow(regimes, advice.attrs["margin"])
    velocities = ["velocity_low", "best_low", "best_high"]
    rows[velocities] = rows[velocities].round(DECIMALS) + 0.0  # no negative zero
    values = summarize_advice(transit, advice, changes) | summarize_shares(shares) | summarize_regimes(rows, shares)
    for run in filter(None, (values["fast"], values["even"])):
        run |= {"motion": motion_at(run["states_acceleration"], shares, rows)}
        run |= {"end": name_end(run["acceleration"], transit)}
    if values["several"]:
        values["fastest"] = summarize_fastest(shares, values["several"])
    body = transit.attrs.get("body")
    values |= {
        "units": UNITS,
        "words": STATE_WORDS,
        "long_flight": LONG_FLIGHT,
        "assumed": {name: transit.attrs["spread"][name] for name in assumed},
        "assumed_model": {name: transit.attrs["model"][name] for name in assumed_model},
        "measured_drive": measured_drive,
        "remedies": remedies,
        "options": advice.attrs | ({"part_length": body["length"]} if body else {}),
        "body": body,
        "followed": transit.velocity_95.notna().any(),
        "forward": moves_forward(transit),
        "beyond": faster_than_plate(shares),
        "is_normal": math.cos(transit.attrs["model"]["angle"]) < NORMAL,
        "still": STILL,
        "enough": ENOUGH,
        "kept": KEPT,
        "forces": FORCES,
        "many_late": MANY_LATE,
        "ends": (transit.acceleration.min(), transit.acceleration.max()),
        "frictionless": is_frictionless(transit.attrs["model"]),
        "slides": (shares.status == SLIDES_AWAY).any(),
        # The digits to which the ends of intervals of amplitudes are known.
        "digits": max(0, math.ceil(-math.log10(shares.attrs["resolution"] * shares.acceleration.max()))),
        "throw_per_amplitude": shares.vertical.iloc[-1] / shares.acceleration.iloc[-1],
        "stroke_per_amplitude": stroke_per_amplitude(transit.attrs["model"]["frequency"]),
    }
    return render(template, values)
