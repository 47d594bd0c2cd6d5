"""The page of certificates: what interval arithmetic proves."""

from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

import pandas as pd

from conveyor_pipeline.common.templates import render
from conveyor_pipeline.paper.claims.about_proofs import stable_motions


def interval(low: float, high: float) -> str:
    """An interval in decimals that contains both bounds, with one digit more than its width needs."""
    width = Decimal(high) - Decimal(low)
    places = max(0, 1 - width.adjusted()) if width else 15
    unit = Decimal(1).scaleb(-places)
    below, above = (
        Decimal(value).quantize(unit, rounding=way) for value, way in ((low, ROUND_FLOOR), (high, ROUND_CEILING))
    )
    return f"[{below}, {above}]"


def feigenbaum_ratios(bifurcations: pd.DataFrame) -> list[tuple[float, float]]:
    """Bounds of Feigenbaum's ratios of the proved doublings, which follow from the bounds of the amplitudes."""
    rows = bifurcations[(bifurcations.kind == "period_doubling") & bifurcations.proved]
    low, high = rows.acceleration_low.to_numpy(), rows.acceleration_high.to_numpy()
    lower = (low[1:-1] - high[:-2]) / (high[2:] - low[1:-1])
    upper = (high[1:-1] - low[:-2]) / (low[2:] - high[1:-1])
    # A margin far beyond the rounding errors of the division above.
    return list(zip(lower * (1.0 - 1e-12), upper * (1.0 + 1e-12), strict=True))


def make(
    template: str, certificates: pd.DataFrame, certified_bifurcations: pd.DataFrame, certified_chaos: pd.DataFrame
) -> str:
    """The page from its template and the tables of what was proved."""
    orbits, counts = certificates, stable_motions(certificates)
    jumping = orbits.contained & (orbits.acceleration == 40.0) & (orbits.stability == "stable") & (orbits.impacts > 0)
    values = {
        "arithmetic": orbits.iloc[0],
        "chaos_bits": certified_chaos.bits.max(),
        "interval": interval,
        "orbits": orbits.to_dict("records"),
        "refused": orbits[~orbits.contained].to_dict("records"),
        "amplitudes": orbits.acceleration.unique(),
        "largest_distance": orbits.distance.max(),
        "median_distance": orbits.distance.median(),
        "examples": orbits[jumping].to_dict("records"),
        "both_stable": counts.index[counts >= 2],
        "bifurcations": certified_bifurcations.to_dict("records"),
        "ratios": feigenbaum_ratios(certified_bifurcations),
        "horseshoes": certified_chaos.to_dict("records"),
    }
    return render(template, values)
