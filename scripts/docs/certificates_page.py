"""The page of certificates: what interval arithmetic proves."""

from collections.abc import Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

import numpy as np
import pandas as pd

from claims.about_proofs import stable_motions
from pipeline.templates import render


def interval(low: float, high: float) -> str:
    """An interval in decimals that contains both bounds, with one digit more than its width needs."""
    width = Decimal(high) - Decimal(low)
    places = max(0, 1 - width.adjusted()) if width else 15
    unit = Decimal(1).scaleb(-places)
    below, above = (
        Decimal(value).quantize(unit, rounding=way) for value, way in ((low, ROUND_FLOOR), (high, ROUND_CEILING))
    )
    return f"[{below}, {above}]"


def count_periods(orbits: pd.DataFrame) -> list[list[int]]:
    """Period, and numbers of orbits: all, proved, stable, unstable."""
    return [
        [period, len(rows), rows.contained.sum(), *((rows.stability == kind).sum() for kind in ("stable", "unstable"))]
        for period, rows in orbits.groupby("period")
    ]


def coexisting(orbits: pd.DataFrame) -> list[float]:
    """Amplitudes (m/s²) at which at least two stable motions are proved."""
    counts = stable_motions(orbits)
    return [float(acceleration) for acceleration in counts.index[counts >= 2]]


def join_numbers(values: Iterable[float]) -> str:
    return ", ".join(f"{value:g}" for value in values) or "none"


def bifurcation_row(row) -> list:
    """The cells of a fold or period doubling: name, period, bracket of the amplitude, floating-point amplitude."""
    kind = "fold" if row.kind == "fold" else "period doubling"
    bracket = interval(row.acceleration_low, row.acceleration_high) if row.proved else f"refused: {row.reason}"
    return [f"{kind} {row.number}", row.period, bracket, f"{row.stored_acceleration:.10f}"]


def feigenbaum_ratios(bifurcations: pd.DataFrame) -> str:
    """Bounds of Feigenbaum's ratios of the proved doublings, which follow from the bounds of the amplitudes."""
    rows = bifurcations[(bifurcations.kind == "period_doubling") & bifurcations.proved]
    low, high = rows.acceleration_low.to_numpy(), rows.acceleration_high.to_numpy()
    ratios = []
    for k in range(1, len(rows) - 1):
        least = (low[k] - high[k - 1]) / (high[k + 1] - low[k])
        most = (high[k] - low[k - 1]) / (low[k + 1] - high[k])
        # A margin far beyond the rounding errors of the division above.
        ratios.append(interval(least * (1.0 - 1e-12), most * (1.0 + 1e-12)))
    return ", ".join(ratios) or "none"


def horseshoe_row(row) -> list:
    """The cells of an amplitude with chaos: amplitude, cycles of the excursion, entropy rounded down."""
    entropy = f"{np.floor(row.entropy * 1e4) / 1e4:.4f}" if row.proved else f"not proved: {row.reason}"
    return [f"{row.acceleration:g}", row.sets if row.proved else "–", entropy]


def example_orbit(orbits: pd.DataFrame) -> dict[str, str] | None:
    """The first impact of the stable jumping orbit at 40 m/s², if it is proved."""
    rows = orbits[orbits.contained & (orbits.acceleration == 40.0) & (orbits.stability == "stable")]
    rows = rows[rows.impacts > 0]
    if rows.empty:
        return None
    orbit = rows.iloc[0]
    return {
        "phase": interval(orbit.impact_phase_low, orbit.impact_phase_high),
        "speed": interval(orbit.impact_speed_low, orbit.impact_speed_high),
        "half_width": f"{orbit.half_width:.0e}",
    }


def make(
    template: str, certificates: pd.DataFrame, certified_bifurcations: pd.DataFrame, certified_chaos: pd.DataFrame
) -> str:
    """The page from its template and the tables of what was proved."""
    orbits, settings = certificates, certificates.attrs
    refused = orbits[~orbits.contained]
    values = {
        "orbits": len(orbits),
        "amplitudes": orbits.acceleration.nunique(),
        "lowest": f"{orbits.acceleration.min():g}",
        "highest": f"{orbits.acceleration.max():g}",
        "proved": orbits.contained.sum(),
        "most_distance": f"{orbits.distance.max():.0e}",
        "median_distance": f"{orbits.distance.median():.0e}",
        "example": example_orbit(orbits),
        "refused": refused.assign(acceleration=refused.acceleration.map("{:g}".format)).to_dict("records"),
        "periods": count_periods(orbits),
        "both_stable": join_numbers(coexisting(orbits)),
        "bifurcations": [bifurcation_row(row) for row in certified_bifurcations.itertuples()],
        "ratios": feigenbaum_ratios(certified_bifurcations),
        "chaotic": join_numbers(certified_chaos.acceleration[certified_chaos.proved]),
        "horseshoes": [horseshoe_row(row) for row in certified_chaos.itertuples()],
        "order": settings["order"],
        "bits": settings["bits"],
        "chaos_bits": settings["chaos"]["bits"],
    }
    return render(template, values)
