"""The paper's abstract: chaotic motion feeds alike from all initial conditions."""

import numpy as np
import pandas as pd

from conveyor.linear_algebra import fit_line
from conveyor_pipeline.machine.operating.regimes import BESIDE, CHAOS, SEVERAL
from conveyor_pipeline.paper.claims.finding import NONE, Finding

HIGHEST = 90.0  # m/s², the end of the axes of the paper's figures here; amplitudes above it do not decide


def exponents(lengths: pd.DataFrame, regime: str) -> dict[float, float]:
    """The exponent of the relative spread over the length of the track, by the amplitude (m/s²), in a regime."""
    rows = lengths[(lengths.regime == regime) & (lengths.spread > 0.0)]
    return {
        acceleration: fit_line(np.log(group.length.to_numpy()), np.log(group.spread.to_numpy()))[0]
        for acceleration, group in rows.groupby("acceleration")
        if len(group) > 1
    }


def describe_regimes(regimes: pd.DataFrame) -> str:
    """Where all motions are chaotic, and where chaos exists beside other motions, in words."""
    beside = regimes[regimes.regime == BESIDE]
    last = regimes.iloc[-1]
    texts = (
        [f"At all computed amplitudes from {last.begin:g} m/s² on, all motions are chaotic"]
        if last.regime == CHAOS
        else []
    )
    if len(beside):
        runs = format_intervals(beside.begin, beside.end)
        texts.append(f"At {runs} m/s², chaos exists beside other motions, and the initial condition decides")
    return ". ".join(texts)


def format_intervals(begin: pd.Series, end: pd.Series) -> str:
    """Intervals of amplitudes (m/s²) in words."""
    return ", ".join(
        f"{low:g}" if low == high else f"{low:g} to {high:g}" for low, high in zip(begin, end, strict=True)
    )


def even_feeding(*, drift: pd.DataFrame, lengths: pd.DataFrame, regimes: pd.DataFrame) -> Finding:
    """Whether mean velocities in chaos depend on the initial conditions, and how the spread falls with the length."""
    known = drift[drift.acceleration <= HIGHEST].dropna(subset=["velocity_1", "velocity_2"])
    apart = (known.velocity_1 - known.velocity_2).abs() / np.hypot(known.velocity_1_stderr, known.velocity_2_stderr)
    chaotic, coexisting = (exponents(lengths, regime) for regime in (CHAOS, SEVERAL))
    within = {acceleration: exponent for acceleration, exponent in chaotic.items() if acceleration <= HIGHEST}
    beyond = {acceleration: exponent for acceleration, exponent in chaotic.items() if acceleration > HIGHEST}
    farthest = max(within.values(), key=lambda exponent: abs(exponent + 0.5), default=NONE)
    groups = {
        "chaos": within,
        "coexisting motions": coexisting,
        "chaos at larger amplitudes, which do not decide,": beyond,
    }
    texts = [
        f"{name} at {', '.join(f'{acceleration:g} m/s² ({exponent:.2f})' for acceleration, exponent in powers.items())}"
        for name, powers in groups.items()
        if powers
    ]
    note = f"Exponents of the spread: {'; '.join(texts)}" if texts else "No exponent of the spread is known"
    if len(known):
        note += (
            f". The velocities are compared at {', '.join(f'{amplitude:g}' for amplitude in known.acceleration)} m/s²"
        )
    note = ". ".join(filter(None, [note, describe_regimes(regimes)]))
    numbers = {
        "sets": float(apart.max()) if len(apart) else NONE,
        "exponent": farthest,
        "coexisting": min(coexisting.values(), default=NONE),
    }
    return Finding({}, numbers, note)
