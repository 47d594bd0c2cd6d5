"""What the certificates prove of the statements: sentences for their reasons, empty without the table of proofs."""

import pandas as pd

PAGE = "docs/certificates.md"


def stable_motions(table: pd.DataFrame) -> pd.Series:
    """Number of different orbits that are proved to be stable, by amplitude (m/s²).

    Two orbits differ if their times in contact do: those do not depend on where an orbit begins.
    """

    def count(rows: pd.DataFrame) -> int:
        rows = rows.sort_values("contact_time_low")
        apart = rows.contact_time_low.to_numpy()[1:] > rows.contact_time_high.cummax().to_numpy()[:-1]
        return 1 + int(apart.sum())

    stable = table[table.stability == "stable"]
    return pd.Series({amplitude: count(rows) for amplitude, rows in stable.groupby("acceleration")}, dtype=int)


def both_states(certificates: pd.DataFrame | None) -> str:
    """At which amplitudes a riding or bouncing motion and a jumping one are proved to be stable both."""
    if certificates is None:
        return ""
    counts = stable_motions(certificates)
    amplitudes = counts.index[counts >= 2]
    if not len(amplitudes):
        return ""
    return (
        f"; two stable motions are proved at {len(amplitudes)} amplitudes from {amplitudes.min():g} to "
        f"{amplitudes.max():g} m/s² ({PAGE})"
    )


def regular(certificates: pd.DataFrame | None, begin: float) -> str:
    """At which amplitudes from `begin` (m/s²) on a periodic motion is proved to be stable."""
    if certificates is None:
        return ""
    counts = stable_motions(certificates)
    amplitudes = counts.index[counts.index >= begin]
    if not len(amplitudes):
        return ""
    return (
        f"; a stable periodic motion is proved at {len(amplitudes)} amplitudes from {amplitudes.min():g} to "
        f"{amplitudes.max():g} m/s² ({PAGE})"
    )


def chaotic(horseshoes: pd.DataFrame | None) -> str:
    """At which amplitudes chaotic motions are proved to exist."""
    if horseshoes is None:
        return ""
    rows = horseshoes[horseshoes.proved]
    if rows.empty:
        return ""
    amplitudes = ", ".join(f"{acceleration:g}" for acceleration in rows.acceleration)
    return f"; that chaotic motions exist is proved at {amplitudes} m/s² ({PAGE})"
