"""What to do: amplitudes at which to run a conveyor, what is certain there, and which parameters make it faster.

There are two aims. `certain`: all initial conditions of the box lead to one velocity, and no other amplitude where
this holds has a larger one. `fast`: there is no chaos, and the velocity of the fastest motion times the share of
initial conditions that reach it is largest. Both must hold at all amplitudes of the table within a relative margin,
because no drive holds its amplitude exactly.
"""

import numpy as np
import pandas as pd

from conveyor.analysis import throw_theory
from conveyor.analysis.attractors.labels import Labels
from conveyor.solver.model import VZ0
from operating.regimes import CERTAIN, FAST, REGIMES_OF_AIMS, summarize_amplitudes
from operating.shares import APART, FORGOTTEN, continue_normal, motions_at, parameters_of, starts_of_box
from pipeline import fields
from pipeline.motions import motions_of_starts

AIM = fields.text(
    "aim", f"{CERTAIN}: one velocity for all initial conditions, {FAST}: largest velocity times share, without chaos"
)
TABLES = {
    "advice": (
        AIM,
        fields.number("acceleration", "m/s²", "recommended amplitude of the excitation"),
        fields.number("throw_number", "1", "throw number Γ"),
        *fields.STATE,
        fields.number("mean_velocity", "m/s", "mean feeding velocity of the fastest motion"),
        fields.number("share", "1", "share of the initial conditions that reach this velocity"),
        fields.number("stderr", "1", "standard error of the share"),
        fields.number("knock", "m/s", "smallest sudden change of ż that ends the motion; null if no tested one does"),
        fields.number("largest_kick", "m/s", "largest change of ż that was tried"),
        fields.number("impact_speed", "m/s", "largest speed of approach across the track in a period"),
        fields.number("peak_force", "N", "largest contact force in a period"),
        fields.number("textbook", "m/s", "velocity by the textbook theory; null beyond its range"),
    ),
    "changes": (
        AIM,
        fields.text("parameter", "changed parameter"),
        fields.number("value", "SI", "its new value"),
        fields.text("regime", "regime at this amplitude with the changed parameter"),
        fields.number("mean_velocity", "m/s", "mean over all initial conditions; null where it is not known"),
        fields.number("gain", "1", "relative change of the mean velocity"),
    ),
}


def worst_within(places: np.ndarray, scores: np.ndarray, margin: float) -> np.ndarray:
    """The smallest score at any of the `places`, ascending, within the relative margin of each; all of shape (m,)."""
    first = np.searchsorted(places, places * (1.0 - margin))
    behind = np.searchsorted(places, places * (1.0 + margin), side="right")
    return np.array([scores[begin:end].min() for begin, end in zip(first, behind, strict=True)])


def recommended(shares: pd.DataFrame, margin: float) -> dict[str, float]:
    """The recommended amplitude (m/s²) of each aim that can be met."""
    amplitudes = summarize_amplitudes(shares, shares.attrs["same_velocity"])
    places = amplitudes.acceleration.to_numpy()
    scores = {CERTAIN: amplitudes.best, FAST: amplitudes.best * amplitudes.best_share}
    worst = {
        aim: worst_within(places, np.where(amplitudes.regime.isin(REGIMES_OF_AIMS[aim]), score, -np.inf), margin)
        for aim, score in scores.items()
    }
    return {aim: float(places[score.argmax()]) for aim, score in worst.items() if np.isfinite(score.max())}


def is_motion(found: Labels, motion: pd.Series) -> np.ndarray:
    """Whether labels of n initial conditions equal the labels of a row of the table of shares: bool, shape (n,)."""
    flight = np.nan_to_num(found.longest_flight, nan=-1.0)
    apart = np.abs(flight - np.nan_to_num(motion.longest_flight, nan=-1.0))
    return (found.state == motion.state) & (found.period == motion.period) & (apart <= APART)


