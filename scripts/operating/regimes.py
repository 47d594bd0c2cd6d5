"""Regimes: intervals of amplitudes with one velocity, with several velocities, with chaos."""

import numpy as np
import pandas as pd

from pipeline import fields

ONE, SEVERAL, BESIDE, CHAOS, UNKNOWN = REGIMES = (
    "one velocity",
    "several velocities",
    "chaos beside other motions",
    "chaos only",
    "unknown",
)
# What a recommended amplitude aims at, see `advice`.
CERTAIN, FAST = AIMS = ("certain", "fast")
REGIMES_OF_AIMS = {CERTAIN: (ONE,), FAST: (ONE, SEVERAL)}
# The status of a motion on a track that is too steep, see `track`.
SLIDES_AWAY = "slides away"

# Columns of the table `regimes`.
COLUMNS = (
    fields.count("number", "number of the interval of amplitudes, in ascending order"),
    fields.text("regime", f"{', '.join(REGIMES)} (a state is undecided, or a velocity is not known)"),
    fields.number("begin", "m/s²", "smallest computed amplitude of the interval"),
    fields.number("end", "m/s²", "largest computed amplitude of the interval"),
    fields.number("step", "m/s²", "largest distance between neighbouring computed amplitudes"),
    fields.count("amplitudes", "number of computed amplitudes in the interval"),
    fields.text("states", "states of motion that occur, the most frequent one first"),
    fields.number("velocity_low", "m/s", "smallest mean velocity of any motion"),
    fields.number("best_low", "m/s", "smallest velocity, over the amplitudes, of the fastest motion"),
    fields.number("best_high", "m/s", "largest velocity of the fastest motion"),
    fields.number("best_share_low", "1", "smallest share of initial conditions that reach the largest velocity"),
    fields.number("best_share_high", "1", "largest share of initial conditions that reach the largest velocity"),
    fields.number("best_share_stderr", "1", "largest standard error of these shares"),
)


def same(velocity: np.ndarray, other: float, share: float) -> np.ndarray:
    """Whether velocities count as equal to another: they differ by at most a share of the larger one."""
    return np.abs(velocity - other) <= share * np.maximum(np.abs(velocity), abs(other))


def regime_of(state: np.ndarray, velocity: np.ndarray, share: float) -> str:
    """The regime of one amplitude from states and velocities of its motions, shape (k,)."""
    if np.isnan(velocity).any() or (state == "undecided").any():
        return UNKNOWN
    if (state == "chaos").all():
        return CHAOS
    if (state == "chaos").any():
        return BESIDE
    return ONE if same(velocity, velocity.max(), share).all() else SEVERAL


def regimes_of(table: pd.DataFrame, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes of a table of shares, ascending, and the regime at each, both of shape (m,)."""
    found = {
        acceleration: regime_of(motions.state.to_numpy(), motions.mean_velocity.to_numpy(), share)
        for acceleration, motions in table.groupby("acceleration")
    }
    return np.array(list(found)), np.array(list(found.values()))


def best_of(shares: pd.DataFrame, share: float) -> pd.DataFrame:
    """At each amplitude, the velocity of the fastest motion (`best`), the share of initial conditions that reach it
    (`best_share`), and the standard error of this share (`stderr`); NaN where no velocity is known.
    """
    rows = []
    for acceleration, motions in shares.groupby("acceleration"):
        best = motions.mean_velocity.max()
        reach_it = float(motions.share[same(motions.mean_velocity.to_numpy(), best, share)].sum())
        reach_it = np.nan if np.isnan(best) else reach_it
        # Rounding may make the sum of shares slightly larger than 1.
        error = np.sqrt(max(reach_it * (1.0 - reach_it), 0.0) / motions.starts.sum())
        rows.append((acceleration, best, reach_it, error))
    return pd.DataFrame(rows, columns=["acceleration", "best", "best_share", "stderr"])


def intervals_of(shares: pd.DataFrame, share: float) -> dict[str, np.ndarray]:
    """The columns of the table of regimes: one row for each interval of amplitudes with one regime."""
    places, regimes = regimes_of(shares, share)
    best = best_of(shares, share)
    changes = np.flatnonzero(regimes[1:] != regimes[:-1]) + 1
    rows = []
    for number, part in enumerate(np.split(np.arange(len(places)), changes), start=1):
        inside = shares[shares.acceleration.between(places[part[0]], places[part[-1]])]
        own = best.iloc[part]
        states = inside.groupby("state").starts.sum().sort_values(ascending=False, kind="stable")
        rows.append(
            {
                "number": number,
                "regime": regimes[part[0]],
                "begin": places[part[0]],
                "end": places[part[-1]],
                "step": np.diff(places[part]).max() if len(part) > 1 else np.nan,
                "amplitudes": len(part),
                "states": ", ".join(states.index),
                "velocity_low": inside.mean_velocity.min(),
                "best_low": own.best.min(),
                "best_high": own.best.max(),
                "best_share_low": own.best_share.min(),
                "best_share_high": own.best_share.max(),
                "best_share_stderr": own.stderr.max(),
            }
        )
    return fields.columns(rows, COLUMNS)
