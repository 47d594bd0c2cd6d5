"""Fig. 24: dimension of phase portraits over the acceleration amplitude, paper's method and converged solution."""

import pandas as pd
from matplotlib.figure import Figure

from conveyor_pipeline.figures import style

UNKNOWN = {"converged": 0.05, "correlation": 0.02}  # axes fraction of the marks of amplitudes without an estimate
REASONS = {"interval too wide": "confidence interval too wide", "too few scales": "too few scales"}
BARS = {"markersize": 2.0, "markeredgewidth": 0.6, "linewidth": 0.6, "elinewidth": 0.4}
LOOKS = {
    "euler": ("o-", style.EULER, "paper's method: box counting, first second"),
    "converged": ("s", style.CONVERGED, "converged solution: box counting, settled motion"),
    "correlation": ("x", style.SECOND_ESTIMATE, "converged solution: correlation sum, settled motion"),
}


def plot(
    *,
    converged: pd.DataFrame,
    correlation: pd.DataFrame,
    euler: pd.DataFrame,
    critical_acceleration: float | None = None,
) -> Figure:
    """Draw dimensions by box counting and by the `correlation` sum, and mark `critical_acceleration` (m/s²)."""
    figure = style.figure(style.COLUMN, 86.0)
    axes = figure.subplots()
    for dimension in (1.0, 2.0):
        axes.axhline(dimension, color="0.8", linewidth=0.6)
    tables = {"euler": euler, "converged": converged, "correlation": correlation}
    for role, table in tables.items():
        marker, colour, label = LOOKS[role]
        known = table[table.dimension.notna()]
        look = {"fmt": marker, "color": colour, "label": label, **BARS}
        axes.errorbar(known.acceleration, known.dimension, known.error, **look)
        if role in UNKNOWN:
            unknown = table[table.dimension.isna()].acceleration
            look = {"color": colour, "markersize": 3.5, "markeredgewidth": 0.8}
            axes.plot(unknown, [UNKNOWN[role]] * len(unknown), "|", transform=axes.get_xaxis_transform(), **look)
    reasons = pd.concat([table[table.dimension.isna()].status for role, table in tables.items() if role in UNKNOWN])
    if len(reasons):
        label = f"no estimate: {' or '.join(REASONS[reason] for reason in reasons.unique())}"
        axes.plot([], [], "|", color="black", markersize=3.5, label=label)
    if critical_acceleration is not None:
        style.mark(axes, critical_acceleration, f"{critical_acceleration:g} m/s²")
    # Room for all error bars, and for the marks below them.
    ends = [table.dimension + sign * table.error for table in tables.values() for sign in (-1.0, 1.0)]
    low, high = pd.concat(ends).min(), pd.concat(ends).max()
    if low < high:
        axes.set_ylim(low - 0.12 * (high - low), high + 0.04 * (high - low))
    else:
        style.say(axes, "no dimension is known")
    axes.set_xlabel(style.AMPLITUDE)
    axes.set_ylabel("dimension of the phase portrait")
    style.legend_above(figure, axes)
    return figure