def settled(motion: pd.Series, settings: dict, phases: int, *, threads: int = 1) -> np.ndarray:
    """Packed parameters that go on from a settled motion, at phases spread over a cycle, shape (phases, 16)."""
    rows = parameters_of(np.array([motion.acceleration]), starts_of_box(settings), settings["model"])
    found = motions_of_starts(rows, settings, starts=len(rows), threads=threads)
    members = np.flatnonzero(is_motion(found, motion))
    chosen = np.full(phases, members[found.cycles[members].argmin()])
    cycles = found.cycles[chosen] + np.arange(phases) / phases + FORGOTTEN
    return continue_normal(rows[chosen], cycles, settings, threads=threads)


def smallest_knock(
    rows: np.ndarray, motion: pd.Series, sizes: np.ndarray, settings: dict, *, threads: int = 1
) -> float:
    """The smallest change of ż (m/s) among `sizes`, up or down, that ends a motion; NaN if none does.

    rows : points of the motion, packed, shape (k, 16)
    """
    kicks = np.concatenate([-sizes, sizes])
    kicked = np.repeat(rows, len(kicks), axis=0)
    kicked[:, VZ0] += np.tile(kicks, len(rows))
    found = motions_of_starts(kicked, settings, starts=len(kicked), threads=threads)
    ended = np.abs(np.tile(kicks, len(rows)))[~is_motion(found, motion)]
    return ended.min() if len(ended) else np.nan


def with_parameter(model: dict, parameter: str, value: float) -> dict:
    """A model with another value of one parameter; the static friction is not left below the friction."""
    changed = {**model, parameter: value}
    if "static_friction" in model:
        changed["static_friction"] = max(changed["static_friction"], changed["friction"])
    return changed


def changes_at(acceleration: float, settings: dict, changes: dict[str, float], *, threads: int = 1) -> list[dict]:
    """Regime and mean velocity if one parameter at a time is increased or decreased."""

    def summary_with(model: dict) -> pd.Series:
        table = motions_at(np.array([acceleration]), {**settings, "model": model}, threads=threads)
        return summarize_amplitudes(table, settings["same_velocity"]).iloc[0]

    model = settings["model"]
    before = summary_with(model)
    rows = []
    for parameter, change in changes.items():
        for value in (model[parameter] - change, model[parameter] + change):
            after = summary_with(with_parameter(model, parameter, value))
            row = {"parameter": parameter, "value": value, "regime": after.regime, "mean_velocity": after["mean"]}
            rows.append(row | {"gain": after["mean"] / before["mean"] - 1.0})
    return rows


def make(shares: pd.DataFrame, settings: dict, *, threads: int = 1) -> dict[str, dict]:
    """The columns of the tables of advice and of changes."""
    box = shares.attrs
    largest = max(map(abs, box["vz0"]))
    sizes = np.geomspace(settings["smallest_kick"] * largest, largest, settings["kicks"])
    amplitudes = summarize_amplitudes(shares, box["same_velocity"]).set_index("acceleration")
    advice, changes = [], []
    for aim, acceleration in recommended(shares, settings["margin"]).items():
        motion = shares[shares.acceleration == acceleration].iloc[0]
        rows = settled(motion, box, settings["phases"], threads=threads)
        advice.append(
            {
                "aim": aim,
                "acceleration": acceleration,
                "throw_number": motion.vertical,
                "state": motion.state,
                "period": motion.period,
                "mean_velocity": motion.mean_velocity,
                "share": amplitudes.best_share[acceleration],
                "stderr": amplitudes.stderr[acceleration],
                "knock": smallest_knock(rows, motion, sizes, box, threads=threads),
                "largest_kick": largest,
                "impact_speed": motion.impact_speed,
                "peak_force": motion.peak_force,
                "textbook": float(throw_theory.mean_velocity(acceleration, **box["model"])),
            }
        )
        changes += [{"aim": aim, **row} for row in changes_at(acceleration, box, settings["changes"], threads=threads)]
    return {
        "advice": fields.columns(advice, TABLES["advice"]),
        "changes": fields.columns(changes, TABLES["changes"]),
    }
