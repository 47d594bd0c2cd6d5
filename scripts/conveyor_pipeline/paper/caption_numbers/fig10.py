"""Numbers of the caption of the figure fig10."""

import pandas as pd

from conveyor_pipeline.common.axes import ends
from conveyor_pipeline.paper.motion.limits import RESOLUTION


def format_change(least: float, most: float) -> str:
    """A range of relative changes (%) in words, "1.1 to 4.2 % below"."""
    if least * most < 0.0:
        return f"between {min(least, most):+.1f} and {max(least, most):+.1f} % off"
    low, high = sorted((abs(least), abs(most)))
    return f"{low:.1f} to {high:.1f} % {'below' if most < 0.0 else 'above'}"


def numbers(*, converged: pd.DataFrame, fit: pd.DataFrame, euler: pd.DataFrame) -> dict:
    lowest, *_, highest = ends(converged.attrs["scan"])
    values = {
        "found": converged.is_critical.any(),
        "fitted": len(fit) > 0,
        "returns": (~converged.is_critical & (converged.state_above == "first")).any(),
        "highest": highest,
        "resolution": RESOLUTION * (highest - lowest),
        "many": (converged.status != "ok").any(),
        "undecided": converged[
            (converged[["state_below", "state_above"]] == "undecided").any(axis=1)
        ].acceleration.nunique(),
        "aside": None,
    }
    edges = [edge[edge.is_critical].set_index("acceleration").z0 for edge in (euler, converged)]
    change = 100.0 * (edges[0] / edges[1] - 1.0).dropna()
    if change.empty:
        return values
    return values | {"aside": format_change(change.max(), change.min()), "most_at": change.idxmin()}
