"""An overlay with the measured drive, for further analyses of the conveyor."""

import pandas as pd

from conveyor.parameters import MOST_HARMONICS
from conveyor_pipeline.machine.excitation.estimates import SHARES

DIGITS = 6


def harmonics_above_noise(harmonics: pd.DataFrame) -> list[dict[str, float]]:
    """The harmonics for `model.harmonics`, at most MOST_HARMONICS, the largest ones; a share below the noise is 0."""
    rows = []
    for row in harmonics[harmonics.above_noise].to_dict("records"):
        shares = {name: row[name] if row[f"{name.split('_')[0]}_above_noise"] else 0.0 for name in SHARES}
        rows.append({"order": row["order"], **{name: float(f"{value:.{DIGITS}g}") for name, value in shares.items()}})
    rows.sort(key=lambda harmonic: -max(harmonic["along"], harmonic["normal"]))
    return sorted(rows[:MOST_HARMONICS], key=lambda harmonic: harmonic["order"])


def drive_of(parameters: pd.DataFrame) -> dict[str, float]:
    """The parameters of the model that the accelerometer has measured."""
    return {row.parameter: float(f"{row.value:.{DIGITS}g}") for row in parameters.itertuples()}


def make(parameters: pd.DataFrame, harmonics: pd.DataFrame) -> str:
    """The overlay as text."""
    lines = [
        f"  {row.parameter}: {row.value:.{DIGITS - 1}e}   # {row.unit}, standard error {row.stderr:.2g}"
        for row in parameters.itertuples()
    ]
    shares = [
        "    - {"
        + ", ".join([f"order: {harmonic['order']}", *(f"{name}: {harmonic[name]:.{DIGITS - 1}e}" for name in SHARES)])
        + "}"
        for harmonic in harmonics_above_noise(harmonics)
    ]
    file = parameters.attrs["measured"]
    head = f"# Measured: {file}. Name this file behind the overlay that names the accelerometer file."
    dropped = int(harmonics.above_noise.sum()) - len(shares)
    limit = f"   # {dropped} smaller ones above the noise are left out; a model takes at most {MOST_HARMONICS}"
    comment = limit if dropped else ""
    listed = [f"  harmonics:{comment}", *shares] if shares else ["  harmonics: []   # none is above the noise"]
    return "\n".join([head, "model:", *lines, *listed, ""])
