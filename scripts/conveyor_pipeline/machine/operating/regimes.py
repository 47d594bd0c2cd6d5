"""Regimes: intervals of amplitudes with one velocity, with several velocities, with chaos."""

import numpy as np
import pandas as pd

from conveyor_pipeline.common import fields

ONE, SEVERAL, BESIDE, CHAOS, UNKNOWN = REGIMES = (
    "one velocity",
    "several velocities",
    "chaos beside other motions",
    "chaos only",
    "unknown",
)
# Of neighbouring intervals that are all narrower than the error of the amplitude, see `group_narrow`.
CHANGING = "changes within the error of the amplitude"
# Relative difference up to which two velocities count as equal, in units of the larger one.
SAME_VELOCITY = 0.02
# The status of a motion on a track that is too steep, see `track`.
SLIDES_AWAY = "slides away"
# The status of a motion whose state, or whose mean velocity, is not known after the cycles that the config allows.
UNDECIDED, UNSETTLED = "state not decided", "mean velocity not settled"
# The status of a state that was not found although it may exist, see `track`.
NOT_ALL_SETTLED = "not all initial conditions settled"

# If none of n independent initial conditions does something, then with 95 % confidence at most a share of 3/n does it:
# -log(0.05) is 2.996.
RULE_OF_THREE = 3.0

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
)


def are_equal(velocity: np.ndarray, reference: float) -> np.ndarray:
    """Whether velocities count as equal to another: they differ by at most a share of the larger one."""
    return np.abs(velocity - reference) <= SAME_VELOCITY * np.maximum(np.abs(velocity), abs(reference))


def regime_of(state: np.ndarray, velocity: np.ndarray) -> str:
    """The regime of one amplitude from states and velocities of its motions, shape (k,)."""
    if np.isnan(velocity).any() or (state == "undecided").any():
        return UNKNOWN
    if (state == "chaos").all():
        return CHAOS
    if (state == "chaos").any():
        return BESIDE
    return ONE if are_equal(velocity, velocity.max()).all() else SEVERAL


def summarize_amplitudes(shares: pd.DataFrame) -> pd.DataFrame:
    """What each amplitude of a table of shares has, ascending.

    Its regime, the velocities of the fastest motion (`best`) and of the `slowest` one, the share of initial conditions
    that reach the fastest one (`best_share`) with its standard error (`stderr`), and the mean velocity over all initial
    conditions (`mean`). These numbers are NaN if any velocity is not known: that motion may be the fastest one.
    """
    rows = []
    for acceleration, motions in shares.groupby("acceleration"):
        velocity, share = motions.mean_velocity.to_numpy(), motions.share.to_numpy()
        best = velocity.max()
        reach_it = np.nan if np.isnan(best) else float(share[are_equal(velocity, best)].sum())
        rows.append(
            {
                "acceleration": acceleration,
                "regime": regime_of(motions.state.to_numpy(), velocity),
                "best": best,
                "slowest": velocity.min(),
                "best_share": reach_it,
                # Rounding may make the sum of shares slightly larger than 1.
                "stderr": np.sqrt(max(reach_it * (1.0 - reach_it), 0.0) / motions.starts.sum()),
                "mean": (share * velocity).sum(),
            }
        )
    return pd.DataFrame(rows)


def summarize_shares(shares: pd.DataFrame) -> dict:
    """The settings (`search`), amplitudes (m/s²) and throw numbers of the table of shares.

    `unseen_share` is the largest share of initial conditions that may lead to a motion that none of the tested ones
    leads to. `located` is the largest relative distance between neighbouring amplitudes with different
    regimes, at least the resolution of the config. `unsettled` is the number of amplitudes at which a search ended
    before a state or a velocity was known.
    """
    amplitudes = np.sort(shares.acceleration.unique())
    regime = summarize_amplitudes(shares).regime.to_numpy()
    between = (np.diff(amplitudes) / amplitudes[1:])[regime[1:] != regime[:-1]]
    return {
        "search": shares.attrs,
        "same_velocity": SAME_VELOCITY,
        "unseen_share": RULE_OF_THREE / shares.attrs["starts"],
        "amplitudes": amplitudes,
        "unsettled": shares[shares.status.isin((UNDECIDED, UNSETTLED))].acceleration.nunique(),
        "located": between.max(initial=shares.attrs["resolution"]),
        "step": np.diff(amplitudes).max(initial=0.0),
        "throw_numbers": (shares.vertical.min(), shares.vertical.max()),
    }


def intervals_of(amplitudes: pd.DataFrame, shares: pd.DataFrame) -> pd.DataFrame:
    """The table of regimes from `summarize_amplitudes`: one row for each interval of amplitudes with one regime.

    Where a velocity is not known, neither is the fastest or the slowest motion.
    """
    numbers = (amplitudes.regime != amplitudes.regime.shift()).cumsum()
    rows = []
    for number, part in amplitudes.groupby(numbers):
        begin, end = part.acceleration.min(), part.acceleration.max()
        inside = shares[shares.acceleration.between(begin, end)]
        states = inside.groupby("state").starts.sum().sort_values(ascending=False, kind="stable")
        rows.append(
            {
                "number": number,
                "regime": part.regime.iloc[0],
                "begin": begin,
                "end": end,
                "step": part.acceleration.diff().max(),
                "amplitudes": len(part),
                "states": ", ".join(states.index),
                "velocity_low": part.slowest.min(),
                "best_low": part.best.min(),
                "best_high": part.best.max(),
                "best_share_low": part.best_share.min(),
                "best_share_high": part.best_share.max(),
            }
        )
    return pd.DataFrame(rows)


def join(rows: pd.DataFrame) -> dict:
    """One interval from neighbouring ones, with the states and the range of velocities of all of them."""
    states = dict.fromkeys(", ".join(rows.states).split(", "))  # each once, in this order
    lowest = rows[["begin", "velocity_low", "best_low", "best_share_low"]].min(skipna=False)
    highest = rows[["end", "step", "best_high", "best_share_high"]].max(skipna=False)
    return {**lowest, **highest, "states": ", ".join(states), "amplitudes": rows.amplitudes.sum(), "regime": CHANGING}


def group_narrow(regimes: pd.DataFrame, margin: float) -> pd.DataFrame:
    """The table of regimes with neighbouring intervals as one if each is narrower than a relative margin of the
    amplitude; the regime there is CHANGING.

    No drive holds its amplitude inside such an interval. Unknown intervals stay as they are, because what happens there
    is not known. An interval ends half-way between computed amplitudes.

    Returns
    -------
    the columns of the table, and `regimes`: the list of the regimes of each row
    """
    between = 0.5 * (regimes.end.shift() + regimes.begin)
    left, right = between.fillna(regimes.begin), between.shift(-1).fillna(regimes.end)
    narrow = ((right - left) / right < margin) & (regimes.regime != UNKNOWN)
    number = (~(narrow & narrow.shift(fill_value=False))).cumsum()
    rows = [
        (join(part) if len(part) > 1 else part.iloc[0].to_dict()) | {"regimes": list(part.regime.unique())}
        for _, part in regimes.groupby(number)
    ]
    return pd.DataFrame(rows, columns=[*regimes.columns, "regimes"])
