"""Sentences on what the certificates prove, for the notes of findings; empty without the table of proofs."""

import pandas as pd

PAGE = "docs/certificates.md"


def stable_motions(table: pd.DataFrame) -> pd.Series:
    """Number of different orbits with proved stability, by amplitude (m/s²).

    Two orbits differ if the enclosures of their contact times are disjoint. The contact time does not depend on the
    cycle at which a stored orbit begins.
    """

    def count(rows: pd.DataFrame) -> int:
        rows = rows.sort_values("contact_time_low", kind="stable")
        apart = rows.contact_time_low.to_numpy()[1:] > rows.contact_time_high.cummax().to_numpy()[:-1]
        return 1 + int(apart.sum())

    stable = table[table.stability == "stable"]
    return pd.Series({amplitude: count(rows) for amplitude, rows in stable.groupby("acceleration")}, dtype=int)


def lowest_fold(bifurcations: pd.DataFrame) -> float:
    """Amplitude (m/s²) of the lowest proved fold; NaN if none is proved."""
    return bifurcations.acceleration_low[(bifurcations.kind == "fold") & bifurcations.proved].min()


def describe_amplitudes(proved: str, amplitudes: pd.Index) -> str:
    """A sentence on what is proved at some amplitudes (m/s²); empty for none."""
    if not len(amplitudes):
        return ""
    interval = f"from {amplitudes.min():g} to {amplitudes.max():g} m/s²"
    return f". {proved} proved at {len(amplitudes)} amplitudes {interval} ({PAGE})"


def describe_coexistence(certificates: pd.DataFrame | None) -> str:
    """The amplitudes at which two stable motions are proved."""
    if certificates is None:
        return ""
    counts = stable_motions(certificates)
    return describe_amplitudes("Two stable motions are", counts.index[counts >= 2])


def describe_periodic(certificates: pd.DataFrame, begin: float) -> str:
    """The amplitudes from `begin` (m/s²) on at which a stable periodic motion is proved."""
    amplitudes = stable_motions(certificates).index
    return describe_amplitudes("A stable periodic motion is", amplitudes[amplitudes >= begin])


def describe_chaos(horseshoes: pd.DataFrame) -> str:
    """The amplitudes at which the existence of chaotic motions is proved."""
    rows = horseshoes[horseshoes.proved]
    if rows.empty:
        return ""
    amplitudes = ", ".join(f"{acceleration:g}" for acceleration in rows.acceleration)
    return f". The existence of chaotic motions is proved at {amplitudes} m/s² ({PAGE})"
